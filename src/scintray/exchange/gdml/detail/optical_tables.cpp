#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "scintray/core/text.hpp"
#include "scintray/core/units.hpp"
#include "scintray/exchange/gdml/detail/optical.hpp"

namespace scintray::exchange::gdml {

namespace {

constexpr double kMeV_eV = 1e6;

/// The <property> of this name; empty when there is none.
Node property_node(Node owner, const std::string& name) {
  return owner.find_child([&](Node child) {
    return std::string(child.name()) == "property" && name == child.attribute("name").value();
  });
}

/// One row of a table: nm, value.
std::string toml_array(const std::vector<double>& values) {
  return "[" + core::list_of(values, ", ", [](double value) { return fmt::format("{:.9g}", value); }) + "]";
}

/// True for a property over the energy of a particle rather than of a photon.
bool is_of_particles(const std::string& name) {
  return name.ends_with("SCINTILLATIONYIELD") && name != "SCINTILLATIONYIELD";
}

}  // namespace

double interpolated(const EnergyTable& table, double energy_eV) {
  const auto &x = table.energy_eV, &y = table.value;
  if (energy_eV < x.front() || energy_eV > x.back()) return 0.0;
  const auto above = std::lower_bound(x.begin(), x.end(), energy_eV);
  const auto i = static_cast<std::size_t>(above - x.begin());
  if (i == 0 || *above == energy_eV) return y[i];
  return y[i - 1] + (y[i] - y[i - 1]) * (energy_eV - x[i - 1]) / (x[i] - x[i - 1]);
}

std::vector<double> refined(const std::vector<double>& energy_eV) {
  constexpr double kStep = 0.02;
  std::vector<double> fine;
  for (std::size_t i = 0; i + 1 < energy_eV.size(); ++i) {
    const double low = energy_eV[i], high = energy_eV[i + 1];
    const double pieces = std::max(1.0, std::ceil(std::log(high / low) / kStep));
    for (double piece = 0.0; piece < pieces; ++piece) fine.push_back(low + (high - low) * piece / pieces);
  }
  fine.push_back(energy_eV.back());
  return fine;
}

double value_at(const EnergyTable& table, double energy_eV) {
  if (energy_eV <= table.energy_eV.front()) return table.value.front();
  if (energy_eV >= table.energy_eV.back()) return table.value.back();
  return interpolated(table, energy_eV);
}

double integral(const EnergyTable& table) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < table.value.size(); ++i)
    sum += 0.5 * (table.value[i] + table.value[i + 1]) * (table.energy_eV[i + 1] - table.energy_eV[i]);
  return sum;
}

EnergyTable as_sampled(const EnergyTable& table) {
  constexpr double kEdge = 1e-7;  ///< of a step between two intervals, relative to its energy
  EnergyTable steps;
  const auto add = [&](double energy_eV, double value) {
    steps.energy_eV.push_back(energy_eV);
    steps.value.push_back(value);
  };
  for (std::size_t i = 0; i + 1 < table.value.size(); ++i) {
    const double mean = std::max(0.0, 0.5 * (table.value[i] + table.value[i + 1]));
    const bool first = i == 0, last = i + 2 == table.value.size();
    const bool same = !first && mean == steps.value.back();
    if (!same) add(table.energy_eV[i] * (first ? 1.0 : 1.0 + kEdge), mean);
    if (same) steps.energy_eV.pop_back(), steps.value.pop_back();
    add(table.energy_eV[i + 1] * (last ? 1.0 : 1.0 - kEdge), mean);
  }
  return steps;
}

EnergyTable per_wavelength(const EnergyTable& table) {
  const EnergyTable spectrum = as_sampled(table);
  EnergyTable result;
  result.energy_eV = refined(spectrum.energy_eV);
  for (const double energy : result.energy_eV)
    result.value.push_back(interpolated(spectrum, energy) * energy * energy / core::kHc_eV_nm);
  return result;
}

namespace {

/// True for tables over the energy of photons: the vectors of Geant4's G4MaterialPropertiesIndex, and their
/// names before 11.0, less those over the energy of particles. Of others, which a file may have for programs
/// of its own, nothing is known.
bool is_over_photon_energy(const std::string& name) {
  static const std::set<std::string> others{"RINDEX",
                                            "REFLECTIVITY",
                                            "REALRINDEX",
                                            "IMAGINARYRINDEX",
                                            "EFFICIENCY",
                                            "TRANSMITTANCE",
                                            "SPECULARLOBECONSTANT",
                                            "SPECULARSPIKECONSTANT",
                                            "BACKSCATTERCONSTANT",
                                            "GROUPVEL",
                                            "MIEHG",
                                            "RAYLEIGH",
                                            "WLSCOMPONENT",
                                            "WLSABSLENGTH",
                                            "WLSCOMPONENT2",
                                            "WLSABSLENGTH2",
                                            "ABSLENGTH",
                                            "FASTCOMPONENT",
                                            "SLOWCOMPONENT",
                                            "COATEDRINDEX"};
  return others.contains(name) || name.starts_with("SCINTILLATIONCOMPONENT");
}

}  // namespace

OpticalTables::OpticalTables(const GdmlFile& file, const Definitions& definitions)
    : file_(file), definitions_(definitions) {
  for (const char* section : {"materials", "solids"})
    definitions_.for_each_of(section, [&](Node owner) {
      for (const Node child : owner.children("property")) {
        const std::string name = child.attribute("name").value();
        if (!is_over_photon_energy(name)) continue;
        const EnergyTable table = property(owner, name);
        if (table.value.size() < 2) continue;
        const double low = core::kHc_eV_nm / table.energy_eV.back(),
                     high = core::kHc_eV_nm / table.energy_eV.front();
        low_nm_ = low_nm_ == 0.0 ? low : std::min(low_nm_, low);
        high_nm_ = std::max(high_nm_, high);
      }
    });
}

EnergyTable OpticalTables::property(Node owner, const std::string& name) const {
  const Node node = property_node(owner, name);
  EnergyTable table;
  if (!node || !node.attribute("ref")) return table;
  const std::string reference = definitions_.name(node.attribute("ref").value(), node);
  const Matrix* matrix = definitions_.matrix(reference, node);
  if (!matrix && definitions_.constant(reference, node)) return table;
  if (!matrix) file_.reject(node, "no matrix is called \"" + reference + "\"", "define it in <define>");
  if (matrix->columns < 2) return table;
  std::vector<std::pair<double, double>> rows;
  for (std::size_t i = 0; i < matrix->values.size(); i += matrix->columns) {
    const double energy = matrix->values[i] * kMeV_eV;
    if (!(energy > 0.0) && !(energy == 0.0 && is_of_particles(name)))
      file_.reject(node, name + ": \"" + reference + "\" has an energy that is not above 0",
                   "give photon energies, as 3.1*eV; the first column holds them");
    rows.emplace_back(energy, matrix->values[i + 1]);
  }
  // Geant4 inserts each row at its place, so any order will do; rows of one energy make a step.
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  constexpr double kStep = 1e-7;
  for (const auto& [energy, value] : rows) {
    const double least = table.empty() ? 0.0 : table.energy_eV.back() * (1.0 + kStep);
    table.energy_eV.push_back(std::max(energy, least));
    table.value.push_back(value);
  }
  return table;
}

std::optional<double> OpticalTables::constant(Node owner, std::initializer_list<std::string> names) const {
  for (const std::string& name : names) {
    const Node node = property_node(owner, name);
    if (!node || !node.attribute("ref")) continue;
    const std::string reference = definitions_.name(node.attribute("ref").value(), node);
    if (const Matrix* matrix = definitions_.matrix(reference, node)) return matrix->values.front();
    return definitions_.constant(reference, node);
  }
  return std::nullopt;
}

std::vector<std::string> OpticalTables::passed_over(Node owner) const {
  std::vector<std::string> names;
  for (const Node child : owner.children("property"))
    if (!child.attribute("ref")) names.push_back(child.attribute("name").value());
  return names;
}

bool OpticalTables::in_order(Node owner, const std::string& first, const std::string& second) {
  bool seen = false;
  for (const Node child : owner.children("property")) {
    const std::string name = child.attribute("name").value();
    if (name == first) seen = true;
    if (name == second && seen) return true;
  }
  return false;
}

std::string curve_toml(const EnergyTable& table, const std::string& unit, double low_nm, double high_nm) {
  const auto quantity = [&](double value) {
    return unit.empty() ? fmt::format("{:.9g}", value) : fmt::format("\"{:.9g} {}\"", value, unit);
  };
  if (table.value.size() == 1) return quantity(table.value.front());
  const bool is_constant = std::all_of(table.value.begin(), table.value.end(),
                                       [&](double value) { return value == table.value.front(); });
  constexpr double kRounding = 1e-6;
  // A value linear in energy is curved over wavelength; a constant one is the same at its two ends.
  std::vector<double> nm, value,
      energies = is_constant ? std::vector<double>{table.energy_eV.front(), table.energy_eV.back()}
                             : refined(table.energy_eV);
  for (auto energy = energies.rbegin(); energy != energies.rend(); ++energy) {
    nm.push_back(core::kHc_eV_nm / *energy);
    value.push_back(interpolated(table, *energy));
  }
  if (low_nm > 0.0 && low_nm < nm.front() * (1.0 - kRounding)) {
    nm.insert(nm.begin(), low_nm);
    value.insert(value.begin(), value.front());
  }
  if (high_nm > nm.back() * (1.0 + kRounding)) {
    nm.push_back(high_nm);
    value.push_back(value.back());
  }
  return "{ wavelength = " + toml_array(nm) + ", wavelength_unit = \"nm\", value = " + toml_array(value) +
         (unit.empty() ? "" : ", value_unit = \"" + unit + "\"") + " }";
}

}  // namespace scintray::exchange::gdml
