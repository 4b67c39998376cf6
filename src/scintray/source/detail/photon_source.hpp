#pragma once
/// Photons as they start.

#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/scene_file/spec.hpp"
#include "scintray/source/detail/origin.hpp"
#include "scintray/source/light_source.hpp"

namespace scintray::source {

/// Makes the photons of a scene's [source]. Immutable; photons depend on their random stream only.
class PhotonSource : public LightSource {
 public:
  /// Binds a specification to a built scene. A pattern of parts is the union of those that have some
  /// of the source's box. Throws InputError when the region is empty, no part has that name, the media
  /// there differ, or have no emission or decay that was requested.
  PhotonSource(const scene_file::SourceSpec& spec, const scene::Scene& scene);

  std::uint64_t events() const override;
  bool has_energy() const override { return false; }
  std::uint64_t blocks() const override;
  std::vector<PhotonSpan> block(std::uint64_t number) const override;
  std::uint64_t photons() const override { return photons_; }
  void begin(const scene::Scene& scene, std::uint64_t event, core::Rng& rng,
             EventLight& light) const override;
  /// A new photon, from its own stream alone.
  Photon emit(const scene::Scene& scene, core::Rng& rng) const;
  Photon emit(const scene::Scene& scene, const EventLight&, std::uint64_t, core::Rng& rng) const override {
    return emit(scene, rng);
  }
  std::vector<core::RegionId> regions() const override { return origin_.regions(); }

 private:
  void check_medium(const scene_file::SourceSpec& spec, const scene::Scene& scene);

  Origin origin_;
  scene_file::DirectionSpec direction_;
  double wavelength_nm_ = 0.0;
  std::optional<core::CurveSampler> emission_;
  double time_ns_ = 0.0;
  std::vector<optics::DecayComponent> decay_;
  bool unpolarised_ = false;
  std::uint64_t photons_ = 0, photons_per_event_ = 1;
};

}  // namespace scintray::source
