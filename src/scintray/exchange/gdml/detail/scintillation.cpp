#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scintray/core/statistics.hpp"
#include "scintray/core/units.hpp"
#include "scintray/exchange/gdml/detail/optical.hpp"

namespace scintray::exchange::gdml {

namespace {

class ScintillationImporter {
 public:
  explicit ScintillationImporter(const OpticalTables& tables) : tables_(tables) {}

  void add(Node material, ImportedMedium& medium) const {
    std::optional<double> yield = constant(material, {"SCINTILLATIONYIELD"});
    const std::string by_particle = particle_light(tables_, material);
    if (const EnergyTable light = table(material, "ELECTRONSCINTILLATIONYIELD"); !yield && !light.empty())
      yield = 1e6 * (light.value.back() - light.value.front()) / light.energy_eV.back();
    if (!yield || *yield <= 0.0) return;
    std::vector<Component> parts = components(material);
    double shares = 0.0;
    bool complete = !parts.empty();
    for (const Component& part : parts) {
      shares += part.share;
      complete &= part.decay_ns > 0.0 && integral(part.spectrum) > 0.0;
    }
    if (!complete) {
      medium.notes.push_back("its scintillation: a component, a time constant or a yield is missing or zero");
      return;
    }
    EnergyTable emission;
    std::set<double> energies;
    for (Component& part : parts) {
      part.spectrum = as_sampled(part.spectrum);
      energies.insert(part.spectrum.energy_eV.begin(), part.spectrum.energy_eV.end());
    }
    for (const double energy : refined({energies.begin(), energies.end()})) {
      double density = 0.0;
      for (const Component& part : parts)
        density += part.share / shares * interpolated(part.spectrum, energy) / integral(part.spectrum);
      emission.energy_eV.push_back(energy);
      emission.value.push_back(density * energy * energy / core::kHc_eV_nm);
    }
    medium.scintillates = true;
    medium.toml += fmt::format("yield = {{ value = \"{:.9g} photons/MeV\" }}\n", *yield);
    add_resolution(material, *yield, medium);
    if (different_spectra(parts))
      medium.notes.push_back(
          "its components have spectra of their own: they are one spectrum here, in their shares, of which "
          "time and wavelength of a photon are drawn independently");
    medium.toml += "emission = { spectrum = " + curve_toml(emission, "", 0.0, 0.0) + " }\n";
    medium.toml += "decay = [";
    for (std::size_t i = 0; i < parts.size(); ++i)
      medium.toml +=
          fmt::format("{}{{ time = \"{:.9g} ns\", rise = \"{:.9g} ns\", fraction = {:.12g} }}",
                      i == 0 ? "" : ", ", parts[i].decay_ns, parts[i].rise_ns, parts[i].share / shares);
    medium.toml += "]\n";
    if (by_particle.empty()) return;
    medium.toml += "particle_light = [" + by_particle + "]\n";
    medium.notes.push_back("its light by particle, which Geant4 uses after setByParticleType true alone");
  }

 private:
  struct Component {
    EnergyTable spectrum;
    double share = 0.0, decay_ns = 0.0, rise_ns = 0.0;
  };

  EnergyTable table(Node material, const std::string& name) const { return tables_.property(material, name); }
  std::optional<double> constant(Node material, std::initializer_list<std::string> names) const {
    return tables_.constant(material, names);
  }

  std::vector<Component> components(Node material) const {
    std::vector<Component> found;
    const char* old_spectra[] = {"FASTCOMPONENT", "SLOWCOMPONENT", ""};
    const char* old_times[] = {"FASTTIMECONSTANT", "SLOWTIMECONSTANT", ""};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string number = std::to_string(i + 1);
      Component component;
      component.spectrum = table(material, "SCINTILLATIONCOMPONENT" + number);
      if (component.spectrum.empty() && *old_spectra[i]) component.spectrum = table(material, old_spectra[i]);
      if (component.spectrum.value.size() < 2) continue;
      component.decay_ns =
          constant(material, {"SCINTILLATIONTIMECONSTANT" + number, old_times[i]}).value_or(0.0);
      component.rise_ns = constant(material, {"SCINTILLATIONRISETIME" + number}).value_or(0.0);
      const std::optional<double> share = constant(material, {"SCINTILLATIONYIELD" + number});
      const std::optional<double> ratio = constant(material, {"YIELDRATIO"});
      component.share = share   ? *share
                        : ratio ? (i == 0 ? *ratio : 1.0 - *ratio)
                                : (i == 0 ? 1.0 : 0.0);  // Geant4's defaults: YIELD1 = 1, others 0
      if (component.share > 0.0) found.push_back(std::move(component));
    }
    return found;
  }

  /// RESOLUTIONSCALE: Geant4's number of photons N = Y E has the width R sqrt(N), here the square of the
  /// width is N + (s N)^2 with s^2 = (R^2 - 1) / N at an energy, and inversely proportional to the energy.
  void add_resolution(Node material, double yield_per_MeV, ImportedMedium& medium) const {
    const std::optional<double> scale = constant(material, {"RESOLUTIONSCALE"});
    if (!scale || *scale == 1.0) return;
    if (*scale < 1.0) {
      medium.notes.push_back(fmt::format(
          "its RESOLUTIONSCALE of {:.4g}: the number of photons has a width of its root at least, that of 1",
          *scale));
      return;
    }
    constexpr double kEnergy_keV = 511.0;
    const double share =
        core::kFwhmPerSigma * std::sqrt((*scale * *scale - 1.0) / (1e-3 * yield_per_MeV * kEnergy_keV));
    if (share >= 1.0) {
      medium.notes.push_back(fmt::format(
          "its RESOLUTIONSCALE of {:.4g}, a width at 511 keV beyond the energy itself: left out", *scale));
      return;
    }
    medium.toml += fmt::format("intrinsic_resolution = {{ fwhm = {:.9g}, energy = \"{:.4g} keV\" }}\n", share,
                               kEnergy_keV);
  }

  /// Whether components, as they are sampled, differ by more than a factor.
  static bool different_spectra(const std::vector<Component>& parts) {
    constexpr double kSame = 1e-3;
    const EnergyTable& first = parts.front().spectrum;
    return std::any_of(parts.begin() + 1, parts.end(), [&first](const Component& part) {
      const double scale = integral(part.spectrum) / integral(first);
      return std::any_of(first.energy_eV.begin(), first.energy_eV.end(), [&](double energy_eV) {
        const double expected = scale * interpolated(first, energy_eV);
        return std::abs(interpolated(part.spectrum, energy_eV) - expected) >
               kSame * std::max(expected, integral(part.spectrum));
      });
    });
  }

  const OpticalTables& tables_;
};

}  // namespace

void add_scintillation(const OpticalTables& tables, Node material, ImportedMedium& medium) {
  ScintillationImporter(tables).add(material, medium);
}

}  // namespace scintray::exchange::gdml
