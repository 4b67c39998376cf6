#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "scintray/exchange/gate/detail/gate.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gate {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// "name=Oxygen ; n=1" as name and value of each field, names in lower case.
std::map<std::string, std::string> fields_of(const std::string& text) {
  std::map<std::string, std::string> fields;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) continue;
    std::string name = trimmed(part.substr(0, equals));
    for (char& c : name)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    fields[name] = trimmed(part.substr(equals + 1));
  }
  return fields;
}

}  // namespace

MaterialDatabase::MaterialDatabase(const std::filesystem::path& path) {
  std::istringstream lines(mesh::read_mesh_file(path));
  core::FileLocation where{path.string(), 0, 0};
  std::map<std::string, Entry>* section = nullptr;
  Entry* last = nullptr;
  Entry passed_over;
  for (std::string line; std::getline(lines, line);) {
    ++where.line;
    std::string text = trimmed(line.substr(0, line.find('#')));
    if (text.starts_with("//")) continue;
    if (text.empty()) continue;
    if (text[0] == '[') {
      section = text.starts_with("[Elements]")    ? &elements_
                : text.starts_with("[Materials]") ? &materials_
                                                  : nullptr;
      last = nullptr;
      continue;
    }
    const std::size_t colon = text.find(':');
    if (!section) continue;  // isotopes
    if (colon == std::string::npos)
      throw core::InputError(core::Problem{where, core::in_quotes(text) + " has no colon",
                                           "expected NAME: d=... g/cm3; n=..., or +el: name=...; n=..."});
    std::map<std::string, std::string> fields = fields_of(text.substr(colon + 1));
    if (text[0] == '+') {
      if (!last)
        throw core::InputError(core::Problem{where, "a component without a material before it",
                                             "begin with NAME: d=... g/cm3; n=..."});
      fields["kind"] = trimmed(text.substr(1, colon - 1));
      last->components.push_back(std::move(fields));
      continue;
    }
    // Of several of one name the first is read, as GATE searches from the beginning.
    const auto [added, is_new] =
        section->try_emplace(trimmed(text.substr(0, colon)), Entry{std::move(fields), {}, where});
    last = is_new ? &added->second : &passed_over;
  }
}

std::vector<std::string> MaterialDatabase::names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : materials_) names.push_back(name);
  return names;
}

bool MaterialDatabase::add_composition(const std::string& material, pugi::xml_node target,
                                       GdmlDocument& document) {
  const auto found = materials_.find(material);
  if (found == materials_.end()) return false;
  const Entry& entry = found->second;
  const auto density = entry.fields.find("d");
  std::istringstream words(density == entry.fields.end() ? "" : density->second);
  double value = 0.0;
  std::string unit;
  if (!(words >> value >> unit) || !(value > 0.0))
    throw core::InputError(
        core::Problem{entry.where, "material \"" + material + "\" has no density", "write d=7.4 g/cm3"});
  pugi::xml_node node = GdmlDocument::add(target, "D", entry.where);
  node.append_attribute("value") = fmt::format("{:.17g}", value).c_str();
  node.append_attribute("unit") = unit.c_str();
  add_parts(entry, material, target, document);
  return true;
}

void MaterialDatabase::add_parts(const Entry& entry, const std::string& name, pugi::xml_node target,
                                 GdmlDocument& document) {
  for (const std::map<std::string, std::string>& component : entry.components) {
    const auto field = [&](const char* wanted) {
      const auto found = component.find(wanted);
      return found == component.end() ? std::string() : found->second;
    };
    std::string part = field("name");
    if (part == "auto") part = name;
    const bool element = field("kind") == "el";
    const auto& known = element ? elements_ : materials_;
    const auto found = known.find(part);
    if (found == known.end() || (field("n").empty() && field("f").empty()))
      throw core::InputError(core::Problem{
          entry.where, "component " + core::in_quotes(part) + " of \"" + name + "\" cannot be read",
          "expected +el: or +mat: with the name of an entry of the file, and n= or f="});
    const std::string reference = (element ? "element " : "component ") + part;
    if (!written_[reference]) {
      written_[reference] = true;
      const Entry& inner = found->second;
      pugi::xml_node node = document.section("materials").prepend_child(element ? "element" : "material");
      node.append_attribute("name") = reference.c_str();
      node.append_attribute("origin") = inner.where.text().c_str();
      if (!element) {
        add_composition(part, node, document);
      } else {
        const auto number_of = [&](const char* key) {
          const auto value = inner.fields.find(key);
          return value == inner.fields.end() ? 0.0 : std::atof(value->second.c_str());
        };
        node.append_attribute("Z") = number_of("z");
        node.append_child("atom").append_attribute("value") = number_of("a");
      }
    }
    const bool by_number = !field("n").empty();
    pugi::xml_node share = GdmlDocument::add(target, by_number ? "composite" : "fraction", entry.where);
    share.append_attribute("n") = field(by_number ? "n" : "f").c_str();
    share.append_attribute("ref") = reference.c_str();
  }
}

}  // namespace scintray::exchange::gate
