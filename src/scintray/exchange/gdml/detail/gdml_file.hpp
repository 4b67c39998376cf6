#pragma once
/// The XML of a GDML file and of the files that it includes, with places for messages.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/exchange/gdml/detail/xml_text.hpp"

namespace scintray::exchange::gdml {

using Node = pugi::xml_node;

/// Where elements come from, for messages.
enum class Origins {
  own,     ///< the place in the file
  stated,  ///< "file:line:column" in the attribute `origin` of the element or of one around it
};

/// A parsed file, and the modules that its volumes name by <file> in a <physvol>, each once.
class GdmlFile {
 public:
  /// Parses the content; `file` is the name for messages, and in its folder or below lie the files that are
  /// included, as entities (XmlText) or modules. Throws InputError for XML that is not well-formed or is
  /// nested more than 500 deep, for a document without <solids> and <structure>, for a module that includes
  /// itself, more than 1000 modules, and as XmlText and included_file.
  GdmlFile(std::string content, const std::string& file, Origins origins = Origins::own);

  /// The sections of a name (define, materials, solids, structure, setup) of the file, then those of its
  /// modules in the order in which Geant4 reads them.
  std::vector<Node> sections(const std::string& name) const;
  /// The first section of a name of the file, or of the module with this number; empty when it is absent.
  Node section(const char* name, std::size_t document = 0) const;
  /// Number of the file that an element belongs to: 0 of the first, those of modules in their order.
  std::size_t document_of(Node node) const;
  /// Number of the module that a <file> names.
  std::size_t module_of(Node file) const { return modules_.at(file.internal_object()); }
  std::size_t document_count() const { return documents_.size(); }
  core::FileLocation where(Node node) const;

  /// Throws InputError at the node.
  [[noreturn]] void reject(Node node, const std::string& what, const std::string& hint) const;
  /// The attribute's text. Throws when it is missing.
  std::string required(Node node, const char* attribute) const;

 private:
  struct Document {
    Document(std::string content, const std::string& file, const std::filesystem::path& root);
    XmlText text;
    std::filesystem::path folder, path;
    pugi::xml_document xml;
  };
  void add(std::unique_ptr<Document> document, std::vector<std::size_t> around);
  void add_module(Node file, const std::vector<std::size_t>& around);

  std::filesystem::path root_;
  Origins origins_;
  std::vector<std::unique_ptr<Document>> documents_;
  std::map<const void*, std::size_t> by_root_, modules_;  ///< of elements in pugixml's memory
};

/// Calls `action` for each <file> in a <physvol> within the element, in the order of the file.
void for_each_module(Node element, const std::function<void(Node)>& action);

}  // namespace scintray::exchange::gdml
