#pragma once
/// Text of an XML document with its entities replaced, each character with its place.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::exchange::gdml {

/// A document as an XML processor passes it on (Extensible Markup Language 1.0, 5th edition, section 4.4):
/// references to entities that its DOCTYPE declares, <!ENTITY name "text"> or <!ENTITY name SYSTEM "file">,
/// are replaced by their text, also within each other; declarations may be in files of their own, of
/// parameter entities. Of several declarations of one name the first counts.
class XmlText {
 public:
  /// @param content  of `file`, without entities returned as it is
  /// @param root     folder in which, or below which, the files of entities have to be
  /// Throws InputError, with file and line, for entities that are not declared, contain themselves, are
  /// external within an attribute, or together become more than 8 MiB and 100 times the text that is read
  /// (the limit of libexpat 2.4, which guards against the same); and as XmlDeclarations.
  XmlText(std::string content, const std::string& file, const std::filesystem::path& root);

  const std::string& text() const { return text_; }
  /// Place of a position in the text: the line of the file that it was read from; of an entity's own text,
  /// that of the reference.
  core::FileLocation where(std::ptrdiff_t offset) const;

 private:
  class Expansion;
  struct Source {
    std::string file;
    std::vector<std::size_t> line_starts;
  };
  /// Text from `begin` on, up to the next piece, that lies at `offset` in a source; all at one place, or in
  /// step with it.
  struct Piece {
    std::size_t begin, source, offset;
    bool at_one_place;
  };

  std::string text_;
  std::vector<Source> sources_;
  std::vector<Piece> pieces_;
};

}  // namespace scintray::exchange::gdml
