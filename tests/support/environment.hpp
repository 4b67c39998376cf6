#pragma once
/// The environment of a test.

#include <cstdlib>
#include <optional>
#include <string>

namespace scintray::test {

/// An environment variable that has a value, or none, for one scope, and then the earlier one again.
class ScopedVariable {
 public:
  /// @param value  nothing: unset
  ScopedVariable(std::string name, const std::optional<std::string>& value) : name_(std::move(name)) {
    if (const char* now = std::getenv(name_.c_str())) before_ = now;
    set(value);
  }
  ~ScopedVariable() { set(before_); }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

  void set(const std::optional<std::string>& value) const {
    if (value)
      ::setenv(name_.c_str(), value->c_str(), 1);
    else
      ::unsetenv(name_.c_str());
  }

 private:
  std::string name_;
  std::optional<std::string> before_;
};

}  // namespace scintray::test
