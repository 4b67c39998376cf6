#pragma once
/// Kinds of errors, each with the code that is printed in brackets after a message, and its text for the
/// option
/// --explain.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scintray::cli {

struct ErrorKind {
  const char* code;    ///< "unknown-key"
  const char* title;   ///< the error in one phrase
  const char* why;     ///< when it occurs, and the meaning of its place
  const char* remedy;  ///< the correction
  /// Fragments of messages: a message that holds one of them is of this kind. Empty: by the type of the
  /// exception. Those of kDamagedFile are searched for in hints too.
  std::vector<std::string_view> fragments;
};

/// All kinds; of several that match a message the first applies.
std::span<const ErrorKind> error_kinds();

/// The code of a message about the input: that of the first kind with a fragment of it, else kInputError.
const char* input_error_code(std::string_view what, std::string_view hint = "");

inline constexpr const char* kDamagedFile = "file-damaged";
inline constexpr const char* kInputError = "input";
inline constexpr const char* kUsageError = "usage";
inline constexpr const char* kSystemError = "system";
inline constexpr const char* kDefectError = "defect";

/// The text of `scintray --explain CODE`, or of a list of all codes without one. Throws InputError for an
/// unknown code, with the nearest one.
std::string explanation(const std::string& code);

}  // namespace scintray::cli
