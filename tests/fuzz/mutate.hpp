#pragma once
/// Damage to a file, from a fixed seed.

#include <string>
#include <vector>

#include "scintray/core/rng.hpp"

namespace scintray::fuzz {

/// `seed` with one to four changes: bytes flipped, set, cut out, doubled or put in, the end cut off,
/// numbers replaced by hostile ones (in binary and as digits), a piece of another seed.
std::string mutated(const std::string& seed, const std::vector<std::string>& others, core::Rng& rng);

}  // namespace scintray::fuzz
