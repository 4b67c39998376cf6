#pragma once
/// Follows gammas through the regions of a scene.

#include <memory>
#include <vector>

#include "scintray/scene_file/gamma_source.hpp"
#include "scintray/source/detail/gamma/cross_sections.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// A gamma on its way.
struct Gamma {
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  core::Vec3 direction = core::Vec3::UnitZ();
  double energy_keV = 0.0;
  double time_ns = 0.0;
  core::RegionId region;
};

/// Transport of gammas of 10 keV to 3 MeV: photoelectric absorption, with K X-rays, Compton and Rayleigh
/// scattering, pair production. Interfaces do not stop or turn gammas. Electrons and positrons leave
/// their energy where they are made, and positrons annihilate there; so do gammas below 10 keV and X-rays
/// of other shells. A gamma with no part ahead of it has escaped. Immutable.
class GammaTransport {
 public:
  /// Throws InputError with every medium that gammas can come through and that states neither what it is
  /// made of nor that it is empty space.
  /// @param where  of the source, for messages
  GammaTransport(const scene::Scene& scene, const std::vector<scene_file::MatterSpec>& matter,
                 bool fluorescence, const core::FileLocation& where);

  /// Follows gammas, and what they make, until all their energy is left or has escaped.
  void follow(const scene::Scene& scene, std::vector<Gamma> gammas, core::Rng& rng, Event& event) const;

  /// What a region is made of; nullptr: empty space.
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
