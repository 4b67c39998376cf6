#include "scintray/config/detail/toml_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace scintray::config {

namespace {

using Kind = TomlNode::Kind;

/// Words for a key in other programs. The first that is known in a table is meant.
struct OtherWord {
  const char* word;
  const char* meant;
};
constexpr OtherWord kOtherWords[] = {{"material", "medium"},
                                     {"finish", "surface"},
                                     {"solid", "box"},
                                     {"size", "box"},
                                     {"dimensions", "box"},
                                     {"file", "mesh"},
                                     {"stl", "mesh"},
                                     {"detector", "sensor"},
                                     {"pmt", "sensor"},
                                     {"sipm", "sensor"},
                                     {"position", "translate"},
                                     {"location", "translate"},
                                     {"centre", "translate"},
                                     {"center", "translate"},
                                     {"rotation", "rotate"},
                                     {"placement", "place"},
                                     {"number", "photons"},
                                     {"number", "events"},
                                     {"count", "photons"},
                                     {"primaries", "events"},
                                     {"volume", "region"},
                                     {"particle", "type"},
                                     {"random_seed", "seed"},
                                     {"cores", "threads"},
                                     {"background", "ambient"},
                                     {"world", "ambient"},
                                     {"length", "height"},
                                     {"diameter", "radius"},
                                     {"refractive_index", "index"},
                                     {"rindex", "index"},
                                     {"abslength", "absorption"},
                                     {"absorption_length", "absorption"},
                                     {"coupling", "fill"},
                                     {"grease", "fill"},
                                     {"finish", "model"},
                                     {"reflectivity", "reflectance"},
                                     {"reflection", "reflectance"},
                                     {"qe", "efficiency"},
                                     {"pde", "efficiency"},
                                     {"quantum_efficiency", "efficiency"},
                                     {"lambda", "wavelength"},
                                     {"sigmaalpha", "sigma_alpha"},
                                     {"specular_lobe", "lobe"},
                                     {"specular_spike", "spike"},
                                     {"back_scatter", "backscatter"}};

}  // namespace

std::string kind_name(const TomlNode& value) {
  switch (value.kind) {
    case Kind::string:
      return "the string \"" + value.text + "\"";
    case Kind::integer:
      return "the integer " + value.text;
    case Kind::number:
      return "the number " + value.text;
    case Kind::boolean:
      return "the boolean " + value.text;
    case Kind::date:
      return "the date or time " + value.text;
    case Kind::array:
      return "an array";
    case Kind::table:
      return "a table";
  }
  throw core::InternalError("unknown kind of TOML value");
}

std::string usual_unit(core::Dimension dimension) {
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
      return "GHz";
    case core::Dimension::angle:
      return "deg";
    case core::Dimension::energy:
      return "keV";
    case core::Dimension::density:
      return "g/cm3";
    case core::Dimension::photons_per_energy:
      return "photons/MeV";
    case core::Dimension::length_per_energy:
      return "mm/MeV";
    case core::Dimension::dimensionless:
      return "";
  }
  throw core::InternalError("unknown dimension");
}

namespace {

/// A number that a quantity of a dimension may well have in its usual unit.
std::string example_number(core::Dimension dimension) {
  switch (dimension) {
    case core::Dimension::wavelength:
      return "420";
    case core::Dimension::angle:
      return "30";
    case core::Dimension::energy:
      return "511";
    default:
      return "2";
  }
}

}  // namespace

std::string expected_quantity(core::Dimension dimension) {
  if (dimension == core::Dimension::dimensionless) return "a number, or a string as \"97 %\"";
  return core::with_article(core::dimension_name(dimension)) + " with its unit, as \"" +
         example_number(dimension) + " " + usual_unit(dimension) + "\"";
}

std::string with_unit_hint(const std::string& number, core::Dimension dimension) {
  const auto with = [&](const std::string& unit) { return "\"" + number + " " + unit + "\""; };
  const std::string begin = "write it as a string with its unit, as ",
                    usual = begin + with(usual_unit(dimension));
  std::string digits = number;
  std::erase(digits, '_');
  const double size = std::abs(std::strtod(digits.c_str(), nullptr));
  // Bare numbers come from programs that have a unit of their own; of light and angles the size shows which.
  constexpr double kFullTurn_rad = 6.2831853072, kLeast_nm = 100.0, kMost_eV = 12.4, kMost_um = 1.2;
  switch (dimension) {
    case core::Dimension::angle:
      if (size > kFullTurn_rad) return usual;
      return usual + ", or as " + with("rad") + ": Geant4's are in radians";
    case core::Dimension::energy:
      return usual + ", or as " + with("MeV") + ": Geant4's are in MeV";
    case core::Dimension::wavelength:
      if (size >= kLeast_nm) return usual;
      if (size > kMost_um && size <= kMost_eV) return begin + with("eV") + " for a photon energy";
      if (size <= kMost_um) return begin + with("um") + ", or as " + with("eV") + " for a photon energy";
      return usual + ", or as " + with("eV") + " for a photon energy";
    default:
      return usual;
  }
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  for (const OtherWord& other : kOtherWords)
    if (core::same_but_case(word, other.word) &&
        std::find(known.begin(), known.end(), other.meant) != known.end())
      return std::string("did you mean \"") + other.meant + "\"? ";
  const std::string near = core::nearest_word(word, known);
  return near.empty() ? "" : "did you mean \"" + near + "\"? ";
}

}  // namespace scintray::config
