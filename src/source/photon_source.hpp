#pragma once
/// Photons as they start.

#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/scene/spec.hpp"
#include "scintray/source/origin.hpp"
#include "scintray/source/photon.hpp"

namespace scintray {

/// Makes the photons of a scene's [source]. Immutable; photons depend on their random stream only.
class PhotonSource {
 public:
  /// Binds a specification to a built scene. A pattern of parts is the union of those that have some
  /// of the source's box. Throws InputError when the region is empty, no part has that name, the media
  /// there differ, or have no emission or decay that was asked for.
  PhotonSource(const SourceSpec& spec, const Scene& scene);

  /// A new photon from its own stream.
  Photon emit(const Scene& scene, Rng& rng) const;

  std::uint64_t photons() const { return photons_; }
  std::uint64_t photons_per_event() const { return photons_per_event_; }
  /// Regions in which photons start.
  std::vector<std::uint32_t> regions() const { return origin_.regions(); }

 private:
  void check_medium(const SourceSpec& spec, const Scene& scene);

  Origin origin_;
  DirectionSpec direction_;
  double wavelength_nm_ = 0.0;
  std::optional<CurveSampler> emission_;
  double time_ns_ = 0.0;
  std::vector<DecayComponent> decay_;
  bool unpolarised_ = false;
  std::uint64_t photons_ = 0, photons_per_event_ = 1;
};

}  // namespace scintray
