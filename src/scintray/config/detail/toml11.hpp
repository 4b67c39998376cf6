#pragma once
/// Adapter for the parts of toml11 that are not its public interface: the place of a value in the text, and
/// the cause of a syntax error. Nothing else uses toml::detail or reads toml11's messages;
/// tests/scene/toml11_test.cpp pins both for the version in use.

#include <cstddef>
#include <string>
#include <toml.hpp>

#if !defined(TOML11_VERSION_MAJOR) || TOML11_VERSION_MAJOR != 3
#error \
    "only the regions and the messages of toml11 3 are supported: see src/scintray/config/detail/toml11.cpp"
#endif

namespace scintray::config::toml11 {

/// Range of a value in the text, in bytes.
struct Span {
  std::size_t offset = 0, size = 0;
};

/// Empty, at the start of the text, for a value that was not read from one.
[[nodiscard]] Span span_of(const toml::value& value);

/// Kind of a syntax error, as far as toml11's message identifies it.
enum class Mistake {
  more_on_the_line,  ///< something after the value
  defined_twice,
  open_string,
  not_utf8,
  no_equals_sign,
  bad_key,
  open_array,
  open_table,  ///< { ... } that is not closed, or without a comma between two keys
  no_value,
  bad_value,  ///< a value that is neither text in quotes nor a number, list, true or false
  other,
};

/// A syntax error: its kind, its place and its message.
struct SyntaxError {
  std::size_t line = 0, byte_column = 0;  ///< from 1
  std::size_t other_line = 0;             ///< of the earlier place that the error is about; 0 without one
  std::string message;                    ///< one line, with toml11's comment on the place in brackets
  Mistake mistake = Mistake::other;
};

/// The syntax error in toml11's drawing; where that shows no place, the place is its public location().
[[nodiscard]] SyntaxError syntax_error(const toml::exception& error);

}  // namespace scintray::config::toml11
