#include "scintray/exchange/gdml/detail/gdml_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "scintray/exchange/gdml/detail/xml_entities.hpp"
#include "scintray/exchange/gdml/detail/xml_text.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gdml {

namespace {

/// The place "file:line:column".
core::FileLocation stated_place(const std::string& text) {
  const std::size_t column = text.rfind(':');
  const std::size_t line = column == std::string::npos ? column : text.rfind(':', column - 1);
  if (line == std::string::npos) return {text, 0, 0};
  return {text.substr(0, line), std::atol(text.c_str() + line + 1), std::atol(text.c_str() + column + 1)};
}

}  // namespace

void for_each_module(Node element, const std::function<void(Node)>& action) {
  const bool is_placement = std::string_view(element.name()) == "physvol";
  for (const Node child : element.children()) {
    if (is_placement && std::string_view(child.name()) == "file")
      action(child);
    else
      for_each_module(child, action);
  }
}

GdmlFile::Document::Document(std::string content, const std::string& file, const std::filesystem::path& root)
    : text(std::move(content), file, root), folder(std::filesystem::path(file).parent_path()), path(file) {
  if (mesh::xml_depth(text.text()) > mesh::kDeepestNesting)
    throw core::InputError(core::Problem{{file},
                                         "XML elements are nested more than 500 deep",
                                         "write it again: GDML has elements in each other 10 deep at most"});
  const pugi::xml_parse_result parsed = xml.load_buffer(text.text().data(), text.text().size());
  if (!parsed)
    throw core::InputError(
        core::Problem{text.where(parsed.offset),
                      std::string("the GDML file is not well-formed XML: ") + parsed.description(),
                      "mend it at this place, or write it again"});
}

GdmlFile::GdmlFile(std::string content, const std::string& file, Origins origins)
    : root_(std::filesystem::path(file).parent_path()), origins_(origins) {
  auto document = std::make_unique<Document>(std::move(content), file, root_);
  for (const char* needed : {"solids", "structure"})
    if (!document->xml.document_element().child(needed))
      throw core::InputError(
          core::Problem{{file},
                        "not a GDML file with a geometry: it has no <" + std::string(needed) + ">",
                        "expected <gdml> with <define>, <materials>, <solids>, <structure>, <setup>"});
  add(std::move(document), {});
}

void GdmlFile::add(std::unique_ptr<Document> document, std::vector<std::size_t> around) {
  const std::size_t number = documents_.size();
  std::error_code error;
  document->path = std::filesystem::weakly_canonical(document->path, error);
  by_root_.emplace(document->xml.internal_object(), number);
  documents_.push_back(std::move(document));
  around.push_back(number);
  for (const Node structure : documents_[number]->xml.document_element().children("structure"))
    for_each_module(structure, [&](Node file) { add_module(file, around); });
}

void GdmlFile::add_module(Node file, const std::vector<std::size_t>& around) {
  constexpr std::size_t kMostModules = 1000;
  const std::string name = required(file, "name");
  const auto path = included_file(name, documents_[document_of(file)]->folder, root_, where(file));
  std::error_code error;
  const auto known = std::find_if(documents_.begin(), documents_.end(),
                                  [canonical = std::filesystem::weakly_canonical(path, error)](
                                      const auto& d) { return d->path == canonical; });
  const auto number = static_cast<std::size_t>(known - documents_.begin());
  if (std::find(around.begin(), around.end(), number) != around.end())
    reject(file, "the module " + core::in_quotes(name) + " includes itself",
           "name another file, or refer to a volume of this one with <volumeref>");
  modules_.emplace(file.internal_object(), number);
  if (known != documents_.end()) return;
  if (number > kMostModules)
    reject(file, "more than 1000 modules", "merge files, so that each holds several volumes");
  add(std::make_unique<Document>(mesh::read_mesh_file(path), path.string(), root_), around);
}

std::vector<Node> GdmlFile::sections(const std::string& name) const {
  std::vector<Node> sections;
  for (const auto& document : documents_)
    for (const Node section : document->xml.document_element().children(name.c_str()))
      sections.push_back(section);
  return sections;
}

Node GdmlFile::section(const char* name, std::size_t document) const {
  return documents_[document]->xml.document_element().child(name);
}

std::size_t GdmlFile::document_of(Node node) const {
  if (documents_.size() == 1) return 0;
  const auto found = by_root_.find(node.root().internal_object());
  return found == by_root_.end() ? 0 : found->second;
}

core::FileLocation GdmlFile::where(Node node) const {
  if (origins_ == Origins::stated) {
    for (Node element = node; element; element = element.parent())
      if (const pugi::xml_attribute origin = element.attribute("origin")) return stated_place(origin.value());
    return documents_.front()->text.where(-1);
  }
  return documents_[document_of(node)]->text.where(node ? node.offset_debug() : -1);
}

void GdmlFile::reject(Node node, const std::string& what, const std::string& hint) const {
  throw core::InputError(core::Problem{where(node), what, hint});
}

std::string GdmlFile::required(Node node, const char* attribute) const {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found)
    reject(node, std::string("<") + node.name() + "> has no \"" + attribute + "\"",
           std::string("add ") + attribute + "=\"...\"");
  return found.value();
}

}  // namespace scintray::exchange::gdml
