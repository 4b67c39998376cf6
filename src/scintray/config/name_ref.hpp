#pragma once
/// A name in a file that refers to something else.

#include <string>

#include "scintray/core/error.hpp"

namespace scintray::config {

/// A name that refers to something, and where it was written. Empty: not given.
struct NameRef {
  std::string name;
  core::FileLocation where;
  bool empty() const { return name.empty(); }
  bool operator==(const NameRef&) const = default;
};

}  // namespace scintray::config
