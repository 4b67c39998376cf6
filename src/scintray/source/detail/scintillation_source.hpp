#pragma once
/// Scintillation and Cherenkov light of energy deposits.

#include <array>
#include <memory>
#include <optional>
#include <span>
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
  void emit_together(const scene::Scene& scene, const EventLight& light,
                     std::span<EmittedPhoton* const> photons, int lane_width) const override;
  std::vector<core::RegionId> regions() const override;

 private:
  /// What a photon comes from.
  struct Cause {
    const Deposit* deposit = nullptr;
    bool prompt = false;  ///< Cherenkov light
    core::MediumId medium;
  };
  static Cause cause_of(const scene::Scene& scene, const EventLight& light, std::uint64_t photon);
  /// Wavelength, and time of emission after the deposit.
  void set_colour(const scene::Scene& scene, const Cause& from, Photon& photon, core::Rng& rng) const;
  void add_steps(const scene::Scene& scene, const std::array<double, 2>& range_nm);
  std::uint64_t scintillation_photons(const optics::Medium& medium, core::MediumId at, const Deposit& deposit,
                                      core::Rng& rng) const;
  const core::CurveSampler& spectrum_of(const scene::Scene& scene, core::MediumId medium,
                                        const Deposit& deposit) const;
  void emit_cherenkov(const Deposit& deposit, core::MediumId medium, Photon& photon, core::Rng& rng) const;

  std::unique_ptr<EventSource> events_;
  core::IdVector<core::MediumId, core::CurveSampler> emission_;
  core::IdVector<core::MediumId, std::vector<core::CurveSampler>>
      particle_emission_;                                                      ///< as Medium::by_particle
  core::IdVector<core::MediumId, std::optional<CherenkovEmitter>> cherenkov_;  ///< empty without that light
  /// Of steps of particles; empty without that light or without steps.
  core::IdVector<core::MediumId, std::optional<CherenkovTrack>> tracks_;
  core::IdVector<core::MediumId, core::Curve>
      birks_;                            ///< energy seen of electrons that stop, keV against keV
  std::vector<core::RegionId> regions_;  ///< that scintillate
  bool unpolarised_;
};

/// Number of scintillation photons of an electron of this energy in a medium, drawn at random: Poisson about
/// a Gaussian about yield times relative yield times energy. The variance of the Gaussian, (fwhm / 2.355)^2
/// yield^2 intrinsic_keV energy, is proportional to the energy: several deposits then have together the
/// spread of one deposit of their total energy, and the intrinsic resolution is proportional to 1 over the
/// square root of the energy.
/// @return 0 where the Gaussian is below zero
std::uint64_t sample_photon_number(const optics::Medium& medium, double energy_keV, core::Rng& rng);

/// Energy (keV) that by Birks' law is seen of an electron that stops, the integral of dE / (1 + kB dE/dx)
/// with ElectronStopping, tabulated against its energy (keV) up to CherenkovEmitter::kGreatestEnergy_keV.
/// Below 10 keV the stopping power is taken as that at 10 keV, the end of its formula: less than it is.
/// @throws InputError (without a place) for a medium without composition
core::Curve birks_response(const optics::Medium& medium);

/// Mean number of scintillation photons of a deposit: by the light of its kind of particle, L(T) - L(T - E)
/// where the kinetic energy T is known and L(E) where it is not; else by Birks' law, E / (1 + kB E / length)
/// of a step with a length; else by yield and relative yield.
/// @param birks  birks_response of the medium, for deposits without a step; unused where it has no Birks
/// constant Throws InputError for an energy beyond the table of the particle's light.
double mean_scintillation(const optics::Medium& medium, const Deposit& deposit, const core::Curve& birks);

}  // namespace scintray::source
