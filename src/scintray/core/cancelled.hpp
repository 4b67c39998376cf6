#pragma once
/// Cancellation of work.

#include "scintray/core/error.hpp"

namespace scintray::core {

/// Thrown when work was cancelled before it had a result. Neither the input nor the program is at fault.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace scintray::core
