#include "scintray/optics/wavelength_shifter.hpp"

#include <algorithm>
#include <set>

#include "scintray/core/count_sampling.hpp"

namespace scintray::optics {

namespace {

/// Sum of the absorptions: linear between the points of all tables, as each of them is.
core::Curve sum_of_absorptions(const std::vector<Fluorophore>& fluorophores) {
  if (fluorophores.size() == 1) return fluorophores.front().absorption_per_mm;
  std::set<double> wavelengths_nm;
  for (const Fluorophore& fluorophore : fluorophores)
    if (!fluorophore.absorption_per_mm.is_constant())
      wavelengths_nm.insert(fluorophore.absorption_per_mm.x().begin(),
                            fluorophore.absorption_per_mm.x().end());
  if (wavelengths_nm.empty()) wavelengths_nm.insert(0.0);
  std::vector<double> sums;
  for (const double wavelength_nm : wavelengths_nm) {
    double sum = 0.0;
    for (const Fluorophore& fluorophore : fluorophores) sum += fluorophore.absorption_per_mm(wavelength_nm);
    sums.push_back(sum);
  }
  return {{wavelengths_nm.begin(), wavelengths_nm.end()}, std::move(sums)};
}

}  // namespace

ShiftCount& ShiftCount::operator+=(const ShiftCount& other) {
  absorbed += other.absorbed;
  emitted += other.emitted;
  additional += other.additional;
  before_eV += other.before_eV;
  after_eV += other.after_eV;
  kept_eV += other.kept_eV;
  return *this;
}

WavelengthShifter::WavelengthShifter(core::Curve absorption_per_mm, core::Curve quantum_yield,
                                     core::Curve emission, std::vector<DecayComponent> decay)
    : WavelengthShifter(std::vector<Fluorophore>{
          {std::move(absorption_per_mm), std::move(quantum_yield), std::move(emission), std::move(decay)}}) {}

WavelengthShifter::WavelengthShifter(std::vector<Fluorophore> fluorophores)
    : fluorophores_(std::move(fluorophores)), absorption_per_mm_(sum_of_absorptions(fluorophores_)) {
  for (const Fluorophore& fluorophore : fluorophores_) {
    spectra_.emplace_back(fluorophore.emission);
    multiplies_ |= fluorophore.statistics == ShiftStatistics::poisson;
  }
}

std::size_t WavelengthShifter::pick(double wavelength_nm, core::Rng& rng) const {
  if (fluorophores_.size() == 1) return 0;
  double rest = rng.uniform() * absorption_per_mm_(wavelength_nm);
  std::size_t last = 0;
  for (std::size_t i = 0; i < fluorophores_.size(); ++i) {
    const double per_mm = fluorophores_[i].absorption_per_mm(wavelength_nm);
    if (per_mm > 0.0) last = i;
    if (rest < per_mm) return i;
    rest -= per_mm;
  }
  return last;  // rounding of the sum
}

std::optional<ShiftedLight> WavelengthShifter::absorb(double wavelength_nm, core::Rng& rng, ShiftCount& count,
                                                      std::vector<ShiftedLight>* more) const {
  return absorb_by(pick(wavelength_nm, rng), wavelength_nm, rng, count, more);
}

std::optional<ShiftedLight> WavelengthShifter::absorb_by(std::size_t number, double wavelength_nm,
                                                         core::Rng& rng, ShiftCount& count,
                                                         std::vector<ShiftedLight>* more) const {
  const Fluorophore& fluorophore = fluorophores_[number];
  const core::CurveSampler& spectrum = spectra_[number];
  const bool kasha = fluorophore.rule == ShiftRule::kasha;
  ++count.absorbed;
  const double energy_eV = photon_energy_eV(wavelength_nm);
  const double below = kasha ? 0.0 : spectrum.share_below(wavelength_nm);
  std::uint64_t photons = 0;
  if (below < 1.0) {
    const double mean = fluorophore.quantum_yield(wavelength_nm);
    photons = fluorophore.statistics == ShiftStatistics::poisson ? core::sample_poisson(mean, rng)
                                                                 : (rng.uniform() < mean ? 1 : 0);
  }
  if (photons == 0) {
    count.kept_eV += energy_eV;
    return std::nullopt;
  }
  const auto re_emit = [&] {
    ShiftedLight light;
    light.wavelength_nm = spectrum.sample(below + (1.0 - below) * rng.uniform());
    // Rounding of the two inverses may not bring back a wavelength below the absorbed one.
    if (!kasha) light.wavelength_nm = std::max(wavelength_nm, light.wavelength_nm);
    light.delay_ns = sample_decay(fluorophore.decay, rng);
    count.after_eV += photon_energy_eV(light.wavelength_nm);
    return light;
  };
  const ShiftedLight first = re_emit();
  for (std::uint64_t i = 1; i < photons; ++i) {
    const ShiftedLight other = re_emit();
    if (more) more->push_back(other);
  }
  ++count.emitted;
  count.additional += photons - 1;
  count.before_eV += energy_eV;
  return first;
}

}  // namespace scintray::optics
