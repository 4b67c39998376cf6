#pragma once
/// Scintillation and Cherenkov light of energy deposits.

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/source/detail/cherenkov.hpp"
#include "scintray/source/light_source.hpp"

namespace scintray::source {

/// Options of the emitted light.
struct LightOptions {
  bool unpolarised = false;                             ///< else each photon has a random polarisation
  bool cherenkov = false;                               ///< Cherenkov light of the deposits' electrons
  std::optional<std::array<double, 2>> cherenkov_nm{};  ///< its wavelengths; nothing: the scene's
};

/// Source of the photons of energy deposits, by the media of the deposits: their number from the yield, its
/// dependence on energy and its spread; wavelengths from the emission spectrum, times from the decay times;
/// directions are isotropic. Cherenkov light is emitted without delay. Immutable.
class ScintillationSource : public LightSource {
 public:
  /// @throws InputError without a place, with Cherenkov light, for a scintillator without composition
  ScintillationSource(std::unique_ptr<EventSource> events, const scene::Scene& scene,
                      const LightOptions& options = {});

  std::uint64_t events() const override { return events_->events(); }
  bool has_energy() const override { return true; }
  std::uint64_t blocks() const override { return events(); }
  std::vector<PhotonSpan> block(std::uint64_t number) const override { return {{number}}; }
  std::uint64_t photons() const override { return 0; }
  void begin(const scene::Scene& scene, std::uint64_t event, core::Rng& rng,
             EventLight& light) const override;
  Photon emit(const scene::Scene& scene, const EventLight& light, std::uint64_t photon,
              core::Rng& rng) const override;
  std::vector<core::RegionId> regions() const override;

 private:
  std::unique_ptr<EventSource> events_;
  core::IdVector<core::MediumId, core::CurveSampler> emission_;
  core::IdVector<core::MediumId, std::optional<CherenkovEmitter>> cherenkov_;  ///< empty without that light
  std::vector<core::RegionId> regions_;                                        ///< that scintillate
  bool unpolarised_;
};

/// Number of scintillation photons of an electron of this energy in a medium, drawn at random: Poisson about
/// a Gaussian about yield times relative yield times energy. The variance of the Gaussian, (fwhm / 2.355)^2
/// yield^2 intrinsic_keV energy, is proportional to the energy: several deposits then have together the
/// spread of one deposit of their total energy, and the intrinsic resolution is proportional to 1 over the
/// square root of the energy.
/// @return 0 where the Gaussian is below zero
std::uint64_t sample_photon_number(const optics::Medium& medium, double energy_keV, core::Rng& rng);

}  // namespace scintray::source
