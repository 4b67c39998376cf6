#pragma once
/// Interactions placed where the scene states, with energies drawn from a spectrum: no transport.

#include "scintray/scene_file/gamma_source.hpp"
#include "scintray/source/detail/origin.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// Each event is one deposit, uniform over the origin, at time 0, of the spectrum's energy: the way of
/// E. Roncali and S. R. Cherry 2013, Phys. Med. Biol. 58 2185, section 2.2. Immutable.
class SpectrumEventSource : public EventSource {
 public:
  /// Throws InputError as Origin does, and when a medium of the origin does not scintillate.
  SpectrumEventSource(const scene_file::SpectrumSpec& spec, std::uint64_t events, const scene::Scene& scene);

  std::uint64_t events() const override { return events_; }
  Event make(const scene::Scene& scene, std::uint64_t number, core::Rng& rng) const override;

 private:
  Origin origin_;
  double energy_keV_ = 0.0;
  std::optional<core::CurveSampler> spectrum_;
  std::uint64_t events_ = 0;
};

}  // namespace scintray::source
