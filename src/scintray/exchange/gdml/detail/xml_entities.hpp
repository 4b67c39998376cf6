#pragma once
/// Entities that the DOCTYPE of an XML document declares, and places in texts.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::exchange::gdml {

/// Path of a file that another names: relative to the folder of the file that names it, else to `root`, the
/// folder of the first file, in which Geant4 is started as a rule. Throws InputError at `where` when it is
/// not in `root` or below, links resolved, or is no regular file: a file from elsewhere may name any file of
/// its reader, a pipe or a device.
std::filesystem::path included_file(const std::string& name, const std::filesystem::path& folder,
                                    const std::filesystem::path& root, const core::FileLocation& where);

/// Offsets at which the lines of a text start.
std::vector<std::size_t> starts_of_lines(std::string_view text);
/// Place of an offset in a text.
core::FileLocation place_in(const std::string& file, const std::vector<std::size_t>& starts,
                            std::size_t offset);

/// Position after the next `end`, or that of the text's end.
std::size_t after(std::string_view text, std::string_view end, std::size_t from);
/// Position after the comment, processing instruction or character data that starts at `at`; `at` when none
/// does.
std::size_t after_passive(std::string_view text, std::size_t at);
/// Position after the mark of a file's encoding and the XML declaration, which are not part of its text.
std::size_t start_of_text(std::string_view content);

struct XmlEntity {
  bool external = false;
  std::string text;  ///< its text, or the name of its file
  core::FileLocation declared;
};
using XmlEntities = std::map<std::string, XmlEntity, std::less<>>;

/// The declarations of a document (Extensible Markup Language 1.0, 5th edition, sections 2.8 and 4): those of
/// its internal subset, and of the parameter entities that it refers to, <!ENTITY % name SYSTEM "file"> and
/// %name;, also within each other; in files, parameter entities within the text of another entity as well.
struct XmlDeclarations {
  /// Throws InputError, with file and line, for declarations of entities of other forms, conditional
  /// sections, parameter entities that are not declared or contain themselves, and declarations of over 8
  /// MiB; and as included_file.
  XmlDeclarations(std::string_view content, const std::string& file, const std::filesystem::path& root);

  XmlEntities entities;
  std::size_t end = 0;   ///< of the internal subset in the content; 0 without one
  std::size_t read = 0;  ///< bytes of other files
};

}  // namespace scintray::exchange::gdml
