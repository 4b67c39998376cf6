#pragma once
/// Normal deviates in the lanes of vector registers. Plain data alone, as this header is included by files
/// that are compiled for instruction sets which not every processor has.

#include <cstddef>
#include <cstdint>

namespace scintray::core {

/// Pairs of deviates.
struct NormalLanes {
  static constexpr std::size_t kPairs = 32, kDeviates = 2 * kPairs;

  alignas(64) std::uint64_t for_radius[kPairs], turn[kPairs];  ///< the random bits of each pair
  alignas(64) double deviates[kDeviates];
};

/// Sets the deviates.
using SetNormals = void (*)(NormalLanes&);

// Defined where its instruction set is compiled.
void set_normals_4(NormalLanes&);
void set_normals_8(NormalLanes&);

}  // namespace scintray::core
