#pragma once
/// Transport of gammas through the regions of a scene.

#include <memory>
#include <vector>

#include "scintray/scene_file/gamma_source.hpp"
#include "scintray/source/detail/gamma/cross_sections.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// State of a gamma.
struct Gamma {
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  core::Vec3 direction = core::Vec3::UnitZ();
  double energy_keV = 0.0;
  double time_ns = 0.0;
  core::RegionId region;
};

/// Transport of gammas of 10 keV to 3 MeV: photoelectric absorption, with K X-rays, Compton and Rayleigh
/// scattering, pair production. Interfaces do not affect gammas. Electrons and positrons deposit their energy
/// at the point of interaction, where positrons annihilate; gammas below 10 keV and X-rays of other shells
/// are absorbed at that point. A gamma without a part ahead of it has escaped. Immutable.
class GammaTransport {
 public:
  /// Throws InputError with every medium that gammas can reach and that is defined neither by a composition
  /// nor as empty space.
  /// @param where  of the source, for messages
  GammaTransport(const scene::Scene& scene, const std::vector<scene_file::MatterSpec>& matter,
                 bool fluorescence, const core::FileLocation& where);

  /// Interactions of gammas that stay within the given regions, for `absorb_all` alone. Throws InternalError
  /// for one whose medium has no composition.
  GammaTransport(const scene::Scene& scene, const std::vector<core::RegionId>& regions);

  /// Adds to `event` the deposits of gammas and their secondaries, which are followed until all energy is
  /// deposited or has escaped.
  void follow(const scene::Scene& scene, std::vector<Gamma> gammas, core::Rng& rng, Event& event) const;

  /// Adds to `event` the deposits of a gamma of 10 keV to 3 MeV of which nothing escapes, all at its
  /// position: one for each electron that the gamma and its secondaries set free. Their sum is the gamma's
  /// energy.
  void absorb_all(const scene::Scene& scene, const Gamma& gamma, core::Rng& rng, Event& event) const;

  /// Matter of a region; nullptr: empty space.
  const GammaMatter* matter(core::RegionId region) const { return matter_[region].get(); }

 private:
  struct Walk;
  void follow_one(Walk& walk, Gamma gamma) const;
  bool interact(Walk& walk, Gamma& gamma) const;
  void absorb(Walk& walk, const Gamma& gamma, const ElementData& element) const;
  void make_pair(Walk& walk, const Gamma& gamma) const;

  core::IdVector<core::RegionId, std::shared_ptr<const GammaMatter>> matter_;
  bool fluorescence_ = true;
};

}  // namespace scintray::source
