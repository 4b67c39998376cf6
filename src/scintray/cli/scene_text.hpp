#pragma once
/// Edits of a scene file's text that leave the rest of it unchanged.

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"

namespace scintray::cli {

class SceneText {
 public:
  explicit SceneText(const std::string& text);

  /// Replaces the content of a string. Throws InputError for a string with escapes, whose text differs from
  /// its content.
  void replace(const config::TomlNode& string, const std::string& content);

  /// True when a member of a table, with its content, is on lines of its own.
  bool on_lines_of_its_own(const config::TomlNode& member) const;
  /// Comments out the lines of such a member.
  void comment_out(const config::TomlNode& member);

  std::string whole() const;

 private:
  std::string& line_of(const config::TomlNode& node);
  std::vector<std::string> lines_;
};

}  // namespace scintray::cli
