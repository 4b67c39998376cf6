#pragma once
/// Reading TOML: every mistake of a document is reported, with its place, at once.
///
///     Problems problems;
///     TomlTable table(parse_toml_file("materials/media/LSO.toml"), problems);
///     const double density = table.quantity("density", Dimension::density);
///     table.expect("density", density > 0.0, "a density must be positive");
///     const Curve index = table.curve("index", Dimension::dimensionless);
///     table.finish();           // keys that were not read are problems
///     problems.throw_if_any();

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/core/words.hpp"

namespace scintray::config {

/// A value of a TOML document with its place. A plain tree, so that a sweep can edit it.
struct TomlNode {
  enum class Kind { string, integer, number, boolean, date, array, table };

  Kind kind = Kind::table;
  std::string key;               ///< name within its table; empty in an array and at the root
  core::FileLocation where;      ///< of the value; of its header for a [table]
  core::FileLocation key_where;  ///< of the key; that of the value where there is none
  bool header = false;           ///< a table that is written as [key] or [[key]], not as { ... }
  std::string text;              ///< a string's content; any other scalar as written
  double number = 0.0;           ///< of an integer or number
  std::int64_t integer = 0;
  bool boolean = false;
  std::vector<TomlNode> items;  ///< elements of an array, or members of a table in file order

  /// Member of a table; nullptr when there is none.
  const TomlNode* find(const std::string& member) const;
  TomlNode* find(const std::string& member);
  /// The value as TOML text, for headings and messages: 2 mm, ["1 mm", "2 mm"].
  std::string as_written() const;
  bool operator==(const TomlNode&) const = default;
};

using TomlNodePtr = std::shared_ptr<const TomlNode>;

/// Root of a parsed document. `file` appears in messages, and relative paths in the document are relative to
/// its folder. Throws InputError with the place and nature of a syntax error.
TomlNodePtr parse_toml(const std::string& text, const std::string& file);

/// Root of a parsed file. Throws InputError when it is missing, is not text, or is malformed.
TomlNodePtr parse_toml_file(const std::filesystem::path& path);

/// The content of a text file. Throws InputError, at `where` if that is given, when it cannot be read.
std::string read_text_file(const std::filesystem::path& path, const core::FileLocation& where = {});

/// One use of a key by a reader: the form that it accepts. A key may have several uses, of different forms.
struct KeyUse {
  enum class Form {
    present,  ///< only its presence
    raw,      ///< the value as written
    text,     ///< one of `words` where there are any
    file,     ///< the name of a file
    boolean,
    integer,
    number,
    quantity,  ///< of `dimension`
    curve,     ///< a quantity of `dimension`, or a table of them over `x`
    table,
    tables,  ///< a list of tables
    one_of,  ///< a group: exactly one of the keys in `words` may be present; `key` is empty
    rule,    ///< the error message `note` of a condition on the value
  };
  Form form = Form::present;
  std::string table = {}, key = {};  ///< "part.face", "name"; the path is empty for the outermost table
  core::Dimension dimension = core::Dimension::dimensionless, x = core::Dimension::wavelength;
  std::vector<std::string> words = {};
  bool list = false, required = false;
  std::size_t count = 0;  ///< elements of a list; 0: any number above 0
  std::string note = {};  ///< the value of an absent key, as text; of a rule its message
  bool operator==(const KeyUse&) const = default;
};

/// A table being read. Problems are added to a collector and a harmless default is returned, so that reading
/// continues and all problems are reported together.
///
/// Of each kind of getter there are three: `x(key)` requires the key, `x(key, fallback)` returns the
/// fallback when it is absent, `optional_x(key)` returns nothing when it is absent or wrong. Copies
/// share their state. The collector must outlive the table.
class TomlTable {
 public:
  /// The outermost table of a document, or a table within one. A value of another kind is a problem.
  /// @param path  name in messages, as "surfaces.rough"; that of its key without one
  TomlTable(TomlNodePtr table, core::Problems& problems, std::optional<std::string> path = std::nullopt);

  /// Place of the table, of a key's value (the table's place when absent), and name as in
  /// "part.face".
  const core::FileLocation& where() const { return node_->where; }
  core::FileLocation where(const std::string& key) const;
  const std::string& path() const { return path_; }
  /// The key of the table in its parent; empty in arrays and at the root.
  const std::string& name() const { return node_->key; }
  const TomlNodePtr& node() const { return node_; }

  /// True when the key is present. Marks it as known, not as read.
  bool has(const std::string& key) const;
  /// True when the key's value is an array. Marks it neither as known nor as read.
  bool is_array(const std::string& key) const;
  /// Names of all keys, in file order.
  std::vector<std::string> keys() const;
  /// True when the key is present and was read, without a problem so far.
  bool good(const std::string& key) const;
  /// Adds a problem at the key's value (at the table when absent); marks the key as bad.
  void report(const std::string& key, std::string what, std::string hint = {}) const;
  /// Number of problems so far, in the whole document and in all that shares the collector.
  std::size_t problem_count() const;
  /// Adds a problem unless `ok`. Does nothing when the key is absent or already has a problem.
  void expect(const std::string& key, bool ok, const std::string& what, const std::string& hint = {}) const;
  /// The key of `choices` that is present. None (when required) and more than one are problems.
  std::optional<std::string> one_of(const std::vector<std::string>& choices, bool required) const;
  /// The value of the key that is present; nullptr when none is.
  template <typename T, std::size_t N>
  const core::Word<T>* one_of(const core::Word<T> (&choices)[N], bool required) const {
    const std::optional<std::string> key = one_of(core::word_list(choices), required);
    for (const core::Word<T>& known : choices)
      if (key == known.word) return &known;
    return nullptr;
  }

  std::string string(const std::string& key) const;
  std::string string(const std::string& key, const std::string& fallback) const;
  std::optional<std::string> optional_string(const std::string& key) const;

  bool boolean(const std::string& key) const;
  bool boolean(const std::string& key, bool fallback) const;

  std::int64_t integer(const std::string& key) const;
  std::int64_t integer(const std::string& key, std::int64_t fallback) const;
  std::optional<std::int64_t> optional_integer(const std::string& key) const;

  /// A plain number, integer or not.
  double number(const std::string& key) const;
  double number(const std::string& key, double fallback) const;
  std::optional<double> optional_number(const std::string& key) const;

  /// "2 mm" in internal units. A bare number is wrong unless the dimension is dimensionless.
  double quantity(const std::string& key, core::Dimension dimension) const;
  double quantity(const std::string& key, core::Dimension dimension, double fallback) const;
  std::optional<double> optional_quantity(const std::string& key, core::Dimension dimension) const;

  /// One of the words; allowed.front() when wrong.
  std::string choice(const std::string& key, const std::vector<std::string>& allowed) const;
  std::string choice(const std::string& key, const std::vector<std::string>& allowed,
                     const std::string& fallback) const;
  /// The value of one of the words; that of the first when wrong.
  template <typename T, std::size_t N>
  T choice(const std::string& key, const core::Word<T> (&words)[N]) const {
    return core::find_word(words, choice(key, core::word_list(words))).value_or(words[0].value);
  }
  template <typename T, std::size_t N>
  T choice(const std::string& key, const core::Word<T> (&words)[N], std::type_identity_t<T> fallback) const {
    std::string absent;
    if constexpr (requires { fallback == fallback; })
      for (const core::Word<T>& known : words)
        if (absent.empty() && known.value == fallback) absent = known.word;
    return core::find_word(words, choice(key, core::word_list(words), absent)).value_or(fallback);
  }

  /// Arrays of `count` elements; `count` 0 means any length, and at least one unless stated otherwise. Empty
  /// when wrong or absent.
  std::vector<std::string> strings(const std::string& key, std::size_t count = 0, bool required = true) const;
  std::vector<double> numbers(const std::string& key, std::size_t count = 0, bool required = true) const;
  std::vector<double> quantities(const std::string& key, core::Dimension dimension, std::size_t count = 0,
                                 bool required = true) const;
  /// Three quantities ("1 mm", ...) or three plain numbers.
  std::optional<core::Vec3> optional_quantity3(const std::string& key, core::Dimension dimension) const;
  std::optional<core::Vec3> optional_number3(const std::string& key) const;
  /// Three plain numbers normalised to unit length; a zero vector is a problem.
  std::optional<core::Vec3> optional_direction(const std::string& key) const;

  /// Path of a file named by the key: relative paths are relative to the folder of the document. A file that
  /// does not exist is a problem. Empty when wrong or absent.
  std::filesystem::path existing_file(const std::string& key, bool required = true) const;

  /// A curve y(x): a single quantity (a constant), or a table in one of two forms
  ///     { wavelength = ["400 nm", "500 nm"], value = ["1 m", "2 m"] }
  ///     { wavelength = [400, 500], wavelength_unit = "nm", value = [1, 2], value_unit = "m" }
  ///     { file = "x.csv", wavelength_unit = "nm", value_unit = "m",
  ///       wavelength_column = "lambda", value_column = "y" }     # columns: default first, second
  /// where "wavelength" stands for the name of the dimension of x. x may rise or fall, and must not
  /// repeat. `value_unit` may be left out when y is dimensionless. Curve::constant(0) when wrong.
  core::Curve curve(const std::string& key, core::Dimension y,
                    core::Dimension x = core::Dimension::wavelength) const;
  std::optional<core::Curve> optional_curve(const std::string& key, core::Dimension y,
                                            core::Dimension x = core::Dimension::wavelength) const;

  /// Sub-tables, [a.b] or inline. For an absent one `table` adds a problem and returns an empty table.
  TomlTable table(const std::string& key) const;
  std::optional<TomlTable> optional_table(const std::string& key) const;
  /// Every element of [[key]] or key = [{...}]; empty when absent.
  std::vector<TomlTable> tables(const std::string& key) const;
  /// The tables in a table of tables, [key.NAME]: their names are TomlTable::name(). Empty when
  /// absent.
  std::vector<TomlTable> named_tables(const std::string& key) const;
  /// The raw value, marked as read together with everything in it; nullptr when absent.
  TomlNodePtr take(const std::string& key) const;
  /// Marks every key here as read: for an abandoned table, so that one mistake is reported once.
  void skip() const;

  /// Reports keys that were not read, here and in every sub-table that was opened, with the nearest known
  /// key, or the table where a key of this name is known. A known key that was not read is not reported in a
  /// table with another problem, which may be why it was not. Call once, on the outermost table, when
  /// everything has been read.
  void finish() const;

  /// Every key read so far from this document, as "part.face.select", sorted. For tests that
  /// compare with the documentation.
  std::vector<std::string> known_keys() const;

  /// From here on, keeps how the keys of the document are used, for key_uses().
  void record_uses() const;
  /// Every use of a key since record_uses(), in the order of reading; the same use may occur several times.
  const std::vector<KeyUse>& key_uses() const;

 private:
  struct Session;
  TomlTable(TomlNodePtr node, std::string path, std::shared_ptr<Session> session);
  const TomlNode* read(const std::string& key, bool required) const;
  void report_at(const core::FileLocation& where, const std::string& key, std::string what,
                 std::string hint) const;
  void mark_bad(const std::string& key) const;
  void record(const std::string& key, KeyUse use) const;
  std::string hint_for_unknown(const TomlNode& table, const std::string& key) const;
  std::string quoted(const std::string& key) const;
  TomlTable child(const TomlNode& node, const std::string& key) const;
  std::optional<double> quantity_of(const std::string& key, const TomlNode& value,
                                    core::Dimension dimension) const;
  std::optional<double> number_of(const std::string& key, const TomlNode& value) const;
  const TomlNode* array(const std::string& key, std::size_t count, bool required) const;
  std::optional<core::Curve> curve_of(const std::string& key, const TomlNode& value, core::Dimension y,
                                      core::Dimension x) const;

  TomlNodePtr node_;
  std::string path_;
  std::shared_ptr<Session> session_;
};

/// Path of the first key that only one document has or whose values differ as written, such as
/// "part.crystal.surface"; empty when there is none. The order of keys is ignored, that of arrays is not.
/// @param besides  keys of the outermost table that are left out, with all in them
[[nodiscard]] std::string first_difference(const TomlNode& a, const TomlNode& b,
                                           const std::vector<std::string>& besides);

}  // namespace scintray::config
