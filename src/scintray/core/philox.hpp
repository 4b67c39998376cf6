#pragma once
/// Philox4x64-10: random bits as a function of a counter and a key.
///
/// Source: J. K. Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3", SC'11 (table 2, section
/// 4.3). The same generator as numpy.random.Philox.

#include <array>
#include <cstdint>

namespace scintray::core {

/// 256 random bits of `counter` under `key`.
std::array<std::uint64_t, 4> philox4x64(std::array<std::uint64_t, 4> counter,
                                        std::array<std::uint64_t, 2> key);

}  // namespace scintray::core
