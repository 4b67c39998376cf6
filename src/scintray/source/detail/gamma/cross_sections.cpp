#include "scintray/source/detail/gamma/cross_sections.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scintray/scene_file/gamma_source.hpp"

namespace scintray::source {

namespace {

constexpr int kPerDecade = 200;
constexpr double kEdgeHalfWidth = 3e-4;  // relative: xraylib's cross sections jump within 2e-4 of its edges
constexpr double kPerCmToPerMm = 0.1;
constexpr std::size_t kProcesses = kGammaProcesses.size();

}  // namespace

GammaMatter::GammaMatter(const optics::Composition& composition, double density_g_per_cm3) {
  for (const optics::ElementShare& share : composition)
    elements_.push_back(std::make_shared<const ElementData>(share.atomic_number));
  make_energies();
  for (const double energy_keV : energies_keV_) {
    const std::size_t first = channel_.size();
    for (std::size_t i = 0; i < elements_.size(); ++i)
      for (const GammaProcess process : kGammaProcesses)
        channel_.push_back(composition[i].mass_fraction * density_g_per_cm3 * kPerCmToPerMm *
                           elements_[i]->cross_section_cm2_per_g(process, energy_keV));
    total_.push_back(
        std::accumulate(channel_.begin() + static_cast<std::ptrdiff_t>(first), channel_.end(), 0.0));
  }
}

void GammaMatter::make_energies() {
  const double decades = std::log10(scene_file::kHighestGamma_keV / scene_file::kLowestGamma_keV);
  const int steps = static_cast<int>(std::ceil(decades * kPerDecade));
  for (int i = 0; i <= steps; ++i)
    energies_keV_.push_back(scene_file::kLowestGamma_keV * std::pow(10.0, decades * i / steps));
  for (const auto& element : elements_)
    for (const double edge : element->edges_keV()) {
      energies_keV_.push_back(edge * (1.0 - kEdgeHalfWidth));
      energies_keV_.push_back(edge * (1.0 + kEdgeHalfWidth));
    }
  energies_keV_.push_back(2.0 * core::kElectronMass_keV);  // threshold of pair production
  std::sort(energies_keV_.begin(), energies_keV_.end());
}

GammaMatter::Position GammaMatter::position(double energy_keV) const {
  const auto after = std::upper_bound(energies_keV_.begin(), energies_keV_.end(), energy_keV);
  const auto index = std::clamp<std::ptrdiff_t>(after - energies_keV_.begin() - 1, 0,
                                                static_cast<std::ptrdiff_t>(energies_keV_.size()) - 2);
  const auto row = static_cast<std::size_t>(index);
  const double t = (energy_keV - energies_keV_[row]) / (energies_keV_[row + 1] - energies_keV_[row]);
  return {row, std::clamp(t, 0.0, 1.0)};
}

double GammaMatter::at(const Position& position, std::size_t channel) const {
  const std::size_t width = elements_.size() * kProcesses;
  const std::size_t i = position.row * width + channel;
  return std::lerp(channel_[i], channel_[i + width], position.t);
}

double GammaMatter::total_per_mm(double energy_keV) const {
  const Position here = position(energy_keV);
  return std::lerp(total_[here.row], total_[here.row + 1], here.t);
}

double GammaMatter::per_mm(GammaProcess process, double energy_keV) const {
  const Position here = position(energy_keV);
  double sum = 0.0;
  for (std::size_t i = 0; i < elements_.size(); ++i)
    sum += at(here, i * kProcesses + static_cast<std::size_t>(process));
  return sum;
}

GammaEncounter GammaMatter::sample(double energy_keV, core::Rng& rng) const {
  const Position here = position(energy_keV);
  double left = rng.uniform() * std::lerp(total_[here.row], total_[here.row + 1], here.t);
  const std::size_t channels = elements_.size() * kProcesses;
  std::size_t last = 0;  // last channel with a cross section, for the remainder by rounding
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const double cross_section = at(here, channel);
    if (cross_section <= 0.0) continue;
    last = channel;
    if (left < cross_section) break;
    left -= cross_section;
  }
  return {kGammaProcesses[last % kProcesses], elements_[last / kProcesses].get()};
}

ComptonScattering sample_klein_nishina(double energy_keV, core::Rng& rng) {
  const double k = energy_keV / core::kElectronMass_keV;
  const double least = 1.0 / (1.0 + 2.0 * k);  // of the ratio of energies after and before
  const double weight_inverse = -std::log(least);
  const double weight_linear = 0.5 * (1.0 - least * least);
  for (;;) {
    const bool inverse = rng.uniform() * (weight_inverse + weight_linear) < weight_inverse;
    const double u = rng.uniform();
    const double ratio =
        inverse ? std::exp(-weight_inverse * u) : std::sqrt(least * least + (1.0 - least * least) * u);
    const double one_less_cosine = (1.0 - ratio) / (k * ratio);
    const double sine2 = one_less_cosine * (2.0 - one_less_cosine);
    if (rng.uniform() < 1.0 - ratio * sine2 / (1.0 + ratio * ratio))
      return {1.0 - one_less_cosine, ratio * energy_keV};
  }
}

ComptonScattering sample_compton(const ElementData& element, double energy_keV, core::Rng& rng) {
  for (;;) {
    const ComptonScattering scattering = sample_klein_nishina(energy_keV, rng);
    const double half_sine = std::sqrt(std::max(0.0, 0.5 * (1.0 - scattering.cosine)));
    if (rng.uniform() < element.incoherent(energy_keV * kPerAngstromPerkeV * half_sine)) return scattering;
  }
}

}  // namespace scintray::source
