#pragma once
/// Photons as they start.

#include <variant>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/scene/spec.hpp"
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
  std::vector<std::uint32_t> regions() const;

 private:
  /// A region and the box in which positions are drawn and, if inside, kept.
  struct Origin {
    std::uint32_t region = 0;
    Eigen::AlignedBox3d box;
    double most = 1.0;  ///< share of the volume of the boxes up to this one
  };
  void add_origin(const RegionSpec& spec, const PartInfo& part);
  void check_medium(const SourceSpec& spec, const Scene& scene);
  const Origin& sample_origin(Rng& rng) const;
  void sample_place(const Scene& scene, Rng& rng, Photon& photon) const;
  Vec3 sample_direction(Rng& rng) const;

  std::vector<Origin> origins_;
  bool point_ = false;
  DirectionSpec direction_;
  double wavelength_nm_ = 0.0;
  std::optional<CurveSampler> emission_;
  double time_ns_ = 0.0;
  std::vector<DecayComponent> decay_;
  bool unpolarised_ = false;
  std::uint64_t photons_ = 0, photons_per_event_ = 1;
};

}  // namespace scintray
