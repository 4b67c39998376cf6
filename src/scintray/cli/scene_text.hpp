#pragma once
/// A scene file's text, changed in places and otherwise left as its author wrote it.

#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"

namespace scintray::cli {

class SceneText {
 public:
  explicit SceneText(const std::string& text);

  /// Gives a string another content. Throws InputError for a string with escapes in it, which is not found
  /// as it is written.
  void replace(const config::TomlNode& string, const std::string& content);

  /// Whether a member of a table, with all that is in it, stands on lines of its own.
  bool on_lines_of_its_own(const config::TomlNode& member) const;
  /// Turns the lines of such a member into comments.
  void comment_out(const config::TomlNode& member);

  std::string whole() const;

 private:
  std::string& line_of(const config::TomlNode& node);
  std::vector<std::string> lines_;
};

}  // namespace scintray::cli
