#include "scintray/exchange/gdml/detail/xml_entities.hpp"

#include <algorithm>
#include <optional>

#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gdml {

namespace {

constexpr std::string_view kBlank = " \t\r\n";

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

/// The entity of the words after its name; empty when they do not declare one.
std::optional<XmlEntity> entity_of(const std::vector<std::string>& words) {
  const auto quoted = [&](std::size_t i) { return words.size() > i && words[i].starts_with('"'); };
  if (quoted(1)) return XmlEntity{false, words[1].substr(1), {}};
  if (words.size() > 2 && words[1] == "SYSTEM" && quoted(2)) return XmlEntity{true, words[2].substr(1), {}};
  if (words.size() > 3 && words[1] == "PUBLIC" && quoted(3)) return XmlEntity{true, words[3].substr(1), {}};
  return std::nullopt;
}

/// Reads declarations, those of parameter entities where they are referred to.
class DeclarationReader {
 public:
  DeclarationReader(XmlDeclarations& result, std::filesystem::path root)
      : result_(result), root_(std::move(root)) {}

  /// A text that may refer to parameter entities.
  struct Text {
    std::string_view content;
    std::string file;
    std::vector<std::size_t> starts;
    bool internal;                                   ///< of the document itself
    std::optional<core::FileLocation> at_one_place;  ///< of the text of an entity: that of its declaration

    core::FileLocation place(std::size_t at) const {
      return at_one_place ? *at_one_place : place_in(file, starts, at);
    }
  };

  void read(const Text& text, std::size_t begin) {
    constexpr std::string_view kDeclaration = "<!ENTITY";
    const std::string_view subset = text.content;
    for (std::size_t at = begin; at < subset.size();) {
      const std::size_t start = at;
      if (const std::size_t passed = after_passive(subset, at); passed != at) {
        at = passed;
      } else if (subset[at] == '%') {
        at = include(text, at);
      } else if (subset.substr(at).starts_with("<![")) {
        refuse(text, at, "a conditional section of a DTD, which is not read", "write its declarations alone");
      } else if (subset[at] == '<') {
        const bool of_entity = subset.substr(at).starts_with(kDeclaration);
        at = std::min(at + kDeclaration.size(), subset.size());
        const std::vector<std::string> words = words_of_declaration(subset, at);
        if (of_entity) declare(text, start, words);
      } else {
        ++at;
      }
    }
  }

 private:
  [[noreturn]] static void refuse(const Text& text, std::size_t at, const std::string& what,
                                  const std::string& hint) {
    throw core::InputError(core::Problem{text.place(at), what, hint});
  }

  void declare(const Text& text, std::size_t at, std::vector<std::string> words) {
    const bool parameter = !words.empty() && words.front() == "%";
    if (parameter) words.erase(words.begin());
    std::optional<XmlEntity> entity = entity_of(words);
    if (!entity)
      refuse(text, at, "<!ENTITY> of a form that is not read",
             "expected <!ENTITY name SYSTEM \"file.xml\"> or <!ENTITY name \"text\">, of a parameter entity "
             "<!ENTITY % name ...>");
    entity->declared = text.place(at);
    if (!entity->external && !text.internal) entity->text = replaced(text, at, entity->text);
    (parameter ? parameters_ : result_.entities).emplace(words.front(), std::move(*entity));
  }

  /// A parameter entity that is referred to, and the position after the reference.
  struct Reference {
    std::string name;
    const XmlEntity& entity;
    std::size_t end;
  };
  Reference reference(const Text& text, std::string_view of, std::size_t at, std::size_t place) const {
    const std::size_t end = std::min(of.find_first_of("; \t\r\n<>%\"'", at + 1), of.size());
    const std::string name(of.substr(at + 1, end - at - 1));
    const auto found = parameters_.find(name);
    if (end >= of.size() || of[end] != ';' || found == parameters_.end())
      refuse(text, place, "the parameter entity " + core::in_quotes("%" + name + ";") + " is not declared",
             "declare it before, as <!ENTITY % name SYSTEM \"file.ent\">");
    if (std::find(open_.begin(), open_.end(), name) != open_.end())
      refuse(text, place, "the parameter entity " + core::in_quotes("%" + name + ";") + " contains itself",
             "remove the reference");
    if (open_.size() >= kDeepest)
      refuse(text, place, "parameter entities are nested more than 50 deep",
             "refer to the innermost from the DOCTYPE itself");
    return {name, found->second, end + 1};
  }

  void count(const Text& text, std::size_t at, std::size_t bytes) {
    constexpr std::size_t kMost = std::size_t{8} << 20;
    read_ += bytes;
    if (read_ > kMost)
      refuse(text, at, "its parameter entities become declarations of over 8 MiB", "declare what is used");
  }

  /// Reads the declarations of the parameter entity that is referred to at `at`; the position after it.
  std::size_t include(const Text& text, std::size_t at) {
    const Reference to = reference(text, text.content, at, at);
    open_.push_back(to.name);
    if (to.entity.external) {
      const auto path = included_file(to.entity.text, std::filesystem::path(text.file).parent_path(), root_,
                                      to.entity.declared);
      const std::string content = mesh::read_mesh_file(path);
      count(text, at, content.size());
      result_.read += content.size();
      read({content, path.string(), starts_of_lines(content), false, std::nullopt}, start_of_text(content));
    } else {
      count(text, at, to.entity.text.size());
      const std::string content = to.entity.text;
      read({content, text.file, {}, false, to.entity.declared}, 0);
    }
    open_.pop_back();
    return to.end;
  }

  /// The text of an entity with the parameter entities in it replaced.
  std::string replaced(const Text& text, std::size_t place, const std::string& of) {
    std::string result;
    for (std::size_t at = 0; at < of.size();) {
      const std::size_t next = std::min(of.find('%', at), of.size());
      result += of.substr(at, next - at);
      if (next == of.size()) break;
      const Reference to = reference(text, of, next, place);
      if (to.entity.external)
        refuse(text, place, "a parameter entity of a file within the text of an entity",
               "refer to it between declarations");
      count(text, place, to.entity.text.size());
      result += to.entity.text;
      at = to.end;
    }
    return result;
  }

  static constexpr std::size_t kDeepest = 50;

  XmlDeclarations& result_;
  std::filesystem::path root_;
  XmlEntities parameters_;
  std::vector<std::string> open_;  ///< parameter entities that are being read
  std::size_t read_ = 0;
};

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

std::vector<std::size_t> starts_of_lines(std::string_view text) {
  std::vector<std::size_t> starts{0};
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') starts.push_back(i + 1);
  return starts;
}

core::FileLocation place_in(const std::string& file, const std::vector<std::size_t>& starts,
                            std::size_t offset) {
  const auto next = std::upper_bound(starts.begin(), starts.end(), offset);
  return {file, static_cast<long>(next - starts.begin()), static_cast<long>(offset - *(next - 1)) + 1};
}

std::size_t after(std::string_view text, std::string_view end, std::size_t from) {
  const std::size_t found = text.find(end, from);
  return found == std::string_view::npos ? text.size() : found + end.size();
}

std::size_t after_passive(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("<!--")) return after(text, "-->", at + 4);
  if (rest.starts_with("<?")) return after(text, "?>", at + 2);
  if (rest.starts_with("<![CDATA[")) return after(text, "]]>", at + 9);
  return at;
}

std::size_t start_of_text(std::string_view content) {
  const std::size_t begin = content.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  return content.substr(begin).starts_with("<?xml ") ? after(content, "?>", begin) : begin;
}

XmlDeclarations::XmlDeclarations(std::string_view content, const std::string& file,
                                 const std::filesystem::path& root) {
  const auto [begin, subset_end] = internal_subset(content);
  end = subset_end;
  if (begin >= end) return;
  DeclarationReader(*this, root)
      .read({content.substr(0, end), file, starts_of_lines(content), true, std::nullopt}, begin);
}

}  // namespace scintray::exchange::gdml
