#include "scintray/mesh/file_unit.hpp"

#include <zip.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <pugixml.hpp>
#include <string_view>

#include "scintray/mesh/file_checks.hpp"

namespace scintray {
namespace {

/// 3MF Core Specification 1.3, section 3.4.
constexpr std::array<std::pair<const char*, double>, 6> k3mfUnits{{{"micron", 1e-3},
                                                                   {"millimeter", 1.0},
                                                                   {"centimeter", 10.0},
                                                                   {"inch", 25.4},
                                                                   {"foot", 304.8},
                                                                   {"meter", 1000.0}}};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// The part of the archive that the relationships name as the model; "3D/3dmodel.model" is customary.
std::string model_entry(const std::string& relationships) {
  pugi::xml_document document;
  if (document.load_buffer(relationships.data(), relationships.size()))
    for (const pugi::xml_node& relation : document.child("Relationships").children())
      if (std::string_view(relation.attribute("Type").value()).ends_with("/3dmodel")) {
        const std::string target = relation.attribute("Target").value();
        return target.starts_with("/") ? target.substr(1) : target;
      }
  return "3D/3dmodel.model";
}

/// An entry of the archive, or nothing. `most` bounds what is unpacked.
std::string unpack(zip_t* archive, const std::string& name, std::size_t most) {
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_stat(archive, name.c_str(), 0, &stat) != 0 || !(stat.valid & ZIP_STAT_SIZE) || stat.size > most)
    return {};
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> entry(zip_fopen(archive, name.c_str(), 0),
                                                                zip_fclose);
  std::string content(stat.size, '\0');
  if (!entry || zip_fread(entry.get(), content.data(), stat.size) != static_cast<zip_int64_t>(stat.size))
    return {};
  return content;
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

FileUnit read_3mf_unit(const std::filesystem::path& path, const std::string& content) {
  constexpr std::size_t kMostDeflateRatio = 1032;  // RFC 1951: no stream grows by more
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(content.data(), content.size(), 0, &error);
  std::unique_ptr<zip_t, void (*)(zip_t*)> archive(nullptr, zip_discard);
  if (source) archive.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
  const std::string reason = zip_error_strerror(&error);
  zip_error_fini(&error);
  if (!archive) {
    if (source) zip_source_free(source);
    reject_file(path, "not a 3MF file: " + reason, "export the mesh again as 3MF");
  }
  const std::size_t most = kMostDeflateRatio * content.size();
  const std::string model =
      unpack(archive.get(), model_entry(unpack(archive.get(), "_rels/.rels", most)), most);
  pugi::xml_document document;
  const pugi::xml_node element = parse_start(model, "model", document);
  if (!element)
    reject_file(path, "the 3MF file has no model, or it cannot be unpacked", "export the mesh again as 3MF");
  const pugi::xml_attribute unit = element.attribute("unit");
  const std::string name = unit ? unit.value() : "millimeter";
  for (const auto& [known, mm] : k3mfUnits)
    if (name == known) return {name, mm, !unit.empty(), mm};
  reject_file(
      path,
      "the 3MF file is in \"" + name + "\"; expected micron, millimeter, centimeter, inch, foot or meter",
      "export the mesh again");
}

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
