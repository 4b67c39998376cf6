#include "scintray/core/units.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

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
  static const std::vector<Unit> saturation{
      {"mm/keV", 1.0}, {"mm/MeV", 1e-3}, {"cm/MeV", 1e-2}, {"um/keV", 1e-3}};
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
    case Dimension::length_per_energy:
      return saturation;
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

/// Spellings of units that are not accepted, and what is meant.
struct Spelling {
  const char* written;
  const char* meant;
};
constexpr Spelling kSpellings[] = {
    {"°", "deg"},          {"degree", "deg"},         {"degrees", "deg"},
    {"grad", "deg"},       {"radian", "rad"},         {"radians", "rad"},
    {"micron", "um"},      {"microns", "um"},         {"micrometer", "um"},
    {"millimeter", "mm"},  {"millimeters", "mm"},     {"millimetre", "mm"},
    {"millimetres", "mm"}, {"centimeter", "cm"},      {"meter", "m"},
    {"nanometer", "nm"},   {"nanometers", "nm"},      {"inches", "inch"},
    {"\"", "inch"},        {"second", "s"},           {"sec", "s"},
    {"seconds", "s"},      {"percent", "%"},          {"mm-1", "1/mm"},
    {"mm^-1", "1/mm"},     {"cm-1", "1/cm"},          {"cm^-1", "1/cm"},
    {"/mm", "1/mm"},       {"/cm", "1/cm"},           {"/MeV", "1/MeV"},
    {"/keV", "1/keV"},     {"ph/MeV", "photons/MeV"}, {"ph/keV", "photons/keV"},
    {"g/cm^3", "g/cm3"},   {"g/cm³", "g/cm3"},        {"g/cc", "g/cm3"},
    {"kg/m^3", "kg/m3"}};

bool is_unit_of(std::string_view unit, Dimension dimension) {
  const std::vector<Unit>& units = table_of(dimension);
  return std::any_of(units.begin(), units.end(), [&](const Unit& known) { return unit == known.name; });
}

/// The unit of a dimension that a word means, by another spelling or with a slip; empty without one.
std::string meant_unit(std::string_view unit, Dimension dimension) {
  for (const Spelling& spelling : kSpellings)
    if (same_but_case(unit, spelling.written) && is_unit_of(spelling.meant, dimension)) return spelling.meant;
  return nearest_word(std::string(unit), units_of(dimension));
}

/// A dimension of which the word is a unit.
std::optional<Dimension> dimension_of(std::string_view unit) {
  for (const Dimension dimension :
       {Dimension::length, Dimension::time, Dimension::angle, Dimension::energy, Dimension::inverse_length,
        Dimension::frequency, Dimension::density, Dimension::photons_per_energy, Dimension::length_per_energy,
        Dimension::dimensionless})
    if (is_unit_of(unit, dimension)) return dimension;
  return std::nullopt;
}

/// The error of a unit that is none of the dimension's.
/// @param number  that it follows, for the hint; empty: the unit stands alone
Problem unknown_unit(std::string_view number, std::string_view unit, Dimension dimension) {
  std::string what = "\"" + std::string(unit) + "\" is not a unit of " + dimension_name(dimension);
  std::string hint = "use one of " + accepted(dimension);
  if (const auto other = dimension_of(unit)) {
    what += *other == Dimension::dimensionless ? "" : ", but of " + dimension_name(*other);
  } else if (const std::string meant = meant_unit(unit, dimension); !meant.empty()) {
    const std::string written = number.empty() ? meant : std::string(number) + " " + meant;
    hint = "did you mean \"" + written + "\"? " + hint;
  }
  return {{}, what, hint};
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
    case Dimension::length_per_energy:
      return "length per energy";
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
  throw InputError(unknown_unit("", unit, dimension));
}

namespace {

/// The error of a text that does not begin with a number.
Problem no_number(std::string_view text, Dimension dimension) {
  const std::string minus = "\u2212";
  if (text.rfind(minus, 0) == 0)
    return {{},
            "\"" + std::string(text) + "\" begins with a typographic minus sign",
            "type a plain one: \"-" + std::string(text.substr(minus.size())) + "\""};
  return {{},
          "\"" + std::string(text) + "\" does not start with a finite number",
          "write a number and a unit of " + dimension_name(dimension) + ", as " + example(dimension)};
}

/// The error of what follows a number and is no unit of the dimension.
Problem no_unit(std::string_view number, std::string_view rest, Dimension dimension) {
  const std::string all = std::string(number) + std::string(rest);
  if (rest.size() > 1 && rest[0] == ',' && rest[1] >= '0' && rest[1] <= '9')
    return {{},
            "\"" + all + "\" has a comma in its number",
            "write a point: \"" + std::string(number) + "." + std::string(rest.substr(1)) + "\""};
  if (rest[0] == '*' && is_unit_of(trim(rest.substr(1)), dimension))
    return {{},
            "\"" + all + "\" has a * between number and unit",
            "leave it out: \"" + std::string(number) + " " + std::string(trim(rest.substr(1))) + "\""};
  return unknown_unit(number, rest, dimension);
}

/// A Greek mu, which looks like the micro sign, as the micro sign.
std::string with_micro_sign(std::string_view unit) {
  std::string same(unit);
  const std::string mu = "\u03bc";
  if (same.rfind(mu, 0) == 0) same.replace(0, mu.size(), "\u00b5");
  return same;
}

}  // namespace

double parse_quantity(std::string_view text, Dimension dimension) {
  const std::string_view trimmed = trim(text);
  double value = 0.0;
  const auto [end, status] = std::from_chars(trimmed.data(), trimmed.data() + trimmed.size(), value);
  if (status != std::errc{} || !std::isfinite(value)) throw InputError(no_number(trimmed, dimension));
  const auto digits = static_cast<std::size_t>(end - trimmed.data());
  const std::string unit = with_micro_sign(trim(trimmed.substr(digits)));
  if (unit.empty()) {
    if (dimension == Dimension::dimensionless) return value;
    throw InputError({{},
                      "\"" + std::string(text) + "\" has no unit, but " +
                          with_article(dimension_name(dimension)) + " is expected",
                      "add one of " + accepted(dimension)});
  }
  if (dimension == Dimension::wavelength && unit == "eV") {
    if (!(value > 0.0))
      throw InputError({{}, "a photon energy of \"" + std::string(text) + "\"", "give a positive energy"});
    return kHc_eV_nm / value;
  }
  if (!is_unit_of(unit, dimension)) throw InputError(no_unit(trimmed.substr(0, digits), unit, dimension));
  return value * unit_factor(unit, dimension);
}

}  // namespace scintray::core
