#pragma once
/// Photons as they start.

#include <variant>

#include "scintray/core/curve.hpp"
#include "scintray/scene/spec.hpp"
#include "scintray/source/photon.hpp"

namespace scintray {

/// Makes the photons of a scene's [source]. Immutable; photons depend on their random stream only.
class PhotonSource {
 public:
  /// Binds a specification to a built scene. Throws InputError when the region is empty, no part has
  /// that name, or the medium there has no emission or decay that was asked for.
  PhotonSource(const SourceSpec& spec, const Scene& scene);

  /// A new photon from its own stream.
  Photon emit(const Scene& scene, Rng& rng) const;

  std::uint64_t photons() const { return photons_; }
  std::uint64_t photons_per_event() const { return photons_per_event_; }
  /// Region in which photons start.
  std::uint32_t region() const { return region_; }

 private:
  Vec3 sample_position(const Scene& scene, Rng& rng) const;
  Vec3 sample_direction(Rng& rng) const;

  Eigen::AlignedBox3d bounds_;  ///< in which positions are drawn and, if inside, kept
  bool point_ = false;
  DirectionSpec direction_;
  double wavelength_nm_ = 0.0;
  std::optional<CurveSampler> emission_;
  double time_ns_ = 0.0;
  std::vector<DecayComponent> decay_;
  bool unpolarised_ = false;
  std::uint64_t photons_ = 0, photons_per_event_ = 1;
  std::uint32_t region_ = 0;
};

}  // namespace scintray
