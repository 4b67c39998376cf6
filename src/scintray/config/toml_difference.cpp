#include "scintray/config/toml_reader.hpp"

#include <algorithm>
#include <optional>

namespace scintray::config {

namespace {

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// How sweeps name an element of an array, too: by its name, else by its number from 1.
std::string name_of(const TomlNode& element, std::size_t index) {
  const TomlNode* name = element.kind == TomlNode::Kind::table ? element.find("name") : nullptr;
  return name && name->kind == TomlNode::Kind::string ? name->text : std::to_string(index + 1);
}

std::optional<std::string> difference(const TomlNode& a, const TomlNode& b, const std::string& path,
                                      const std::vector<std::string>& besides = {});

/// A member of `a` that `b` has not, or, when `both`, of which it has another.
std::optional<std::string> member_difference(const TomlNode& a, const TomlNode& b, bool both,
                                             const std::string& path,
                                             const std::vector<std::string>& besides) {
  for (const TomlNode& member : a.items) {
    if (std::find(besides.begin(), besides.end(), member.key) != besides.end()) continue;
    const TomlNode* other = b.find(member.key);
    if (!other) return joined(path, member.key);
    if (!both) continue;
    if (auto found = difference(member, *other, joined(path, member.key))) return found;
  }
  return std::nullopt;
}

std::optional<std::string> difference(const TomlNode& a, const TomlNode& b, const std::string& path,
                                      const std::vector<std::string>& besides) {
  if (a.kind != b.kind) return path;
  if (a.kind == TomlNode::Kind::table) {
    if (auto found = member_difference(a, b, true, path, besides)) return found;
    return member_difference(b, a, false, path, besides);
  }
  if (a.kind != TomlNode::Kind::array) return a.text == b.text ? std::nullopt : std::optional(path);
  for (std::size_t i = 0; i < std::min(a.items.size(), b.items.size()); ++i)
    if (auto found = difference(a.items[i], b.items[i], joined(path, name_of(a.items[i], i)))) return found;
  return a.items.size() == b.items.size() ? std::nullopt : std::optional(path);
}

}  // namespace

std::string first_difference(const TomlNode& a, const TomlNode& b, const std::vector<std::string>& besides) {
  return difference(a, b, "", besides).value_or("");
}

}  // namespace scintray::config
