#pragma once
/// References by name within a file.

#include <string>

#include "scintray/core/error.hpp"

namespace scintray::config {

/// A name that refers to another item, with its place in the file. Empty when not given.
struct NameRef {
  std::string name;
  core::FileLocation where;
  bool empty() const { return name.empty(); }
  bool operator==(const NameRef&) const = default;
};

}  // namespace scintray::config
