#include "scintray/scene_file/detail/names.hpp"

#include <algorithm>
#include <span>

#include "scintray/core/pattern.hpp"
#include "scintray/core/text.hpp"

namespace scintray::scene_file {

namespace {

/// List of all names, or of the first of many.
std::string name_list(std::span<const std::string> names) {
  constexpr std::size_t kMostListed = 12;
  std::string list = core::list_of(names.first(std::min(names.size(), kMostListed)));
  if (names.size() > kMostListed) list += ", ... (" + std::to_string(names.size()) + " in all)";
  return list;
}

}  // namespace

config::NameRef read_name(const config::TomlTable& table, const std::string& key, bool required) {
  config::NameRef name{required ? table.string(key) : table.string(key, ""), table.where(key)};
  return name;
}

std::vector<config::NameRef> read_names(const config::TomlTable& table, const std::string& key,
                                        bool required) {
  std::vector<config::NameRef> names;
  const config::TomlNode* node = table.node()->find(key);
  if (node && node->kind == config::TomlNode::Kind::array) {
    for (const std::string& name : table.strings(key, 0, required)) names.push_back({name, table.where(key)});
  } else if (const config::NameRef one = read_name(table, key, required); !one.empty()) {
    names.push_back(one);
  }
  return names;
}

void expect_part(const config::TomlTable& table, const std::string& key, const config::NameRef& name,
                 const std::vector<std::string>& parts) {
  if (parts.empty() || name.empty() || std::find(parts.begin(), parts.end(), name.name) != parts.end())
    return;
  const std::string near = core::nearest_word(name.name, parts);
  table.report(key, "there is no part \"" + name.name + "\"",
               (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "the parts are " + name_list(parts));
}

void expect_parts(const config::TomlTable& table, const std::string& key, const config::NameRef& pattern,
                  const std::vector<std::string>& parts) {
  if (!core::is_pattern(pattern.name) || parts.empty()) return expect_part(table, key, pattern, parts);
  table.expect(key, !core::matching(pattern.name, parts).empty(), "no part matches \"" + pattern.name + "\"",
               "\"*\" stands for any characters; the parts are " + name_list(parts));
}

void expect_plain_name(const config::TomlTable& table, const std::string& key, const std::string& name) {
  table.expect(key, name.find_first_of(".:*\"\n") == std::string::npos,
               "the name \"" + name + "\" contains a dot, a colon, a star, a quote or a line break",
               "these characters have a meaning in \"part:face\", in patterns and in swept keys: use "
               "letters, digits, _ and -");
}

std::uint64_t positive_count(const config::TomlTable& table, const std::string& key, std::int64_t value) {
  table.expect(key, value > 0, "\"" + key + "\" is " + std::to_string(value) + ", but at least 1 is expected",
               "give a positive integer");
  constexpr std::int64_t kMost = 1'000'000'000'000'000;
  table.expect(key, value <= kMost,
               "\"" + key + "\" is " + std::to_string(value) + ", but at most 1e15 is expected",
               "no run of more would end");
  return value > 0 ? static_cast<std::uint64_t>(value) : 1;
}

}  // namespace scintray::scene_file
