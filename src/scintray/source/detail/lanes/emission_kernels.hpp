#pragma once
/// Directions, polarisations and optical depths of photons that are emitted together, in the lanes of vector
/// registers.
///
/// This header has only plain data: it is included by files that are compiled for instruction sets which not
/// every processor has, and a function of a common header compiled there could be the one that the linker
/// keeps for all files.

#include <cstddef>
#include <cstdint>

namespace scintray::source {

/// Photons that are emitted together, each at one index of every array.
inline constexpr std::size_t kEmitted = 8;

/// Light emitted in all directions alike.
struct LightLanes {
  alignas(
      64) std::uint64_t state[2][kEmitted];  ///< of the streams of random numbers; afterwards those behind
  bool polarised;                            ///< polarisations are drawn
  // Results.
  alignas(64) double direction[3][kEmitted];
  alignas(64) double polarisation[3][kEmitted];
  alignas(64) double has_polarisation[kEmitted];  ///< 0: another number has to be tried
};
/// Optical depths, exponential with mean 1.
struct DepthLanes {
  alignas(64) std::uint64_t bits[kEmitted];  ///< random
  alignas(64) double depth[kEmitted];
};

/// Null where there are none for a width.
struct EmissionKernels {
  void (*emit)(LightLanes&) = nullptr;
  void (*draw_depths)(DepthLanes&) = nullptr;
};

// Defined where its instruction set is compiled.
EmissionKernels emission_kernels_4();
EmissionKernels emission_kernels_8();

}  // namespace scintray::source
