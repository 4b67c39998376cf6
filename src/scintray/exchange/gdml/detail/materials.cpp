#include "scintray/exchange/gdml/detail/optical.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "scintray/core/units.hpp"

namespace scintray::exchange::gdml {

namespace {

class MaterialImporter {
 public:
  explicit MaterialImporter(const OpticalTables& tables)
      : tables_(tables),
        file_(tables.file()),
        definitions_(tables.definitions()),
        substances_(definitions_) {}

  std::vector<ImportedMedium> import() {
    std::vector<Node> materials;
    definitions_.for_each_of("materials", [&](Node node) {
      if (std::string(node.name()) == "material") materials.push_back(node);
    });
    std::vector<ImportedMedium> media;
    for (const Node material : materials) {
      const std::string name = definitions_.name(file_.required(material, "name"), material);
      const auto first = std::find_if(media.begin(), media.end(),
                                      [&](const ImportedMedium& known) { return known.material == name; });
      if (first == media.end())
        media.push_back(import_one(material, name));
      else
        first->notes.push_back("a second material of this name: the first is used, as in Geant4");
    }
    return media;
  }

 private:
  EnergyTable table(Node material, const std::string& name) const { return tables_.property(material, name); }
  std::optional<double> constant(Node material, std::initializer_list<std::string> names) const {
    return tables_.constant(material, names);
  }
  std::string curve(const EnergyTable& values, const char* unit) const {
    return curve_toml(values, unit, tables_.low_nm(), tables_.high_nm());
  }

  ImportedMedium import_one(Node material, const std::string& name) {
    ImportedMedium medium;
    medium.material = name;
    const EnergyTable index = table(material, "RINDEX");
    medium.opaque = index.empty();
    if (medium.opaque) return medium;
    medium.problem = problem_of(material, index);
    if (medium.problem) return medium;
    medium.index = "index = { n = " + curve(index, "") + group_index(material, medium) + " }\n";
    EnergyTable rayleigh = table(material, "RAYLEIGH");
    if (rayleigh.empty()) rayleigh = density_fluctuations(material, name, index);
    for (const EnergyTable& lengths : {rayleigh, table(material, "ABSLENGTH"), table(material, "MIEHG"),
                                       table(material, "WLSABSLENGTH"), table(material, "WLSABSLENGTH2")})
      for (const double length : lengths.value) medium.shortest_mm = std::min(medium.shortest_mm, length);
    medium.toml = medium.index + absorption(material, medium);
    medium.toml += rayleigh.empty()
                       ? "scattering = { none = true }\n"
                       : "scattering = { kind = \"rayleigh\", length = " + curve(rayleigh, "mm") + " }\n";
    if (const Node density = material.child("D")) {
      const double unit = definitions_.number(density, "unit", definitions_.evaluate("g/cm3", density));
      const double value =
          definitions_.number(density, "value") * unit / definitions_.evaluate("g/cm3", density);
      medium.toml += fmt::format("density = {{ value = \"{:.9g} g/cm3\" }}\n", value);
    }
    add_particles(material, medium);
    add_composition(material, medium);
    add_scintillation(tables_, material, medium);
    note_others(material, medium);
    return medium;
  }

  /// Why a medium cannot have this index, if it cannot: no energy is one of light (a matrix without units is
  /// in MeV), or a value is none of a medium in a scene.
  std::optional<core::Problem> problem_of(Node material, const EnergyTable& index) const {
    const core::FileLocation where =
        file_.where(material.find_child_by_attribute("property", "name", "RINDEX"));
    const auto [low, high] = std::minmax_element(index.value.begin(), index.value.end());
    constexpr double kGreatest = 5.0;
    if (*low < 1.0 || *high > kGreatest)
      return core::Problem{
          where,
          fmt::format(
              "the RINDEX of material \"{}\" runs from {:g} to {:g}, where an index lies between 1 and 5",
              material.attribute("name").value(), *low, *high),
          "check its matrix, whose second column holds indices; --medium MATERIAL=DATABASE_MEDIUM replaces "
          "the "
          "material"};
    constexpr double kLowest_eV = 0.0124, kHighest_eV = 124.0;  // 100 um to 10 nm
    const bool of_light = std::any_of(index.energy_eV.begin(), index.energy_eV.end(), [](double energy_eV) {
      return energy_eV >= kLowest_eV && energy_eV <= kHighest_eV;
    });
    if (of_light || index.value.size() < 2) return std::nullopt;
    return core::Problem{
        where,
        fmt::format(
            "the RINDEX of material \"{}\" is at {:.4g} eV to {:.4g} eV, where light has 0.0124 eV to 124 eV",
            material.attribute("name").value(), index.energy_eV.front(), index.energy_eV.back()),
        "an energy without a unit is in MeV: write 3.1*eV in the matrix"};
  }

  /// Lengths of Rayleigh scattering (mm) that Geant4 computes without a RAYLEIGH, for a material called
  /// "Water" or with an isothermal compressibility (G4OpRayleigh::CalculateRayleighMeanFreePaths of Geant4
  /// 11, read): scattering by fluctuations of the density, at the photon energies of the index; empty for
  /// other materials.
  EnergyTable density_fluctuations(Node material, const std::string& name, const EnergyTable& index) const {
    constexpr double kBoltzmann_MeV_per_K = 8.617333262e-11;  // CODATA 2018
    const bool water = name == "Water";
    // 7.658e-23 m3/MeV at 10 deg Celsius, Geant4's numbers for water.
    const std::optional<double> compressibility =
        water ? std::optional(7.658e-23 * 1e9) : constant(material, {"ISOTHERMAL_COMPRESSIBILITY"});
    if (!compressibility || index.value.size() < 2) return {};
    double temperature_K = 283.15;
    if (!water) {
      const Node stated = material.child("T");
      constexpr double kNormal_K = 293.15;  // Geant4's NTP_Temperature
      temperature_K = stated ? definitions_.number(stated, "value") : kNormal_K;
    }
    const double strength = constant(material, {"RS_SCALE_FACTOR"}).value_or(1.0) * *compressibility *
                            temperature_K * kBoltzmann_MeV_per_K / (6.0 * core::kPi);
    EnergyTable lengths;
    for (const double energy_eV : refined(index.energy_eV)) {
      const double n2 = std::pow(interpolated(index, energy_eV), 2);
      const double wave_number = core::kTwoPi * energy_eV / (core::kHc_eV_nm * 1e-6);  // 1/mm
      const double contrast = (n2 - 1.0) * (n2 + 2.0) / 3.0;
      const double per_mm = strength * std::pow(wave_number, 4) * contrast * contrast;
      if (!(per_mm > 0.0)) continue;
      lengths.energy_eV.push_back(energy_eV);
      lengths.value.push_back(1.0 / per_mm);
    }
    return lengths;
  }

  /// The group index of a GROUPVEL; Geant4 computes its own from RINDEX when that comes later.
  std::string group_index(Node material, ImportedMedium& medium) const {
    EnergyTable group = table(material, "GROUPVEL");
    if (group.empty()) return "";
    if (!OpticalTables::in_order(material, "RINDEX", "GROUPVEL")) {
      medium.notes.push_back(
          "its GROUPVEL, which comes before RINDEX: Geant4 replaces it by what follows from RINDEX, as it is "
          "here");
      return "";
    }
    for (double& value : group.value) {
      if (!(value > 0.0)) file_.reject(material, "a GROUPVEL that is not above 0", "give it in mm/ns");
      value = std::max(1.0, core::kSpeedOfLight_mm_per_ns / value);
    }
    return ", group = " + curve(group, "");
  }

  /// The names of the properties of one of Geant4's two wavelength shifters.
  struct ShifterNames {
    std::string length, component, time, photons;
  };
  static ShifterNames shifter_names(const std::string& number) {
    return {"WLSABSLENGTH" + number, "WLSCOMPONENT" + number, "WLSTIMECONSTANT" + number,
            "WLSMEANNUMBERPHOTONS" + number};
  }

  /// Absorption, and the wavelength shifters beside it. A shifter without a spectrum absorbs for good.
  std::string absorption(Node material, ImportedMedium& medium) const {
    const EnergyTable plain = table(material, "ABSLENGTH");
    std::vector<EnergyTable> for_good;
    if (!plain.empty()) for_good.push_back(plain);
    std::string shifters;
    for (const char* number : {"", "2"}) {
      const ShifterNames names = shifter_names(number);
      const EnergyTable lengths = table(material, names.length), spectrum = table(material, names.component);
      if (!lengths.empty() && spectrum.value.size() > 1 && integral(spectrum) > 0.0) {
        shifters += (shifters.empty() ? "" : ", ") + shifter(material, names, medium);
      } else if (!lengths.empty()) {
        medium.notes.push_back("its " + names.length + " has no " + names.component +
                               ": as in Geant4 the light is absorbed and not re-emitted");
        for_good.push_back(lengths);
      } else if (!spectrum.empty()) {
        medium.notes.push_back("its " + names.component + " has no " + names.length +
                               ": as in Geant4 nothing is shifted");
      }
    }
    const std::string own = for_good.empty() ? "absorption = { none = true }\n"
                            : for_good.size() == 1 && !plain.empty()
                                ? "absorption = { length = " + curve(positive(plain), "mm") + " }\n"
                                : "absorption = { coefficient = " + curve(sum_of(for_good), "1/mm") + " }\n";
    return shifters.empty() ? own : own + "wavelength_shifting = [" + shifters + "]\n";
  }

  /// Lengths, none below a thousandth of a nanometre: Geant4 takes 0 as absorbed at once. It interpolates
  /// lengths, a curve here their inverses: where neighbours differ by a factor, points are added so that two
  /// of them differ by 25 % at most, between which the inverses agree within 0.7 %.
  static EnergyTable positive(const EnergyTable& lengths) {
    constexpr double kRatio = 1.25, kShortest_mm = 1e-9, kClosest = 1e-7;
    EnergyTable fine;
    const auto add = [&](double energy_eV, double length_mm) {
      fine.energy_eV.push_back(energy_eV);
      fine.value.push_back(length_mm);
    };
    for (std::size_t i = 0; i < lengths.value.size(); ++i) {
      const double length = std::max(lengths.value[i], kShortest_mm);
      if (i > 0) {
        const double low_eV = lengths.energy_eV[i - 1], before = fine.value.back();
        const double span_eV = lengths.energy_eV[i] - low_eV;
        const double pieces = std::ceil(std::abs(std::log(length / before)) / std::log(kRatio));
        for (double piece = 1.0; piece < pieces; ++piece) {
          const double between = before * std::pow(length / before, piece / pieces);
          const double energy_eV = low_eV + span_eV * (between - before) / (length - before);
          if (energy_eV > fine.energy_eV.back() * (1.0 + kClosest) &&
              energy_eV * (1.0 + kClosest) < lengths.energy_eV[i])
            add(energy_eV, between);
        }
      }
      add(lengths.energy_eV[i], length);
    }
    return fine;
  }

  /// Sum of the coefficients of several absorptions.
  static EnergyTable sum_of(const std::vector<EnergyTable>& all) {
    EnergyTable sum;
    std::set<double> energies;
    for (const EnergyTable& lengths : all)
      energies.insert(lengths.energy_eV.begin(), lengths.energy_eV.end());
    sum.energy_eV = refined({energies.begin(), energies.end()});
    for (const double energy : sum.energy_eV) {
      double coefficient = 0.0;
      for (const EnergyTable& lengths : all) coefficient += 1.0 / std::max(1e-9, value_at(lengths, energy));
      sum.value.push_back(coefficient);
    }
    return sum;
  }

  /// One element of wavelength_shifting. Geant4 re-emits exactly one photon without a mean number, and a
  /// Poisson number with one (G4OpWLS::PostStepDoIt); its time profile is set in macros, by default "delta".
  std::string shifter(Node material, const ShifterNames& names, ImportedMedium& medium) const {
    const std::optional<double> photons = constant(material, {names.photons});
    const double time_ns = constant(material, {names.time}).value_or(0.0);
    if (photons && *photons < 0.0)
      file_.reject(material, "a " + names.photons + " below 0", "give a mean number of photons");
    if (time_ns > 0.0)
      medium.notes.push_back(names.time +
                             ": every photon is delayed by it, Geant4's default; where a macro sets "
                             "setTimeProfile exponential, remove profile = \"delta\" from its decay");
    constexpr double kAtOnce_ns = 1e-6;
    return "{ absorption = { length = " + curve(positive(table(material, names.length)), "mm") +
           " }, quantum_yield = { value = " +
           (photons ? fmt::format("{:.9g}, statistics = \"poisson\"", *photons) : "1") +
           " }, emission = { spectrum = " +
           curve_toml(per_wavelength(table(material, names.component)), "", 0.0, 0.0) +
           " }, decay = [{ time = \"" + fmt::format("{:.9g}", std::max(time_ns, kAtOnce_ns)) +
           " ns\", rise = \"0 ns\", fraction = 1, profile = \"delta\" }] }";
  }

  void add_particles(Node material, ImportedMedium& medium) const {
    const EnergyTable lengths = table(material, "MIEHG");
    if (lengths.empty()) return;
    const double limit = 1.0 - 1e-9;
    const auto lobe = [&](const char* name) {
      return std::clamp(constant(material, {name}).value_or(0.0), -limit, limit);
    };
    medium.toml +=
        "particles = { length = " + curve(positive(lengths), "mm") +
        fmt::format(", forward = {:.9g}, backward = {:.9g}, forward_share = {:.9g} }}\n",
                    lobe("MIEHG_FORWARD"), lobe("MIEHG_BACKWARD"),
                    std::clamp(constant(material, {"MIEHG_FORWARD_RATIO"}).value_or(0.0), 0.0, 1.0));
  }

  void add_composition(Node material, ImportedMedium& medium) const {
    const std::string list = substances_.mass_fractions(material);
    if (list.empty() || !material.child("D")) {
      if (!material.child("fraction") && !material.child("composite") && !material.attribute("Z")) return;
      medium.notes.push_back("its composition or density, which gammas need, is not stated in full");
      return;
    }
    medium.toml += "composition = { mass_fractions = { " + list + " } }\n";
  }

  void note_others(Node material, ImportedMedium& medium) const {
    static const std::set<std::string> carried{"RINDEX",
                                               "ABSLENGTH",
                                               "RAYLEIGH",
                                               "GROUPVEL",
                                               "FASTCOMPONENT",
                                               "SLOWCOMPONENT",
                                               "FASTTIMECONSTANT",
                                               "SLOWTIMECONSTANT",
                                               "YIELDRATIO",
                                               "WLSABSLENGTH",
                                               "WLSCOMPONENT",
                                               "WLSTIMECONSTANT",
                                               "WLSMEANNUMBERPHOTONS",
                                               "WLSABSLENGTH2",
                                               "WLSCOMPONENT2",
                                               "WLSTIMECONSTANT2",
                                               "WLSMEANNUMBERPHOTONS2",
                                               "RESOLUTIONSCALE",
                                               "ISOTHERMAL_COMPRESSIBILITY",
                                               "RS_SCALE_FACTOR",
                                               "MIEHG",
                                               "MIEHG_FORWARD",
                                               "MIEHG_BACKWARD",
                                               "MIEHG_FORWARD_RATIO"};
    std::string others;
    for (const Node child : material.children("property")) {
      const std::string name = child.attribute("name").value();
      const bool scintillation = name.find("SCINTILLATION") != std::string::npos;
      if (!scintillation && !carried.contains(name)) others += (others.empty() ? "" : ", ") + name;
    }
    if (!others.empty()) medium.notes.push_back("properties that have no counterpart here: " + others);
    std::string without;
    for (const std::string& name : tables_.passed_over(material))
      without += (without.empty() ? "" : ", ") + name;
    if (!without.empty())
      medium.notes.push_back("properties without \"ref\", which Geant4 passes over, and so they are here: " +
                             without);
  }

  const OpticalTables& tables_;
  const GdmlFile& file_;
  const Definitions& definitions_;
  Substances substances_;
};

}  // namespace

std::vector<ImportedMedium> import_materials(const OpticalTables& tables) {
  return MaterialImporter(tables).import();
}

}  // namespace scintray::exchange::gdml
