#include "scintray/scene_file/tally_variable.hpp"

#include <algorithm>

#include "scintray/core/error.hpp"

namespace scintray::scene_file {

const char* TallyVariable::unit() const {
  if (is_name()) return "";
  switch (dimension) {
    case core::Dimension::length:
      return "mm";
    case core::Dimension::inverse_length:
      return "1/mm";
    case core::Dimension::wavelength:
      return "nm";
    case core::Dimension::time:
      return "ns";
    case core::Dimension::frequency:
      return "1/ns";
    case core::Dimension::angle:
      return "rad";
    case core::Dimension::energy:
      return "keV";
    case core::Dimension::density:
      return "g/cm3";
    case core::Dimension::photons_per_energy:
      return "photons/keV";
    case core::Dimension::length_per_energy:
      return "mm/keV";
    case core::Dimension::dimensionless:
      return "1";
  }
  throw core::InternalError("a dimension without a unit");
}

// The variables that are built in, a file to a line: KIND is the function add_KIND_variables that
// detail/KIND_variables.cpp defines.
#define SCINTRAY_TALLY_VARIABLES(ADD) \
  ADD(photon)                         \
  ADD(face)                           \
  ADD(name)

#define SCINTRAY_DECLARE(kind) void add_##kind##_variables(TallyVariables& variables);
SCINTRAY_TALLY_VARIABLES(SCINTRAY_DECLARE)
#undef SCINTRAY_DECLARE

TallyVariables::TallyVariables() {
#define SCINTRAY_ADD(kind) add_##kind##_variables(*this);
  SCINTRAY_TALLY_VARIABLES(SCINTRAY_ADD)
#undef SCINTRAY_ADD
}

const TallyVariables& TallyVariables::built_in() {
  static const TallyVariables variables;
  return variables;
}

void TallyVariables::add(TallyVariable variable) {
  if (variable.name.empty()) throw core::InternalError("a variable of tallies without a name");
  if (find(variable.name))
    throw core::InternalError("two variables of tallies with the name \"" + variable.name + "\"");
  if ((variable.number != nullptr) == variable.is_name() || (variable.place != nullptr) != variable.is_name())
    throw core::InternalError("the variable \"" + variable.name + "\" has not just the function of its kind");
  variables_.push_back(std::make_shared<const TallyVariable>(std::move(variable)));
}

TallyVariablePtr TallyVariables::find(std::string_view name) const {
  const auto known = std::find_if(variables_.begin(), variables_.end(),
                                  [&](const TallyVariablePtr& variable) { return variable->name == name; });
  return known == variables_.end() ? nullptr : *known;
}

TallyVariablePtr TallyVariables::at(std::string_view name) const {
  TallyVariablePtr variable = find(name);
  if (!variable) throw core::InternalError("no variable of tallies is called \"" + std::string(name) + "\"");
  return variable;
}

std::vector<std::string> TallyVariables::names(bool (*is)(const TallyVariable&)) const {
  std::vector<std::string> names;
  for (const TallyVariablePtr& variable : variables_)
    if (is(*variable)) names.push_back(variable->name);
  return names;
}

}  // namespace scintray::scene_file
