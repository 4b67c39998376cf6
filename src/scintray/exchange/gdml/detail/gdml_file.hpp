#pragma once
/// The XML of a GDML file, with places for messages.

#include <functional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::exchange::gdml {

using Node = pugi::xml_node;

/// Where elements come from, for messages.
enum class Origins {
  own,     ///< the place in the file
  stated,  ///< "file:line:column" in the attribute `origin` of the element or of one around it
};

/// A parsed file.
class GdmlFile {
 public:
  /// Parses the content; `file` is the name for messages. Throws InputError for XML that is not well-formed
  /// or is nested more than 500 deep, for entities that include other files, and for a document without
  /// <solids> and <structure>.
  GdmlFile(std::string content, std::string file, Origins origins = Origins::own);

  /// A section of the document (define, materials, solids, structure, setup); empty when it is absent.
  Node section(const char* name) const;
  core::FileLocation where(Node node) const;

  /// Throws InputError at the node.
  [[noreturn]] void reject(Node node, const std::string& what, const std::string& hint = {}) const;
  /// The attribute's text. Throws when it is missing.
  std::string required(Node node, const char* attribute) const;

 private:
  std::string content_, file_;
  Origins origins_;
  pugi::xml_document document_;
  std::vector<std::size_t> line_starts_;
};

}  // namespace scintray::exchange::gdml
