#include "scintray/exchange/gdml/detail/gdml_file.hpp"

#include <algorithm>
#include <cstdlib>

#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gdml {

namespace {

std::vector<std::size_t> starts_of_lines(const std::string& text) {
  std::vector<std::size_t> starts{0};
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') starts.push_back(i + 1);
  return starts;
}

core::FileLocation location(const std::string& file, const std::vector<std::size_t>& starts,
                            std::ptrdiff_t offset) {
  if (offset < 0) return {file, 0, 0};
  const auto at = static_cast<std::size_t>(offset);
  const auto next = std::upper_bound(starts.begin(), starts.end(), at);
  return {file, static_cast<long>(next - starts.begin()), static_cast<long>(at - *(next - 1)) + 1};
}

/// The place "file:line:column".
core::FileLocation stated_place(const std::string& text) {
  const std::size_t column = text.rfind(':');
  const std::size_t line = column == std::string::npos ? column : text.rfind(':', column - 1);
  if (line == std::string::npos) return {text, 0, 0};
  return {text.substr(0, line), std::atol(text.c_str() + line + 1), std::atol(text.c_str() + column + 1)};
}

}  // namespace

GdmlFile::GdmlFile(std::string content, std::string file, Origins origins)
    : content_(std::move(content)),
      file_(std::move(file)),
      origins_(origins),
      line_starts_(starts_of_lines(content_)) {
  if (mesh::xml_depth(content_) > mesh::kDeepestNesting)
    throw core::InputError(core::Problem{{file_}, "XML elements are nested more than 500 deep", ""});
  if (const std::size_t entity = content_.find("<!ENTITY"); entity != std::string::npos)
    throw core::InputError(core::Problem{location(file_, line_starts_, static_cast<std::ptrdiff_t>(entity)),
                                         "the GDML file includes other files, by <!ENTITY>",
                                         "merge them first, for example with: xmllint --noent FILE"});
  const pugi::xml_parse_result parsed = document_.load_buffer(content_.data(), content_.size());
  if (!parsed)
    throw core::InputError(
        core::Problem{location(file_, line_starts_, parsed.offset),
                      std::string("the GDML file is not well-formed XML: ") + parsed.description(),
                      "mend it at this place, or write it again"});
  for (const char* needed : {"solids", "structure"})
    if (!section(needed))
      throw core::InputError(
          core::Problem{{file_},
                        "not a GDML file with a geometry: it has no <" + std::string(needed) + ">",
                        "expected <gdml> with <define>, <materials>, <solids>, <structure>, <setup>"});
}

Node GdmlFile::section(const char* name) const { return document_.document_element().child(name); }

core::FileLocation GdmlFile::where(Node node) const {
  if (origins_ == Origins::stated) {
    for (Node element = node; element; element = element.parent())
      if (const pugi::xml_attribute origin = element.attribute("origin")) return stated_place(origin.value());
    return {file_, 0, 0};
  }
  return location(file_, line_starts_, node ? node.offset_debug() : -1);
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
