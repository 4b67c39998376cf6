#include "scintray/config/detail/npy.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>

#include "scintray/core/input_file.hpp"
#include "scintray/core/zip_archive.hpp"

namespace scintray::config {

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMostHeader = std::size_t{1} << 20;  // of Python text, with thousands of fields
constexpr const char* kDamaged = "save it anew with numpy.save, or numpy.savez";

/// Reads the Python literal of a header: a dictionary with strings, True and False, tuples of whole numbers,
/// and a list of pairs of strings.
class HeaderText {
 public:
  HeaderText(std::string_view text, core::FileLocation where) : text_(text), where_(std::move(where)) {}

  NumpyArray read() {
    NumpyArray array;
    bool shaped = false;
    expect('{');
    while (!next('}')) {
      const std::string key = string();
      expect(':');
      if (key == "descr") {
        read_type(array);
      } else if (key == "fortran_order") {
        array.fortran_order = boolean();
      } else if (key == "shape") {
        array.shape = tuple();
        shaped = true;
      } else {
        fail("the key " + core::in_quotes(key));
      }
      next(',');
    }
    if (array.fields.empty() || !shaped) fail("a header without descr or shape");
    return array;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw core::InputError({where_, "the header of the NumPy array has " + what, kDamaged});
  }

  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  bool next(char wanted) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    return true;
  }
  void expect(char wanted) {
    if (!next(wanted)) fail(std::string("no '") + wanted + "' where one is expected");
  }

  std::string string() {
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    const std::size_t end = quote == '\'' || quote == '"' ? text_.find(quote, at_ + 1) : text_.npos;
    if (end == text_.npos) fail("no text in quotes where one is expected");
    const std::string found(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return found;
  }

  bool boolean() {
    skip_blanks();
    for (const auto& [word, value] : {std::pair{std::string_view("True"), true}, {"False", false}})
      if (text_.substr(at_).starts_with(word)) {
        at_ += word.size();
        return value;
      }
    fail("neither True nor False as fortran_order");
  }

  std::vector<std::size_t> tuple() {
    std::vector<std::size_t> numbers;
    expect('(');
    while (!next(')')) {
      skip_blanks();
      std::size_t number = 0;
      const auto [end, status] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
      if (status != std::errc{}) fail("a shape that is not of whole numbers");
      at_ = static_cast<std::size_t>(end - text_.data());
      numbers.push_back(number);
      next(',');
    }
    return numbers;
  }

  void read_type(NumpyArray& array) {
    if (!next('[')) {
      add_field("", string(), array);
      return;
    }
    while (!next(']')) {
      expect('(');
      const std::string name = string();
      expect(',');
      add_field(name, string(), array);
      if (next(',') && !next(')'))
        fail("a field " + core::in_quotes(name) + " of several numbers, which is not read");
      next(')');
      next(',');
    }
  }

  void add_field(const std::string& name, const std::string& type, NumpyArray& array) {
    NumpyField field;
    field.name = name;
    field.offset = array.item_bytes;
    const bool ordered =
        type.size() > 2 && (type[0] == '<' || type[0] == '>' || type[0] == '|' || type[0] == '=');
    const char* first = type.data() + (ordered ? 1 : 0);
    field.big_endian = type[0] == '>';
    field.kind = type.size() > (ordered ? 1U : 0U) ? *first : '?';
    const auto [end, status] = std::from_chars(first + 1, type.data() + type.size(), field.bytes);
    const std::size_t n = field.bytes;
    const bool whole = field.kind == 'i' || field.kind == 'u';
    const bool known = (field.kind == 'f' && (n == 4 || n == 8)) ||
                       (whole && (n == 1 || n == 2 || n == 4 || n == 8)) || (field.kind == 'b' && n == 1);
    // Padding of an aligned type is of the kind V and without a name.
    const bool padding = field.kind == 'V' && name.empty() && n <= kMostHeader;
    if (status != std::errc{} || end != type.data() + type.size() || !(known || padding))
      fail("the type " + core::in_quotes(type) +
           "; expected whole or floating-point numbers of 1 to 8 bytes");
    array.item_bytes += n;
    if (!padding) array.fields.push_back(field);
  }

  std::string_view text_;
  core::FileLocation where_;
  std::size_t at_ = 0;
};

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// Number in the bytes of a field.
double number_in(const char* bytes, const NumpyField& field) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < field.bytes; ++i) {
    const std::size_t at = field.big_endian ? i : field.bytes - 1 - i;
    bits = bits << 8 | static_cast<unsigned char>(bytes[at]);
  }
  if (field.kind == 'f')
    return field.bytes == 8 ? std::bit_cast<double>(bits)
                            : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  if (field.kind != 'i') return static_cast<double>(bits);
  const auto unused = static_cast<unsigned>(64 - 8 * field.bytes);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

/// Numbers of a field from a place on, at equal steps of bytes.
std::vector<double> numbers_at(std::string_view bytes, const NumpyField& field, std::size_t first,
                               std::size_t step, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = number_in(bytes.data() + first + i * step, field);
  return values;
}

}  // namespace

NumpyArray read_numpy_header(std::string_view bytes, const core::FileLocation& where) {
  const auto refuse = [&](const std::string& what) { throw core::InputError({where, what, kDamaged}); };
  if (!bytes.starts_with(kMagic) || bytes.size() < 10) refuse("this is not an array of NumPy");
  const int version = static_cast<unsigned char>(bytes[6]);
  if (version < 1 || version > 3)
    refuse("a NumPy array of version " + std::to_string(version) + "; 1 to 3 are read");
  const std::size_t width = version == 1 ? 2 : 4, start = 8 + width;
  const std::uint64_t length = bytes.size() < start ? bytes.size() : little_endian(bytes.substr(8, width));
  if (length > kMostHeader || length > bytes.size() - std::min(start, bytes.size()))
    refuse("a NumPy array whose header does not end");
  NumpyArray array = HeaderText(bytes.substr(start, length), where).read();
  array.data = start + length;
  std::size_t needed = array.item_bytes;
  for (const std::size_t n : array.shape) {
    if (n > 0 && needed > std::numeric_limits<std::size_t>::max() / n)
      refuse("a NumPy array of impossible shape");
    needed *= n;
  }
  if (needed > bytes.size() - array.data)
    refuse("a NumPy array of " + std::to_string(needed) + " bytes, of which " +
           std::to_string(bytes.size() - array.data) + " are there");
  return array;
}

NumpyFile::NumpyFile(const ColumnFile& file) : file_(file) {
  std::optional<std::string> content = core::read_whole_file(file.path);
  if (!content)
    throw core::InputError({file.where, "cannot read " + file.path.string(), "check its name and rights"});
  if (column_format(file.path) == ColumnFormat::npz) {
    const core::ZipArchive archive(*content, file.path.string());
    for (const std::string& entry : archive.names())
      if (entry.ends_with(".npy")) contents_.emplace(entry.substr(0, entry.size() - 4), archive.read(entry));
  } else {
    contents_.emplace("", std::move(*content));
  }
  for (const auto& [name, bytes] : contents_)
    arrays_.emplace(name, read_numpy_header(bytes, {file.path.string() + (name.empty() ? "" : ":" + name)}));
}

std::vector<double> NumpyFile::column(const std::string& name) const {
  std::vector<std::string> names;
  if (column_format(file_.path) == ColumnFormat::npz) {
    const auto found = arrays_.find(name);
    for (const auto& [known, array] : arrays_) names.push_back(known);
    if (found == arrays_.end()) throw core::unknown_name(file_.where, "array", name, names);
    const NumpyArray& array = found->second;
    if (array.shape.size() != 1 || !array.fields.front().name.empty())
      throw core::InputError({file_.where, "the array \"" + name + "\" is not one column",
                              "give an array of one dimension per column"});
    return numbers_at(contents_.at(name), array.fields.front(), array.data, array.item_bytes, array.shape[0]);
  }
  const NumpyArray& array = arrays_.begin()->second;
  const std::string& bytes = contents_.begin()->second;
  const bool structured = !array.fields.front().name.empty();
  if (array.shape.empty() || (structured && array.shape.size() != 1))
    throw core::InputError({file_.where, "the array of " + file_.path.string() + " has no rows of columns",
                            "save a structured array of one dimension, or one whose first axis is the row"});
  const std::size_t rows = array.shape[0];
  if (structured) {
    for (const NumpyField& field : array.fields) {
      if (field.name == name)
        return numbers_at(bytes, field, array.data + field.offset, array.item_bytes, rows);
      names.push_back(field.name);
    }
    throw core::unknown_name(file_.where, "field", name, names);
  }
  std::size_t columns = 1;
  for (std::size_t axis = 1; axis < array.shape.size(); ++axis) columns *= array.shape[axis];
  std::size_t number = columns;
  const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (status != std::errc{} || end != name.data() + name.size() || number >= columns)
    throw core::InputError(
        {file_.where, "the array of " + file_.path.string() + " has no column \"" + name + "\"",
         "it has no fields: its columns are the numbers 0 to " + std::to_string(columns - 1)});
  if (array.fortran_order && array.shape.size() > 2)
    throw core::InputError({file_.where, "an array of several axes in Fortran's order is not read",
                            "save numpy.ascontiguousarray(a)"});
  const std::size_t size = array.item_bytes;
  return array.fortran_order
             ? numbers_at(bytes, array.fields.front(), array.data + number * rows * size, size, rows)
             : numbers_at(bytes, array.fields.front(), array.data + number * size, columns * size, rows);
}

}  // namespace scintray::config
