#pragma once
/// `--json`: the numbers of a command as one JSON value, alone on standard output.

#include <CLI/App.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "scintray/core/statistics.hpp"

namespace scintray::cli {

using Json = nlohmann::ordered_json;

/// Adds `--json` to a command.
void add_json_flag(CLI::App& command, bool& wanted);

/// The JSON output of a command. During its lifetime, if JSON is wanted, the text that the command prints for
/// people goes to standard error.
class JsonAnswer {
 public:
  explicit JsonAnswer(bool wanted);
  ~JsonAnswer();
  JsonAnswer(const JsonAnswer&) = delete;
  JsonAnswer& operator=(const JsonAnswer&) = delete;

  /// Prints the value on standard output, if JSON is wanted; otherwise it is not computed. Bytes that are not
  /// UTF-8 are replaced by U+FFFD.
  void print(const std::function<Json()>& value) const;
  /// The same for a value that is JSON text already.
  void print_text(const std::function<std::string()>& text) const;

 private:
  std::streambuf* standard_output_ = nullptr;  ///< set where JSON is wanted
};

/// A number; null where it is not finite.
Json json_of(double value);
/// {"value": ..., "error": ...}
Json json_of(const core::Estimate& estimate);

}  // namespace scintray::cli
