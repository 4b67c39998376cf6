#include "scintray/optics/wavelength_shifter.hpp"

#include <algorithm>

namespace scintray::optics {

ShiftCount& ShiftCount::operator+=(const ShiftCount& other) {
  absorbed += other.absorbed;
  emitted += other.emitted;
  before_eV += other.before_eV;
  after_eV += other.after_eV;
  kept_eV += other.kept_eV;
  return *this;
}

WavelengthShifter::WavelengthShifter(core::Curve absorption_per_mm, core::Curve quantum_yield,
                                     core::Curve emission, std::vector<DecayComponent> decay)
    : absorption_per_mm_(std::move(absorption_per_mm)),
      quantum_yield_(std::move(quantum_yield)),
      emission_(std::move(emission)),
      spectrum_(emission_),
      decay_(std::move(decay)) {}

std::optional<ShiftedLight> WavelengthShifter::absorb(double wavelength_nm, core::Rng& rng,
                                                      ShiftCount& count) const {
  ++count.absorbed;
  const double energy_eV = photon_energy_eV(wavelength_nm);
  const double below = spectrum_.share_below(wavelength_nm);
  if (below >= 1.0 || rng.uniform() >= quantum_yield_(wavelength_nm)) {
    count.kept_eV += energy_eV;
    return std::nullopt;
  }
  ShiftedLight light;
  // Rounding of the two inverses may not bring back a wavelength below the absorbed one.
  light.wavelength_nm = std::max(wavelength_nm, spectrum_.sample(below + (1.0 - below) * rng.uniform()));
  light.delay_ns = sample_decay(decay_, rng);
  ++count.emitted;
  count.before_eV += energy_eV;
  count.after_eV += photon_energy_eV(light.wavelength_nm);
  return light;
}

}  // namespace scintray::optics
