#include "scintray/mesh/import/detail/import_steps.hpp"

#include <cmath>
#include <cstdio>

#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

double resolve_unit(const std::filesystem::path& path, double given_mm, const FileUnit& unit,
                    std::vector<std::string>& notes) {
  constexpr double kRounding = 1e-6;  // files round their units: 0.0254, 0.3048
  if (!std::isfinite(given_mm) || given_mm < 0.0)
    reject_file(path, "the mesh's unit is not a positive length", "give for example unit = \"mm\"");
  const bool known = unit.mm > 0.0;
  if (given_mm == 0.0 && !known)
    reject_file(
        path, "the file does not state the unit of its coordinates",
        "state it (um, mm, cm, m or inch): in a scene as unit = \"mm\" beside the mesh, on the command line "
        "as --unit mm");
  const bool contradicts = known && given_mm > 0.0 && std::abs(given_mm - unit.mm) > kRounding * unit.mm;
  const std::string stated = unit.name + " (" + number(unit.mm) + " mm)";
  if (contradicts && unit.written)
    reject_file(path,
                "the file states the unit " + stated + ", but the unit given is " + number(given_mm) + " mm",
                "remove unit: the file's own is used. When the file is wrong, correct it with scale = " +
                    number(given_mm / unit.mm));
  if (contradicts)
    notes.push_back("the unit given, " + number(given_mm) + " mm, replaces what the format prescribes, " +
                    stated);
  const double unit_mm = given_mm > 0.0 ? given_mm : unit.mm;
  return known ? unit_mm / unit.mm * unit.read_mm : unit_mm;
}

}  // namespace scintray::mesh
