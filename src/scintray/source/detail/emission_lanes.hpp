#pragma once
/// Photons that are emitted together, in lanes.

#include <span>

#include "scintray/source/detail/lanes/emission_kernels.hpp"
#include "scintray/source/light_source.hpp"

namespace scintray::source {

/// Parts of the emission of several photons, which draw the same numbers, to the same bits, as
/// core/sampling.hpp does for each of them alone.
class EmissionLanes {
 public:
  /// Photons of one call, at most kEmitted.
  using Photons = std::span<EmittedPhoton* const>;

  /// @param lane_width  photons at once; 1 and 2: photons are emitted one by one
  explicit EmissionLanes(int lane_width);
  /// False when so many photons have to be emitted one by one.
  bool take(std::size_t photons) const { return kernels_.emit && photons <= kEmitted; }

  /// Sets direction and polarisation of light, of one photon or more, that is emitted in all directions
  /// alike.
  void emit_isotropic(Photons photons, bool unpolarised) const;
  /// Sets the optical depths.
  void draw_depths(Photons photons) const;

 private:
  EmissionKernels kernels_;
};

}  // namespace scintray::source
