#pragma once
/// Sources of gammas.

#include <optional>

#include "scintray/source/detail/gamma/decay.hpp"
#include "scintray/source/detail/gamma/transport.hpp"
#include "scintray/source/detail/origin.hpp"

namespace scintray::source {

/// Events of gammas that start somewhere and leave energy where transport takes them. Immutable.
class GammaEventSource : public EventSource {
 public:
  /// Throws InputError as Origin and GammaTransport do, and when 176Lu is to decay where there is no
  /// lutetium, or no part scintillates.
  GammaEventSource(const scene_file::EmitterSpec& spec, std::uint64_t events, const scene::Scene& scene);

  std::uint64_t events() const override { return events_; }
  Event make(const scene::Scene& scene, std::uint64_t number, core::Rng& rng) const override;

  /// How an event starts.
  struct Start {
    Place place;
    std::vector<Gamma> gammas;
    double local_keV = 0.0;  ///< left there by electrons
  };
  Start start(const scene::Scene& scene, core::Rng& rng) const;

 private:
  Place sample_place(const scene::Scene& scene, core::Rng& rng) const;
  void add_pair(Gamma gamma, core::Rng& rng, std::vector<Gamma>& gammas) const;
  void check_lutetium(const scene_file::EmitterSpec& spec, const scene::Scene& scene) const;

  std::optional<Origin> origin_;
  scene_file::PlaneSpec plane_;  ///< where there is no origin
  scene_file::Emission emission_;
  double energy_keV_ = 0.0;
  scene_file::DirectionSpec direction_;
  double acollinearity_sigma_rad_ = 0.0;
  DecaySampler decay_;
  GammaTransport transport_;
  std::uint64_t events_ = 0;
};

}  // namespace scintray::source
