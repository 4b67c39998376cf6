#pragma once
/// Errors. Library code throws; only the command line prints and exits.
///
/// Grammar of a message: what was found, then what was expected, then `hint: what to do`.

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace scintray::core {

/// A place in an input file; line and column count from 1, 0 means unknown.
struct FileLocation {
  std::string file;
  long line = 0;
  long column = 0;

  /// "file:line:column", shortened to what is known; empty when nothing is.
  std::string text() const;
  bool operator==(const FileLocation&) const = default;
};

/// One error of the input: its place, what is wrong, and how to correct it.
struct Problem {
  FileLocation where;
  std::string what;  ///< what was found and what was expected
  std::string hint;  ///< what to do about it; may be empty
  /// Positions (x, y, z in mm) of a few examples, for pictures. Empty for a problem without a position.
  std::vector<std::array<double, 3>> places_mm = {};

  /// Text "file:line:column: error: what\n  hint: hint".
  std::string text() const;
};

/// Base of all exceptions that ScintRay throws.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Error of the input. Holds every problem found, not only the first.
class InputError : public Error {
 public:
  explicit InputError(Problem problem);
  explicit InputError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Error of the operating system: a file cannot be opened, a disk is full.
class SystemError : public Error {
 public:
  using Error::Error;
};

/// A defect in ScintRay itself: a condition that must hold does not.
class InternalError : public Error {
 public:
  using Error::Error;
};

/// Collects problems while reading so that all are reported at once.
class Problems {
 public:
  void add(FileLocation where, std::string what, std::string hint = {},
           std::vector<std::array<double, 3>> places_mm = {});
  void add(Problem problem);
  /// Adds the problems of a caught InputError.
  void add(const InputError& error);
  bool empty() const { return list_.empty(); }
  const std::vector<Problem>& list() const { return list_; }
  /// Throws InputError with all problems collected; does nothing when there are none.
  void throw_if_any();

 private:
  std::vector<Problem> list_;
};

/// The candidate closest to `word` by edit distance (Levenshtein 1966), or "" when none is near
/// (distance above a third of the word's length, at least 2, or all of it replaced). The case of letters and
/// the choice of blank, hyphen, dot or underscore do not count. For "did you mean" hints.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

/// The error "no face is called "x"", with the nearest name there is and the first of the names.
/// @param kind kind of the named object: "face", "part"
InputError unknown_name(const FileLocation& where, const std::string& kind, const std::string& wanted,
                        const std::vector<std::string>& names);

/// `text` for a message: shortened, and with bytes that are no printable ASCII replaced by '?'
/// unless they are part of UTF-8.
std::string in_quotes(std::string_view text);

}  // namespace scintray::core
