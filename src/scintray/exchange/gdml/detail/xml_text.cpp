#include "scintray/exchange/gdml/detail/xml_text.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gdml {

namespace {

constexpr std::string_view kBlank = " \t\r\n";

std::vector<std::size_t> starts_of_lines(std::string_view text) {
  std::vector<std::size_t> starts{0};
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') starts.push_back(i + 1);
  return starts;
}

core::FileLocation location(const std::string& file, const std::vector<std::size_t>& starts,
                            std::size_t offset) {
  const auto next = std::upper_bound(starts.begin(), starts.end(), offset);
  return {file, static_cast<long>(next - starts.begin()), static_cast<long>(offset - *(next - 1)) + 1};
}

/// Position after the next `end`, or that of the text's end.
std::size_t after(std::string_view text, std::string_view end, std::size_t from) {
  const std::size_t found = text.find(end, from);
  return found == std::string_view::npos ? text.size() : found + end.size();
}

/// Position after the comment, processing instruction or character data that starts at `at`; `at` when none
/// does.
std::size_t after_passive(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("<!--")) return after(text, "-->", at + 4);
  if (rest.starts_with("<?")) return after(text, "?>", at + 2);
  if (rest.starts_with("<![CDATA[")) return after(text, "]]>", at + 9);
  return at;
}

/// Range [begin, end) of the internal subset of the DOCTYPE, between its brackets; empty without one.
std::pair<std::size_t, std::size_t> internal_subset(std::string_view text) {
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  while (at < text.size() && !text.substr(at).starts_with("<!DOCTYPE")) {
    const std::size_t passed =
        kBlank.find(text[at]) != std::string_view::npos ? at + 1 : after_passive(text, at);
    if (passed == at) return {0, 0};
    at = passed;
  }
  char quote = '\0';
  std::size_t begin = 0;
  while (at < text.size()) {
    const std::size_t passed = quote == '\0' ? after_passive(text, at) : at;
    if (passed != at) {
      at = passed;
      continue;
    }
    const char c = text[at++];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' && begin == 0) {
      begin = at;
    } else if (c == ']' && begin > 0) {
      return {begin, at - 1};
    } else if (c == '>' && begin == 0) {
      return {0, 0};
    }
  }
  return {0, 0};
}

}  // namespace

struct XmlText::Entity {
  bool external = false;
  std::string text;  ///< its text, or the name of its file
  core::FileLocation declared;
};

namespace {

/// Words of a declaration from `at` up to its ">", those in quotes as one, each with the quote before it;
/// `at` is moved behind the ">".
std::vector<std::string> words_of_declaration(std::string_view text, std::size_t& at) {
  std::vector<std::string> words;
  while (at < text.size() && text[at] != '>') {
    if (kBlank.find(text[at]) != std::string_view::npos) {
      ++at;
    } else if (text[at] == '"' || text[at] == '\'') {
      const std::size_t end = std::min(text.find(text[at], at + 1), text.size());
      words.push_back("\"" + std::string(text.substr(at + 1, end - at - 1)));
      at = std::min(end + 1, text.size());
    } else {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n>\"'", at), text.size());
      words.emplace_back(text.substr(at, end - at));
      at = end;
    }
  }
  at = std::min(at + 1, text.size());
  return words;
}

/// Text for an attribute's value, in either kind of quotes.
std::string within_quotes(std::string text) {
  for (const auto& [quote, word] : {std::pair{'"', "&quot;"}, std::pair{'\'', "&apos;"}})
    for (std::size_t at = text.find(quote); at != std::string::npos; at = text.find(quote, at + 1))
      text.replace(at, 1, word);
  return text;
}

}  // namespace

std::filesystem::path included_file(const std::string& name, const std::filesystem::path& folder,
                                    const std::filesystem::path& root, const core::FileLocation& where) {
  const auto reject = [&](const std::string& what, const std::string& hint) {
    throw core::InputError(
        core::Problem{where, "the file names " + core::in_quotes(name) + ", " + what, hint});
  };
  const std::string below = "name a file of this folder, or of one below it, by its path from here";
  if (name.empty()) reject("which is no name of a file", below);
  if (name.find("://") != std::string::npos)
    reject("an address, and nothing is fetched",
           "save the file beside the GDML file, and name it by its path");
  std::error_code error;
  const auto top = std::filesystem::weakly_canonical(root.empty() ? "." : root, error);
  bool outside = false, other_kind = false;
  for (const std::filesystem::path& from : {folder, root}) {
    const auto there = std::filesystem::weakly_canonical((from.empty() ? "." : from) / name, error);
    if (error) continue;
    const bool inside =
        std::mismatch(top.begin(), top.end(), there.begin(), there.end()).first == top.end() && there != top;
    outside = outside || !inside;
    if (!inside || !std::filesystem::exists(there, error)) continue;
    if (std::filesystem::is_regular_file(there, error)) return (from / name).lexically_normal();
    other_kind = true;
  }
  if (other_kind) reject("which is not a file", below);
  if (outside)
    reject("which is not in the folder of the first GDML file or below, and is not opened",
           "copy the file there, or import from a folder that contains all files");
  reject("which does not exist", below + "; Geant4 counts from the folder that it is started in");
  return {};
}

/// The entity of the words after its name; empty when they do not declare one.
std::optional<XmlText::Entity> XmlText::entity_of(const std::vector<std::string>& words) {
  const auto quoted = [&](std::size_t i) { return words.size() > i && words[i].starts_with('"'); };
  if (quoted(1)) return Entity{false, words[1].substr(1), {}};
  if (words.size() > 2 && words[1] == "SYSTEM" && quoted(2)) return Entity{true, words[2].substr(1), {}};
  if (words.size() > 3 && words[1] == "PUBLIC" && quoted(3)) return Entity{true, words[3].substr(1), {}};
  return std::nullopt;
}

XmlText::Entities XmlText::declared_entities(std::string_view text, const std::string& file) {
  Entities entities;
  const auto [begin, end] = internal_subset(text);
  const std::vector<std::size_t> starts = begin < end ? starts_of_lines(text) : std::vector<std::size_t>{};
  const std::string_view subset = text.substr(0, end);
  constexpr std::string_view kDeclaration = "<!ENTITY";
  for (std::size_t at = begin; at < end;) {
    const core::FileLocation where = location(file, starts, at);
    if (const std::size_t passed = after_passive(subset, at); passed != at) {
      at = passed;
    } else if (subset[at] == '%') {
      throw core::InputError(
          core::Problem{where, "the DOCTYPE refers to a parameter entity, which is not read",
                        "declare the entities themselves: <!ENTITY name SYSTEM \"file.xml\">"});
    } else if (subset[at] == '<') {
      const bool of_entity = subset.substr(at).starts_with(kDeclaration);
      at = std::min(at + kDeclaration.size(), end);
      const std::vector<std::string> words = words_of_declaration(subset, at);
      if (!of_entity) continue;
      std::optional<Entity> entity = entity_of(words);
      if (!entity)
        throw core::InputError(
            core::Problem{where, "<!ENTITY> of a form that is not read",
                          "expected <!ENTITY name SYSTEM \"file.xml\"> or <!ENTITY name \"text\">"});
      entity->declared = where;
      entities.emplace(words[0], std::move(*entity));
    } else {
      ++at;
    }
  }
  return entities;
}

/// Replaces references, text after text.
class XmlText::Expansion {
 public:
  Expansion(XmlText& result, Entities entities, std::filesystem::path folder, std::filesystem::path root)
      : result_(result), entities_(std::move(entities)), folder_(std::move(folder)), root_(std::move(root)) {}

  /// Where a text comes from: offsets of its source, or one place of it.
  struct Origin {
    std::size_t source;
    std::optional<std::size_t> one_place;
  };

  void count_read(std::size_t bytes) { read_ += bytes; }

  /// Appends the text from `begin` on with its references replaced.
  void append(std::string_view text, Origin origin, std::size_t begin = 0) {
    char quote = '\0';
    bool in_tag = false;
    std::size_t kept = begin;  // all before is in the result
    const auto keep = [&](std::size_t end) {
      put(text.substr(kept, end - kept), origin, kept);
      kept = end;
    };
    for (std::size_t at = begin; at < text.size();) {
      if (const std::size_t passed = in_tag ? at : after_passive(text, at); passed != at) {
        at = passed;
        continue;
      }
      const char c = text[at];
      if (c == '&') {
        keep(at);
        at = replace(text, at, origin, quote != '\0');
        kept == at ? ++at : kept = at;
        continue;
      }
      if (quote != '\0') {
        if (c == quote) quote = '\0';
      } else if (in_tag && (c == '"' || c == '\'')) {
        quote = c;
      } else if (c == '<') {
        in_tag = true;
      } else if (c == '>') {
        in_tag = false;
      }
      ++at;
    }
    keep(text.size());
  }

 private:
  void put(std::string_view text, Origin origin, std::size_t offset) {
    if (text.empty()) return;
    result_.pieces_.push_back({result_.text_.size(), origin.source, origin.one_place.value_or(offset),
                               origin.one_place.has_value()});
    result_.text_ += text;
  }

  core::FileLocation place(Origin origin, std::size_t at) const {
    const Source& source = result_.sources_[origin.source];
    return location(source.file, source.line_starts, origin.one_place.value_or(at));
  }

  /// Appends what the reference at `at` stands for; returns the position after it, `at` where the parser
  /// replaces it: characters by number, and the five names of XML itself.
  std::size_t replace(std::string_view text, std::size_t at, Origin origin, bool in_attribute) {
    const std::size_t end = std::min(text.find_first_of("; \t\r\n<>&\"'", at + 1), text.size());
    const std::string_view name = text.substr(at + 1, end - at - 1);
    if (name.starts_with('#')) return at;
    for (const std::string_view known : {"lt", "gt", "amp", "quot", "apos"})
      if (name == known) return at;
    const auto where = place(origin, at);
    const std::string shown = core::in_quotes("&" + std::string(name) + ";");
    const auto found = entities_.find(name);
    if (end >= text.size() || text[end] != ';' || found == entities_.end())
      throw core::InputError(core::Problem{
          where, "the entity " + shown + " is not declared",
          "declare it in the DOCTYPE, as <!ENTITY name SYSTEM \"file.xml\">; a plain & is &amp;"});
    if (std::find(open_.begin(), open_.end(), name) != open_.end())
      throw core::InputError(
          core::Problem{where, "the entity " + shown + " contains itself", "remove the reference"});
    if (open_.size() >= kDeepest)
      throw core::InputError(core::Problem{where, "entities are nested more than 50 deep",
                                           "refer to the innermost from the GDML file itself"});
    open_.emplace_back(name);
    if (in_attribute)
      append_in_attribute(found->second, {origin.source, origin.one_place.value_or(at)}, where);
    else if (found->second.external)
      append_file(found->second);
    else
      append(found->second.text, {origin.source, origin.one_place.value_or(at)});
    open_.pop_back();
    constexpr std::size_t kUnquestioned = std::size_t{8} << 20, kFactor = 100;
    if (result_.text_.size() > kUnquestioned + kFactor * read_)
      throw core::InputError(core::Problem{where, "its entities become a text of over 100 times what is read",
                                           "write loops with <loop>"});
    return end + 1;
  }

  void append_in_attribute(const Entity& entity, Origin origin, const core::FileLocation& where) {
    if (entity.external || entity.text.find('<') != std::string::npos)
      throw core::InputError(core::Problem{where, "an entity with elements, or a file, in an attribute",
                                           "refer to it between elements"});
    const std::string text = within_quotes(entity.text);
    const std::size_t begin = result_.text_.size();
    std::size_t kept = 0;
    for (std::size_t at = text.find('&'); at != std::string::npos; at = text.find('&', at)) {
      put(std::string_view(text).substr(kept, at - kept), origin, 0);
      kept = at;
      at = replace(text, at, origin, true);
      kept == at ? ++at : kept = at;
    }
    put(std::string_view(text).substr(kept), origin, 0);
    if (result_.text_.size() - begin > kLongestAttribute)
      throw core::InputError(core::Problem{where,
                                           "an attribute of over 100 million characters by its entities",
                                           "write the values in the file"});
  }

  void append_file(const Entity& entity) {
    auto known = files_.find(entity.text);
    if (known == files_.end()) {
      const auto path = included_file(entity.text, folder_, root_, entity.declared);
      std::string content = mesh::read_mesh_file(path);
      count_read(content.size());
      result_.sources_.push_back({path.string(), starts_of_lines(content)});
      known = files_.emplace(entity.text, File{std::move(content), result_.sources_.size() - 1}).first;
    }
    const File& file = known->second;
    // A mark of its encoding, and a declaration of it, are not part of the text of a file.
    const std::size_t begin = file.content.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    const bool declared = std::string_view(file.content).substr(begin).starts_with("<?xml ");
    append(file.content, {file.source, std::nullopt}, declared ? after(file.content, "?>", begin) : begin);
  }

  static constexpr std::size_t kDeepest = 50;
  static constexpr std::size_t kLongestAttribute = 100'000'000;
  struct File {
    std::string content;
    std::size_t source;
  };

  XmlText& result_;
  Entities entities_;
  std::filesystem::path folder_, root_;
  std::map<std::string, File> files_;
  std::vector<std::string> open_;  ///< entities that are being replaced
  std::size_t read_ = 0;
};

XmlText::XmlText(std::string content, const std::string& file, const std::filesystem::path& root) {
  sources_.push_back({file, starts_of_lines(content)});
  Entities entities = declared_entities(content, file);
  if (entities.empty()) {
    pieces_.push_back({0, 0, 0, false});
    text_ = std::move(content);
    return;
  }
  const std::size_t end = after(content, ">", internal_subset(content).second);
  pieces_.push_back({0, 0, 0, false});
  text_ = content.substr(0, end);
  Expansion expansion(*this, std::move(entities), std::filesystem::path(file).parent_path(), root);
  expansion.count_read(content.size());
  expansion.append(content, {0, std::nullopt}, end);
}

core::FileLocation XmlText::where(std::ptrdiff_t offset) const {
  if (offset < 0) return {sources_.front().file, 0, 0};
  const auto at = static_cast<std::size_t>(offset);
  const auto next =
      std::upper_bound(pieces_.begin(), pieces_.end(), at,
                       [](std::size_t wanted, const Piece& piece) { return wanted < piece.begin; });
  const Piece& piece = *(next - 1);
  const Source& source = sources_[piece.source];
  return location(source.file, source.line_starts,
                  piece.offset + (piece.at_one_place ? 0 : at - piece.begin));
}

}  // namespace scintray::exchange::gdml
