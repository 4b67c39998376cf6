#pragma once
/// Version of ScintRay; every results file holds it.

#include <string>

namespace scintray::core {

/// Release number and, when built from a git checkout, the revision: "0.1.0+g1a2b3c4d5e6f", with
/// ".modified" behind it when the checkout had uncommitted changes.
std::string version();

/// Release number alone, "0.1.0".
std::string release();

}  // namespace scintray::core
