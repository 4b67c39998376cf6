#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "scintray/exchange/gate/detail/gate.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gate {

namespace {

/// Number of an attribute. @throws InputError where it is missing or no number
double attribute(const PropertyFile& file, pugi::xml_node node, const char* name) {
  const std::string text = node.attribute(name).value();
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end == text.c_str() || *end != '\0' || !std::isfinite(value))
    throw core::InputError(core::Problem{
        file.where(node), fmt::format("<{}>: {} = {} is no number", node.name(), name, core::in_quotes(text)),
        fmt::format("write <{} {}=\"...\" .../>", node.name(), name)});
  return value;
}

/// A unit as GDML has it, in brackets; 1 without one.
std::string unit_of(pugi::xml_node node, const char* name) {
  const std::string unit = node.attribute(name).value();
  return unit.empty() ? "1" : "(" + unit + ")";
}

}  // namespace

GdmlDocument::GdmlDocument() {
  root_ = document_.append_child("gdml");
  for (const char* section : {"define", "materials", "solids", "structure", "setup"})
    root_.append_child(section);
}

pugi::xml_node GdmlDocument::add(pugi::xml_node parent, const char* tag, const core::FileLocation& where) {
  pugi::xml_node node = parent.append_child(tag);
  node.append_attribute("origin") = fmt::format("{}:{}:{}", where.file, where.line, where.column).c_str();
  return node;
}

std::string GdmlDocument::add_matrix(int columns, const std::string& values,
                                     const core::FileLocation& where) {
  pugi::xml_node node = add(section("define"), "matrix", where);
  const std::string name = "matrix " + std::to_string(++matrices_);
  node.append_attribute("name") = name.c_str();
  node.append_attribute("coldim") = columns;
  node.append_attribute("values") = values.c_str();
  return name;
}

std::string GdmlDocument::text() const {
  std::ostringstream stream;
  document_.save(stream, "", pugi::format_raw);
  return stream.str();
}

PropertyFile::PropertyFile(const std::filesystem::path& path, const std::string& root)
    : path_(path.string()), content_(mesh::read_mesh_file(path)) {
  if (mesh::xml_depth(content_) > mesh::kDeepestNesting)
    throw core::InputError(
        core::Problem{{path_},
                      "XML elements are nested more than 500 deep",
                      "write it again: the files of GATE have four elements in each other"});
  const pugi::xml_parse_result parsed = document_.load_buffer(content_.data(), content_.size());
  if (!parsed || std::string(document_.document_element().name()) != root)
    throw core::InputError(
        core::Problem{{path_},
                      parsed ? "the file has no <" + root + "> around its entries"
                             : std::string("the file is not well-formed XML: ") + parsed.description(),
                      "expected a file of GATE with <" + root + ">"});
}

pugi::xml_node PropertyFile::find(const std::string& name) const {
  return document_.document_element().find_child(
      [&](pugi::xml_node node) { return name == node.attribute("name").value(); });
}

std::vector<std::string> PropertyFile::names() const {
  std::vector<std::string> names;
  for (const pugi::xml_node entry : document_.document_element().children())
    if (entry.type() == pugi::node_element) names.emplace_back(entry.attribute("name").value());
  return names;
}

core::FileLocation PropertyFile::where(pugi::xml_node node) const {
  const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, node.offset_debug()));
  const auto line = std::count(content_.begin(), content_.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  const std::size_t before = at == 0 ? std::string::npos : content_.rfind('\n', at - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return {path_, static_cast<long>(line) + 1, static_cast<long>(at - begin) + 1};
}

void PropertyFile::add_properties(pugi::xml_node entry, pugi::xml_node target, GdmlDocument& document,
                                  std::vector<std::string>& notes) const {
  for (const pugi::xml_node property : entry.child("propertiestable").children()) {
    const std::string kind = property.name(), name = property.attribute("name").value();
    if (kind != "property" && kind != "propertyvector") continue;
    if (name.empty())
      throw core::InputError(
          core::Problem{where(property), "<" + kind + "> has no name", "add name=\"...\""});
    std::string values;
    int columns = 1;
    if (kind == "property") {
      values = fmt::format("{:.17g}*{}", attribute(*this, property, "value"), unit_of(property, "unit"));
    } else {
      columns = 2;
      const auto row = [&](double energy, double value) {
        values += fmt::format("{:.17g}*{} {:.17g}*{} ", energy, unit_of(property, "energyunit"), value,
                              unit_of(property, "unit"));
      };
      std::vector<std::array<double, 2>> rows;
      for (const pugi::xml_node entry_row : property.children("ve")) {
        rows.push_back({attribute(*this, entry_row, "energy"), attribute(*this, entry_row, "value")});
        if (!(rows.back()[0] > 0.0))
          throw core::InputError(
              core::Problem{where(entry_row), name + ": an energy that is not above 0",
                            "give photon energies, as <ve energy=\"2.95\" value=\"...\"/>"});
      }
      if (rows.empty())
        throw core::InputError(core::Problem{where(property),
                                             name + " has no <ve energy=\"...\" value=\"...\"/>",
                                             "give at least one, or remove the property"});
      // A spectrum of one line: Geant4 draws its energy every time. Here it is a narrow band.
      if (rows.size() == 1 && name.find("COMPONENT") != std::string::npos) {
        constexpr double kHalfWidth = 1e-4;
        notes.push_back(where(property).text() + ": " + name + " of " + entry.attribute("name").value() +
                        " is one line: a band of 0.02 % here");
        row(rows[0][0] * (1.0 - kHalfWidth), rows[0][1]);
        row(rows[0][0] * (1.0 + kHalfWidth), rows[0][1]);
      } else {
        for (const auto& [energy, value] : rows) row(energy, value);
      }
    }
    pugi::xml_node added = GdmlDocument::add(target, "property", where(property));
    added.append_attribute("name") = name.c_str();
    added.append_attribute("ref") = document.add_matrix(columns, values, where(property)).c_str();
  }
}

void add_surface(const PropertyFile& file, pugi::xml_node entry, GdmlDocument& document,
                 std::vector<std::string>& notes) {
  static constexpr std::array kTypes{"dielectric_dielectric", "dielectric_metal", "dielectric_LUTDAVIS"};
  static constexpr std::array kPainted{"polishedbackpainted", "groundbackpainted", "polishedfrontpainted",
                                       "groundfrontpainted"};
  const std::string name = entry.attribute("name").value();
  const bool davis = std::string(entry.attribute("model").value()) == "DAVIS";
  std::string type = entry.attribute("type").value(), finish = entry.attribute("finish").value();
  const auto other = [&](const char* what, const std::string& given, const char* used) {
    notes.push_back(file.where(entry).text() + ": surface " + name + ": " + what + " \"" + given +
                    "\" is not known to GATE, which takes " + used + ", and so it is here");
  };
  if (std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end()) {
    other("type", type, kTypes[0]);
    type = kTypes[0];
  }
  const bool known = finish == "polished" || finish == "ground" || (davis && finish.ends_with("_LUT")) ||
                     std::find(kPainted.begin(), kPainted.end(), finish) != kPainted.end();
  if (!known) {
    other("finish", finish, "polished");
    finish = "polished";
  }
  pugi::xml_node surface = GdmlDocument::add(document.section("solids"), "opticalsurface", file.where(entry));
  surface.append_attribute("name") = name.c_str();
  surface.append_attribute("model") = davis ? "DAVIS" : "unified";
  surface.append_attribute("type") = type.c_str();
  surface.append_attribute("finish") = finish.c_str();
  const double degrees = entry.attribute("sigmaalpha") ? attribute(file, entry, "sigmaalpha") : 0.0;
  surface.append_attribute("value") = fmt::format("{:.17g}*deg", degrees).c_str();
  file.add_properties(entry, surface, document, notes);
}

}  // namespace scintray::exchange::gate
