#include "scintray/core/units.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "scintray/core/error.hpp"
#include "scintray/core/text.hpp"

namespace scintray::core {

namespace {

struct Unit {
  const char* name;
  double factor;  ///< internal units per unit
};

constexpr double kDegreeInRad = std::numbers::pi / 180.0;

const std::vector<Unit>& table_of(Dimension dimension) {
  static const std::vector<Unit> length{{"nm", 1e-6}, {"um", 1e-3}, {"µm", 1e-3},   {"mm", 1.0},
                                        {"cm", 10.0}, {"m", 1e3},   {"inch", 25.4}, {"in", 25.4}};
  static const std::vector<Unit> inverse{
      {"1/nm", 1e6}, {"1/um", 1e3}, {"1/mm", 1.0}, {"1/cm", 0.1}, {"1/m", 1e-3}};
  static const std::vector<Unit> wavelength{{"nm", 1.0}, {"um", 1e3}, {"µm", 1e3}, {"eV", 0.0}};
  static const std::vector<Unit> time{{"ps", 1e-3}, {"ns", 1.0}, {"us", 1e3},
                                      {"µs", 1e3},  {"ms", 1e6}, {"s", 1e9}};
  static const std::vector<Unit> frequency{{"Hz", 1e-9}, {"kHz", 1e-6}, {"MHz", 1e-3}, {"GHz", 1.0}};
  static const std::vector<Unit> angle{{"deg", kDegreeInRad}, {"rad", 1.0}, {"mrad", 1e-3}};
  static const std::vector<Unit> energy{{"eV", 1e-3}, {"keV", 1.0}, {"MeV", 1e3}};
  static const std::vector<Unit> density{{"g/cm3", 1.0}, {"kg/m3", 1e-3}};
  static const std::vector<Unit> yield{
      {"1/keV", 1.0}, {"1/MeV", 1e-3}, {"photons/keV", 1.0}, {"photons/MeV", 1e-3}};
  static const std::vector<Unit> none{{"%", 0.01}};
  switch (dimension) {
    case Dimension::length:
      return length;
    case Dimension::inverse_length:
      return inverse;
    case Dimension::wavelength:
      return wavelength;
    case Dimension::time:
      return time;
    case Dimension::frequency:
      return frequency;
    case Dimension::angle:
      return angle;
    case Dimension::energy:
      return energy;
    case Dimension::density:
      return density;
    case Dimension::photons_per_energy:
      return yield;
    case Dimension::dimensionless:
      return none;
  }
  throw InternalError("unknown dimension");
}

std::string accepted(Dimension dimension) { return list_of(units_of(dimension)); }

/// An example of a quantity, in ScintRay's internal unit where that has a name.
std::string example(Dimension dimension) {
  const std::vector<Unit>& units = table_of(dimension);
  const auto own =
      std::find_if(units.begin(), units.end(), [](const Unit& unit) { return unit.factor == 1.0; });
  return std::string("\"2 ") + (own != units.end() ? own->name : units.front().name) + "\"";
}

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

std::string dimension_name(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "length";
    case Dimension::inverse_length:
      return "inverse length";
    case Dimension::wavelength:
      return "wavelength";
    case Dimension::time:
      return "time";
    case Dimension::frequency:
      return "frequency";
    case Dimension::angle:
      return "angle";
    case Dimension::energy:
      return "energy";
    case Dimension::density:
      return "density";
    case Dimension::photons_per_energy:
      return "light yield";
    case Dimension::dimensionless:
      return "plain number";
  }
  throw InternalError("unknown dimension");
}

std::vector<std::string> units_of(Dimension dimension) {
  std::vector<std::string> names;
  for (const Unit& unit : table_of(dimension)) names.push_back(unit.name);
  return names;
}

double unit_factor(std::string_view unit, Dimension dimension) {
  for (const Unit& known : table_of(dimension))
    if (unit == known.name && known.factor > 0.0) return known.factor;
  throw InputError({{},
                    "\"" + std::string(unit) + "\" is not a unit of " + dimension_name(dimension),
                    "use one of " + accepted(dimension)});
}

double parse_quantity(std::string_view text, Dimension dimension) {
  const std::string_view trimmed = trim(text);
  double value = 0.0;
  const auto [end, status] = std::from_chars(trimmed.data(), trimmed.data() + trimmed.size(), value);
  if (status != std::errc{} || !std::isfinite(value))
    throw InputError(
        {{},
         "\"" + std::string(text) + "\" does not start with a finite number",
         "write a number and a unit of " + dimension_name(dimension) + ", as " + example(dimension)});
  const std::string_view unit = trim(trimmed.substr(static_cast<std::size_t>(end - trimmed.data())));
  if (unit.empty()) {
    if (dimension == Dimension::dimensionless) return value;
    throw InputError(
        {{},
         "\"" + std::string(text) + "\" has no unit, but a " + dimension_name(dimension) + " is expected",
         "add one of " + accepted(dimension)});
  }
  if (dimension == Dimension::wavelength && unit == "eV") {
    if (!(value > 0.0))
      throw InputError({{}, "a photon energy of \"" + std::string(text) + "\"", "give a positive energy"});
    return kHc_eV_nm / value;
  }
  return value * unit_factor(unit, dimension);
}

}  // namespace scintray::core
