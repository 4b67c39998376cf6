#pragma once
/// Hints about shares.

#include <string>

namespace scintray::core {

/// The hint for a share that is not in 0 to 1: a number up to 100 was meant as per cent.
std::string share_hint(double value);

}  // namespace scintray::core
