#include "scintray/source/detail/cherenkov.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/source/detail/gamma/element_data.hpp"

namespace scintray::source {

namespace {

/// Ratio of neighbouring energies of the table: linear interpolation is accurate to a tenth of a per cent
/// from 1.1 times the threshold on.
constexpr double kEnergyStep = 1.01;
constexpr double kWavelengthStep_nm = 2.0;
constexpr double kNmPerMm = 1e6;

double beta_squared(double energy_keV) {
  const double gamma = 1.0 + energy_keV / core::kElectronMass_keV;
  return 1.0 - 1.0 / (gamma * gamma);
}

/// Kinetic energy (keV) at which beta n = 1; infinite for n = 1.
double threshold_of(double index) {
  return core::kElectronMass_keV * (1.0 / std::sqrt(std::max(0.0, 1.0 - 1.0 / (index * index))) - 1.0);
}

/// Path length of an electron that slows down from an energy to the start of the table, and the integral of
/// 1 / beta^2 along it.
struct Slowing {
  std::vector<double> energies_keV, path_mm, path_over_beta2_mm;

  Slowing(const ElectronStopping& stopping, double from_keV, double to_keV) {
    const auto steps =
        static_cast<std::size_t>(std::ceil(std::log(to_keV / from_keV) / std::log(kEnergyStep)));
    double last_path = 0.0, last_over = 0.0;
    for (std::size_t i = 0; i <= steps; ++i) {
      const double energy_keV =
          from_keV * std::pow(to_keV / from_keV, static_cast<double>(i) / static_cast<double>(steps));
      const double path = 1.0 / stopping.keV_per_mm(energy_keV), over = path / beta_squared(energy_keV);
      const double half = i == 0 ? 0.0 : 0.5 * (energy_keV - energies_keV.back());
      path_mm.push_back(i == 0 ? 0.0 : path_mm.back() + half * (path + last_path));
      path_over_beta2_mm.push_back(i == 0 ? 0.0 : path_over_beta2_mm.back() + half * (over + last_over));
      energies_keV.push_back(energy_keV);
      last_path = path;
      last_over = over;
    }
  }
};

}  // namespace

void check_cherenkov_range(const optics::Medium& medium, double low_nm, double high_nm) {
  if (!(low_nm > 0.0 && high_nm > low_nm))
    throw core::InputError({{},
                            fmt::format("Cherenkov light from {:g} to {:g} nm is asked for", low_nm, high_nm),
                            "give two positive wavelengths, the smaller first"});
  if (!medium.index.covers(low_nm, high_nm))
    throw core::InputError(
        {{},
         fmt::format("medium \"{}\" has refractive indices from {:g} to {:g} nm, but Cherenkov "
                     "light from {:g} to {:g} nm is asked for",
                     medium.name, medium.index.x().front(), medium.index.x().back(), low_nm, high_nm),
         "extend its index table, or ask for fewer wavelengths"});
}

CherenkovEmitter::CherenkovEmitter(const optics::Medium& medium, double low_nm, double high_nm) {
  if (medium.composition.empty())
    throw core::InputError(
        {{},
         "medium \"" + medium.name +
             "\" does not say what it is made of, so the path of electrons in it is not known",
         "add [composition] and [density] to its definition"});
  check_cherenkov_range(medium, low_nm, high_nm);

  const auto steps = static_cast<std::size_t>(std::ceil((high_nm - low_nm) / kWavelengthStep_nm));
  std::vector<double> wavelengths_nm, indices;
  for (std::size_t i = 0; i <= steps; ++i) {
    wavelengths_nm.push_back(low_nm +
                             (high_nm - low_nm) * static_cast<double>(i) / static_cast<double>(steps));
    indices.push_back(medium.index(wavelengths_nm.back()));
  }
  threshold_keV_ = threshold_of(*std::max_element(indices.begin(), indices.end()));
  if (!(threshold_keV_ < kGreatestEnergy_keV)) return;

  const Slowing slowing(ElectronStopping(medium.composition, medium.density_g_per_cm3), threshold_keV_,
                        kGreatestEnergy_keV);
  const core::Curve path(slowing.energies_keV, slowing.path_mm);
  const core::Curve path_over_beta2(slowing.energies_keV, slowing.path_over_beta2_mm);
  energies_keV_ = slowing.energies_keV;
  for (std::size_t k = 0; k < energies_keV_.size(); ++k) {
    std::vector<double> density;  // photons per nm
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const double n2 = indices[i] * indices[i];
      const double from_keV = threshold_of(indices[i]);
      const double path_mm = slowing.path_mm[k] - path(from_keV);
      const double over_mm = slowing.path_over_beta2_mm[k] - path_over_beta2(from_keV);
      const bool above = energies_keV_[k] > from_keV;
      density.push_back(above ? core::kTwoPi * kFineStructure * kNmPerMm /
                                    (wavelengths_nm[i] * wavelengths_nm[i]) *
                                    std::max(0.0, path_mm - over_mm / n2)
                              : 0.0);
    }
    double photons = 0.0;
    for (std::size_t i = 1; i < density.size(); ++i)
      photons += 0.5 * (density[i] + density[i - 1]) * (wavelengths_nm[i] - wavelengths_nm[i - 1]);
    photons_.push_back(photons);
    spectra_.emplace_back();
    if (photons > 0.0) spectra_.back().emplace(core::Curve(wavelengths_nm, std::move(density)));
  }
}

CherenkovEmitter::Place CherenkovEmitter::place(double energy_keV) const {
  const auto above = std::upper_bound(energies_keV_.begin() + 1, energies_keV_.end() - 1, energy_keV);
  const auto node = static_cast<std::size_t>(above - energies_keV_.begin()) - 1;
  const double share = (energy_keV - energies_keV_[node]) / (energies_keV_[node + 1] - energies_keV_[node]);
  return {node, std::clamp(share, 0.0, 1.0)};
}

double CherenkovEmitter::mean_photons(double energy_keV) const {
  if (!(energy_keV > threshold_keV_) || energies_keV_.empty()) return 0.0;
  const Place at = place(energy_keV);
  return photons_[at.node] + at.share * (photons_[at.node + 1] - photons_[at.node]);
}

double CherenkovEmitter::sample_wavelength(double energy_keV, core::Rng& rng) const {
  const double mean = mean_photons(energy_keV);
  if (!(mean > 0.0)) throw core::InternalError("a wavelength of Cherenkov light that there is none of");
  const Place at = place(energy_keV);
  // The spectrum between two energies is their weighted sum, as the number is.
  const bool upper = rng.uniform() * mean < at.share * photons_[at.node + 1];
  return spectra_[at.node + (upper ? 1 : 0)]->sample(rng.uniform());
}

}  // namespace scintray::source
