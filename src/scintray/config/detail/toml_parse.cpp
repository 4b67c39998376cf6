#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "scintray/config/detail/toml11.hpp"
#include "scintray/config/detail/toml_mistakes.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/input_file.hpp"

namespace scintray::config {

namespace {

/// toml11 recurses once per level; far beyond any real file, far below the stack.
constexpr int kDeepestNesting = 100;

/// Byte offsets of a text as lines and columns; columns count characters, not bytes.
class TextPlaces {
 public:
  TextPlaces(const std::string& text, std::string file) : text_(text), file_(std::move(file)) {
    starts_.push_back(0);
    long characters = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (i % kBlock == 0) before_block_.push_back(characters);
      characters += begins_character(text[i]) ? 1 : 0;
      if (text[i] == '\n') starts_.push_back(i + 1);
    }
    before_block_.push_back(characters);
  }

  std::size_t offset(std::size_t line, std::size_t byte_column) const {
    if (line < 1 || line > starts_.size()) return text_.size();
    return std::min(text_.size(), starts_[line - 1] + byte_column - 1);
  }

  core::FileLocation at(std::size_t offset) const {
    const auto next = std::upper_bound(starts_.begin(), starts_.end(), offset);
    const auto line = static_cast<std::size_t>(next - starts_.begin());
    const std::size_t end = std::max(starts_[line - 1], std::min(offset, text_.size()));
    return {file_, static_cast<long>(line),
            1 + characters_before(end) - characters_before(starts_[line - 1])};
  }

  const std::string& text() const { return text_; }
  const std::string& file() const { return file_; }

 private:
  /// Bytes between two counts of characters: a line may hold a whole file, in which every value has a place.
  static constexpr std::size_t kBlock = 256;

  static bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

  long characters_before(std::size_t offset) const {
    if (text_.empty()) return 0;
    const std::size_t block = std::min(offset, text_.size() - 1) / kBlock;
    long characters = before_block_[block];
    for (std::size_t i = block * kBlock; i < offset; ++i) characters += begins_character(text_[i]) ? 1 : 0;
    return characters;
  }

  const std::string& text_;
  std::string file_;
  std::vector<std::size_t> starts_;
  std::vector<long> before_block_;  ///< characters before each block of bytes
};

/// Throws InputError for nesting that would exhaust the stack of a recursive parser.
void refuse_deep_nesting(const TextPlaces& places) {
  const std::string& text = places.text();
  int depth = 0;
  int dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = skip_string(text, i) - 1;
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') depth = std::max(0, depth - 1);
    if (c == '.') ++dots;
    if (c == '\n' || c == ',' || c == '=' || c == '[' || c == '{') dots = 0;
    if (depth > kDeepestNesting || dots > kDeepestNesting)
      throw core::InputError(
          {places.at(i),
           "arrays, tables or dotted keys nested more than " + std::to_string(kDeepestNesting) + " deep",
           "close the brackets that are left open before here"});
  }
}

/// Throws InputError for lines in which the parser would take minutes: for each value it copies the line.
void refuse_long_lines(const TextPlaces& places) {
  constexpr double kMostBytesCopied = 4e9;
  const std::string& text = places.text();
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const auto values = std::count(text.begin() + static_cast<std::ptrdiff_t>(start),
                                   text.begin() + static_cast<std::ptrdiff_t>(end), ',');
    if (static_cast<double>(values) * static_cast<double>(end - start) > kMostBytesCopied)
      throw core::InputError({places.at(start),
                              "a line of " + std::to_string(end - start) + " characters with " +
                                  std::to_string(values) + " commas, which would take minutes to read",
                              "write the list over several lines, an element on each"});
    start = end + 1;
  }
}

bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// Start of the key of the value at `offset`, or `offset` for a value in a header or array.
std::size_t key_offset(const std::string& text, std::size_t offset) {
  std::size_t i = offset;
  const auto skip_blanks = [&] {
    while (i > 0 && (text[i - 1] == ' ' || text[i - 1] == '\t')) --i;
  };
  skip_blanks();
  if (i == 0 || text[i - 1] != '=') return offset;
  --i;
  skip_blanks();
  if (i == 0) return offset;
  const char last = text[i - 1];
  if (last == '"' || last == '\'') {
    const auto open = i >= 2 ? text.rfind(last, i - 2) : std::string::npos;
    return open == std::string::npos ? offset : open;
  }
  while (i > 0 && is_bare(text[i - 1])) --i;
  return i;
}

class Converter {
 public:
  explicit Converter(const TextPlaces& places) : places_(places) {}

  TomlNode convert(const toml::value& value, const std::string& key) {
    TomlNode node;
    node.key = key;
    const auto [offset, size] = toml11::span_of(value);
    node.where = places_.at(offset);
    const std::size_t key_at = key_offset(places_.text(), offset);
    node.key_where = key.empty() || key_at == offset ? node.where : places_.at(key_at);
    node.header = value.is_table() && size > 0 && places_.text()[offset] == '[';
    const bool has_members = value.is_table() || value.is_array();
    const std::string written = has_members ? std::string() : places_.text().substr(offset, size);
    switch (value.type()) {
      case toml::value_t::table:
        convert_members(value, node);
        break;
      case toml::value_t::array:
        node.kind = TomlNode::Kind::array;
        for (const toml::value& item : value.as_array()) node.items.push_back(convert(item, ""));
        break;
      case toml::value_t::string:
        node.kind = TomlNode::Kind::string;
        node.text = value.as_string().str;
        break;
      case toml::value_t::boolean:
        node.kind = TomlNode::Kind::boolean;
        node.boolean = value.as_boolean();
        node.text = written;
        break;
      case toml::value_t::integer:
        convert_integer(value, written, node);
        break;
      case toml::value_t::floating:
        node.kind = TomlNode::Kind::number;
        node.number = value.as_floating();
        node.text = written;
        break;
      default:
        node.kind = TomlNode::Kind::date;
        node.text = written;
    }
    return node;
  }

  core::Problems& problems() { return problems_; }

 private:
  void convert_members(const toml::value& value, TomlNode& node) {
    node.kind = TomlNode::Kind::table;
    for (const auto& [name, member] : value.as_table()) node.items.push_back(convert(member, name));
    const auto order = [](const TomlNode& n) {
      return std::tie(n.key_where.line, n.key_where.column, n.key);
    };
    std::sort(node.items.begin(), node.items.end(),
              [&](const TomlNode& a, const TomlNode& b) { return order(a) < order(b); });
  }

  void convert_integer(const toml::value& value, const std::string& written, TomlNode& node) {
    node.kind = TomlNode::Kind::integer;
    node.integer = value.as_integer();
    node.number = static_cast<double>(node.integer);
    node.text = written;
    std::string digits;
    std::copy_if(written.begin(), written.end(), std::back_inserter(digits),
                 [](char c) { return c != '_' && c != '+'; });
    const bool decimal = digits.find_first_of("xob") == std::string::npos;
    const int base = decimal                                 ? 10
                     : digits.find('x') != std::string::npos ? 16
                     : digits.find('o') != std::string::npos ? 8
                                                             : 2;
    std::int64_t checked = 0;
    const char* first = digits.data() + (decimal ? 0 : 2);
    if (std::from_chars(first, digits.data() + digits.size(), checked, base).ec != std::errc{})
      problems_.add(node.where, "the integer " + written + " does not fit in 64 bits",
                    "give an integer below 9.2e18");
  }

  const TextPlaces& places_;
  core::Problems problems_;
};

}  // namespace

const TomlNode* TomlNode::find(const std::string& member) const {
  if (kind != Kind::table) return nullptr;
  for (const TomlNode& item : items)
    if (item.key == member) return &item;
  return nullptr;
}

TomlNode* TomlNode::find(const std::string& member) {
  return const_cast<TomlNode*>(std::as_const(*this).find(member));
}

std::string TomlNode::as_written() const {
  if (kind != Kind::array && kind != Kind::table) return text;
  std::string list;
  for (const TomlNode& item : items) {
    list += list.empty() ? "" : ", ";
    if (kind == Kind::table) list += item.key + " = ";
    list += item.kind == Kind::string ? "\"" + item.text + "\"" : item.as_written();
  }
  return kind == Kind::array ? "[" + list + "]" : "{" + list + "}";
}

TomlNodePtr parse_toml(const std::string& text, const std::string& file) {
  const std::string body = text.rfind("\xEF\xBB\xBF", 0) == 0 ? text.substr(3) : text;
  const TextPlaces places(body, file);
  const auto zero = body.find('\0');
  if (zero != std::string::npos)
    throw core::InputError(
        {places.at(zero), "a zero byte: this is not a text file", "give a TOML file (UTF-8 text)"});
  refuse_deep_nesting(places);
  refuse_long_lines(places);
  toml::value document;
  try {
    std::istringstream stream(body);
    document = toml::parse(stream, file);
  } catch (const toml::exception& error) {
    const toml11::SyntaxError found = toml11::syntax_error(error);
    const ExplainedMistake mistake =
        explain_mistake(body, places.offset(found.line, found.byte_column), found);
    throw core::InputError({places.at(mistake.offset), mistake.what, mistake.hint});
  } catch (const std::exception& error) {
    throw core::InputError({{file, 1, 1},
                            std::string("the file cannot be read as TOML: ") + error.what(),
                            "see https://toml.io for how it is written"});
  }
  Converter converter(places);
  TomlNode root = converter.convert(document, "");
  root.where = root.key_where = {file, 1, 1};
  converter.problems().throw_if_any();
  return std::make_shared<const TomlNode>(std::move(root));
}

std::string read_text_file(const std::filesystem::path& path, const core::FileLocation& where) {
  const core::FileLocation place = where.file.empty() ? core::FileLocation{path.string(), 0, 0} : where;
  std::error_code status;
  if (!std::filesystem::exists(path, status))
    throw core::InputError(
        {place, "the file \"" + path.string() + "\" does not exist",
         "check the name; relative paths count from the folder of the file that names them"});
  if (std::filesystem::is_directory(path, status))
    throw core::InputError({place, "\"" + path.string() + "\" is a folder, not a file", "name a file in it"});
  std::optional<std::string> content = core::read_whole_file(path);
  if (!content)
    throw core::InputError(
        {place, "the file \"" + path.string() + "\" cannot be read", "check its permissions"});
  return *std::move(content);
}

TomlNodePtr parse_toml_file(const std::filesystem::path& path) {
  return parse_toml(read_text_file(path), path.string());
}

}  // namespace scintray::config
