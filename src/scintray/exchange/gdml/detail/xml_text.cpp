#include "scintray/exchange/gdml/detail/xml_text.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "scintray/exchange/gdml/detail/xml_entities.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::exchange::gdml {

namespace {

/// Text for an attribute's value, in either kind of quotes.
std::string within_quotes(std::string text) {
  for (const auto& [quote, word] : {std::pair{'"', "&quot;"}, std::pair{'\'', "&apos;"}})
    for (std::size_t at = text.find(quote); at != std::string::npos; at = text.find(quote, at + 1))
      text.replace(at, 1, word);
  return text;
}

}  // namespace

/// Replaces references, text after text.
class XmlText::Expansion {
 public:
  Expansion(XmlText& result, XmlEntities entities, std::filesystem::path root)
      : result_(result), entities_(std::move(entities)), root_(std::move(root)) {}

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
    return place_in(source.file, source.line_starts, origin.one_place.value_or(at));
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

  void append_in_attribute(const XmlEntity& entity, Origin origin, const core::FileLocation& where) {
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

  void append_file(const XmlEntity& entity) {
    const std::filesystem::path folder = std::filesystem::path(entity.declared.file).parent_path();
    const auto path = included_file(entity.text, folder, root_, entity.declared);
    auto known = files_.find(path.string());
    if (known == files_.end()) {
      std::string content = mesh::read_mesh_file(path);
      count_read(content.size());
      result_.sources_.push_back({path.string(), starts_of_lines(content)});
      known = files_.emplace(path.string(), File{std::move(content), result_.sources_.size() - 1}).first;
    }
    const File& file = known->second;
    append(file.content, {file.source, std::nullopt}, start_of_text(file.content));
  }

  static constexpr std::size_t kDeepest = 50;
  static constexpr std::size_t kLongestAttribute = 100'000'000;
  struct File {
    std::string content;
    std::size_t source;
  };

  XmlText& result_;
  XmlEntities entities_;
  std::filesystem::path root_;
  std::map<std::string, File> files_;  ///< by path
  std::vector<std::string> open_;      ///< entities that are being replaced
  std::size_t read_ = 0;
};

XmlText::XmlText(std::string content, const std::string& file, const std::filesystem::path& root) {
  sources_.push_back({file, starts_of_lines(content)});
  XmlDeclarations declarations(content, file, root);
  if (declarations.entities.empty()) {
    pieces_.push_back({0, 0, 0, false});
    text_ = std::move(content);
    return;
  }
  const std::size_t end = after(content, ">", declarations.end);
  pieces_.push_back({0, 0, 0, false});
  text_ = content.substr(0, end);
  Expansion expansion(*this, std::move(declarations.entities), root);
  expansion.count_read(content.size() + declarations.read);
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
  return place_in(source.file, source.line_starts,
                  piece.offset + (piece.at_one_place ? 0 : at - piece.begin));
}

}  // namespace scintray::exchange::gdml
