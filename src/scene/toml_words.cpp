#include "scintray/scene/toml_words.hpp"

namespace scintray {

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
  throw InternalError("unknown kind of TOML value");
}

std::string usual_unit(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "mm";
    case Dimension::inverse_length:
      return "1/mm";
    case Dimension::wavelength:
      return "nm";
    case Dimension::time:
      return "ns";
    case Dimension::frequency:
      return "GHz";
    case Dimension::angle:
      return "deg";
    case Dimension::energy:
      return "keV";
    case Dimension::density:
      return "g/cm3";
    case Dimension::photons_per_energy:
      return "photons/MeV";
    case Dimension::dimensionless:
      return "";
  }
  throw InternalError("unknown dimension");
}

std::string expected_quantity(Dimension dimension) {
  if (dimension == Dimension::dimensionless) return "a number, or a string as \"97 %\"";
  const std::string name = dimension_name(dimension);
  return (name.find_first_of("aeiou") == 0 ? "an " : "a ") + name + " with its unit, as \"2 " +
         usual_unit(dimension) + "\"";
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest_word(word, known);
  return near.empty() ? "" : "did you mean \"" + near + "\"? ";
}

}  // namespace scintray
