#include "scintray/config/detail/toml_words.hpp"

namespace scintray::config {

namespace {

using Kind = TomlNode::Kind;

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
    case core::Dimension::dimensionless:
      return "";
  }
  throw core::InternalError("unknown dimension");
}

std::string expected_quantity(core::Dimension dimension) {
  if (dimension == core::Dimension::dimensionless) return "a number, or a string as \"97 %\"";
  const std::string name = core::dimension_name(dimension);
  return (name.find_first_of("aeiou") == 0 ? "an " : "a ") + name + " with its unit, as \"2 " +
         usual_unit(dimension) + "\"";
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = core::nearest_word(word, known);
  return near.empty() ? "" : "did you mean \"" + near + "\"? ";
}

}  // namespace scintray::config
