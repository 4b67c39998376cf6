#include "scintray/mesh/file_unit.hpp"

#include <cmath>
#include <cstdio>
#include <pugixml.hpp>
#include <string_view>

#include "scintray/mesh/file_checks.hpp"

namespace scintray {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// The first element of this name, attributes read, its content not looked at: a model may be large.
pugi::xml_node parse_start(std::string_view text, const char* element, pugi::xml_document& document) {
  const std::string opening = "<" + std::string(element);
  std::size_t at = text.find(opening);
  // "<model" must not find "<modeller".
  while (at != std::string_view::npos && at + opening.size() < text.size() &&
         std::string_view(" \t\r\n/>").find(text[at + opening.size()]) == std::string_view::npos)
    at = text.find(opening, at + 1);
  if (at == std::string_view::npos) return {};
  const std::size_t close = text.find('>', at);
  if (close == std::string_view::npos) return {};
  std::string start(text.substr(at, close - at));
  if (!start.ends_with('/')) start += '/';
  start += '>';
  document.load_string(start.c_str());
  return document.child(element);
}

}  // namespace

FileUnit read_collada_unit(const std::filesystem::path& path, const std::string& content) {
  pugi::xml_document document;
  const pugi::xml_node unit = parse_start(content, "unit", document);
  const pugi::xml_attribute meter = unit.attribute("meter");
  constexpr double kMetre_mm = 1000.0;
  if (!meter) return {"meter", kMetre_mm, false, kMetre_mm};
  const double mm = kMetre_mm * meter.as_double();
  if (!std::isfinite(mm) || mm <= 0.0)
    reject_file(path,
                std::string("the COLLADA file gives its unit as \"") + meter.value() +
                    "\" metres; expected a number above 0",
                "export the mesh again");
  return {unit.attribute("name").as_string("unit of its own"), mm, true, kMetre_mm};
}

double resolve_unit(const std::filesystem::path& path, double given_mm, const FileUnit& unit,
                    std::vector<std::string>& notes) {
  constexpr double kRounding = 1e-6;  // files round their units: 0.0254, 0.3048
  if (!std::isfinite(given_mm) || given_mm < 0.0)
    reject_file(path, "the mesh's unit is not a positive length", "give for example unit = \"mm\"");
  const bool known = unit.mm > 0.0;
  if (given_mm == 0.0 && !known)
    reject_file(path, "the file does not say in which unit its coordinates are",
                "say it beside the mesh, for example unit = \"mm\" (or \"um\", \"cm\", \"m\", \"inch\")");
  const bool contradicts = known && given_mm > 0.0 && std::abs(given_mm - unit.mm) > kRounding * unit.mm;
  const std::string stated = unit.name + " (" + number(unit.mm) + " mm)";
  if (contradicts && unit.written)
    reject_file(
        path, "the file says that it is in " + stated + ", but the unit given is " + number(given_mm) + " mm",
        "remove unit: the file's own is used. When the file is wrong, correct it with scale = " +
            number(given_mm / unit.mm));
  if (contradicts)
    notes.push_back("the unit given, " + number(given_mm) + " mm, replaces what the format prescribes, " +
                    stated);
  const double unit_mm = given_mm > 0.0 ? given_mm : unit.mm;
  return known ? unit_mm / unit.mm * unit.read_mm : unit_mm;
}

}  // namespace scintray
