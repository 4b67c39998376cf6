#pragma once
/// A stop that was requested.

#include "scintray/core/error.hpp"

namespace scintray::core {

/// Work was cancelled before it had a result. Neither the input nor the program is at fault.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace scintray::core
