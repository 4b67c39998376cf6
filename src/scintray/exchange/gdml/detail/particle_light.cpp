#include <fmt/format.h>

#include <array>
#include <set>

#include "scintray/core/text.hpp"
#include "scintray/core/units.hpp"
#include "scintray/exchange/gdml/detail/optical.hpp"

namespace scintray::exchange::gdml {

namespace {

constexpr std::size_t kComponents = 3;
constexpr double kEvPerKeV = 1e3;

/// A kind of particle in Geant4's names of properties and in a scene.
struct ParticleName {
  const char* geant4;
  const char* ours;
};
constexpr ParticleName kParticles[] = {{"ELECTRON", "electron"}, {"PROTON", "proton"},
                                       {"DEUTERON", "deuteron"}, {"TRITON", "triton"},
                                       {"ALPHA", "alpha"},       {"ION", "ion"}};

/// The scintillation components of a material.
struct Components {
  std::array<EnergyTable, kComponents> spectra;
  std::size_t count = 0;  ///< up to the last one with a spectrum

  Components(const OpticalTables& tables, Node material) {
    for (std::size_t i = 0; i < kComponents; ++i) {
      const EnergyTable table = tables.property(material, "SCINTILLATIONCOMPONENT" + std::to_string(i + 1));
      if (table.value.size() < 2) continue;
      spectra[i] = as_sampled(table);
      count = i + 1;
    }
  }
};

/// Shares of the components in the light of a particle: of two, the second has in Geant4 the remainder of
/// the first.
std::array<double, kComponents> shares_of(const OpticalTables& tables, Node material,
                                          const std::string& yield, std::size_t count) {
  std::array<double, kComponents> shares{};
  double sum = 0.0;
  for (std::size_t i = 0; i < kComponents; ++i) {
    shares[i] = tables.constant(material, {yield + std::to_string(i + 1)}).value_or(i == 0 ? 1.0 : 0.0);
    sum += shares[i];
  }
  for (double& share : shares) share = sum > 0.0 ? share / sum : 0.0;
  if (count == 1) return {1.0, 0.0, 0.0};
  if (count == 2) return {shares[0], 1.0 - shares[0], 0.0};
  return shares;
}

/// The sum of the spectra, each of integral 1 times its share, as one per wavelength.
EnergyTable mixture(const Components& components, const std::array<double, kComponents>& shares) {
  std::set<double> energies;
  for (const EnergyTable& spectrum : components.spectra)
    energies.insert(spectrum.energy_eV.begin(), spectrum.energy_eV.end());
  EnergyTable sum;
  for (const double energy : refined({energies.begin(), energies.end()})) {
    double density = 0.0;
    for (std::size_t i = 0; i < kComponents; ++i)
      if (const EnergyTable& spectrum = components.spectra[i]; !spectrum.empty() && integral(spectrum) > 0.0)
        density += shares[i] * interpolated(spectrum, energy) / integral(spectrum);
    sum.energy_eV.push_back(energy);
    sum.value.push_back(density * energy * energy / core::kHc_eV_nm);
  }
  return sum;
}

std::string list_of(const std::vector<double>& values, double factor) {
  return "[" +
         core::list_of(values, ", ", [&](double value) { return fmt::format("{:.9g}", factor * value); }) +
         "]";
}

}  // namespace

std::string particle_light(const OpticalTables& tables, Node material) {
  const Components components(tables, material);
  if (components.count == 0) return {};
  std::string text;
  for (const ParticleName& particle : kParticles) {
    const std::string yield = std::string(particle.geant4) + "SCINTILLATIONYIELD";
    const EnergyTable photons = tables.property(material, yield);
    if (photons.value.size() < 2) continue;
    const auto shares = shares_of(tables, material, yield, components.count);
    std::string decay;
    for (std::size_t i = 0; i < kComponents; ++i) {
      const std::string number = std::to_string(i + 1);
      const double time_ns =
          tables
              .constant(material, {particle.geant4 + ("SCINTILLATIONTIMECONSTANT" + number),
                                   "SCINTILLATIONTIMECONSTANT" + number})
              .value_or(0.0);
      const double rise_ns = tables.constant(material, {"SCINTILLATIONRISETIME" + number}).value_or(0.0);
      if (shares[i] > 0.0)
        decay += fmt::format("{}{{ time = \"{:.9g} ns\", rise = \"{:.9g} ns\", fraction = {:.12g} }}",
                             decay.empty() ? "" : ", ", time_ns, rise_ns, shares[i]);
    }
    text += fmt::format(
        "{}{{ particle = \"{}\", photons = {{ energy = {}, energy_unit = \"keV\", value = {} }}, "
        "emission = {{ spectrum = {} }}, decay = [{}] }}",
        text.empty() ? "" : ", ", particle.ours, list_of(photons.energy_eV, 1.0 / kEvPerKeV),
        list_of(photons.value, 1.0), curve_toml(mixture(components, shares), "", 0.0, 0.0), decay);
  }
  return text;
}

}  // namespace scintray::exchange::gdml
