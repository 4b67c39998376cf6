#include "scintray/cli/scene_text.hpp"

#include <algorithm>
#include <set>

namespace scintray::cli {

namespace {

void collect_lines(const config::TomlNode& node, std::set<long>& lines) {
  lines.insert(node.key_where.line);
  lines.insert(node.where.line);
  for (const config::TomlNode& item : node.items) collect_lines(item, lines);
}

}  // namespace

SceneText::SceneText(const std::string& text) {
  std::size_t begin = 0;
  for (std::size_t end = 0; end < text.size(); begin = end) {
    end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    lines_.push_back(text.substr(begin, end - begin));
  }
}

std::string& SceneText::line_of(const config::TomlNode& node) {
  return lines_.at(static_cast<std::size_t>(node.where.line - 1));
}

void SceneText::replace(const config::TomlNode& string, const std::string& content) {
  std::string& line = line_of(string);
  for (const char quote : {'"', '\''}) {
    const std::string old = quote + string.text + quote;
    // Columns count characters, and an earlier edit may have moved this one.
    const std::size_t at = line.find(old);
    if (at == std::string::npos) continue;
    line.replace(at, old.size(), "\"" + content + "\"");
    return;
  }
  throw core::InputError({string.where, "the string \"" + string.text + "\" has escapes in it",
                          "write the path plainly, with / between folders"});
}

bool SceneText::on_lines_of_its_own(const config::TomlNode& member) const {
  std::set<long> lines;
  collect_lines(member, lines);
  return std::all_of(lines.begin(), lines.end(), [&](long number) {
    if (number < 1 || static_cast<std::size_t>(number) > lines_.size()) return false;
    const std::string& line = lines_[static_cast<std::size_t>(number - 1)];
    const std::size_t start = line.find_first_not_of(" \t");
    const auto starts_with = [&](const std::string& word) {
      return line.compare(start, word.size(), word) == 0;
    };
    return start != std::string::npos &&
           (starts_with("[") || starts_with(member.key) ||
            std::any_of(member.items.begin(), member.items.end(),
                        [&](const config::TomlNode& item) { return starts_with(item.key); }));
  });
}

void SceneText::comment_out(const config::TomlNode& member) {
  std::set<long> lines;
  collect_lines(member, lines);
  for (const long number : lines) lines_.at(static_cast<std::size_t>(number - 1)).insert(0, "# ");
}

std::string SceneText::whole() const {
  std::string text;
  for (const std::string& line : lines_) text += line;
  return text;
}

}  // namespace scintray::cli
