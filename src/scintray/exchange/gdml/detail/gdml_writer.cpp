#include "scintray/exchange/gdml/detail/gdml_writer.hpp"

#include <fmt/format.h>
#include <xraylib/xraylib.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "scintray/core/error.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/core/units.hpp"

namespace scintray::exchange::gdml {

namespace {

/// The wavelengths of a range at which a curve is tabulated, upwards: its own, and others at most 2 nm apart.
std::vector<double> wavelengths(const core::Curve& curve, double low_nm, double high_nm) {
  constexpr double kStep_nm = 2.0;
  std::set<double> nm{low_nm, high_nm};
  if (!curve.is_constant()) {
    for (const double x : curve.x())
      if (x > low_nm && x < high_nm) nm.insert(x);
    const auto steps = static_cast<int>((high_nm - low_nm) / kStep_nm);
    for (int step = 1; step < steps; ++step) nm.insert(low_nm + step * kStep_nm);
  }
  return {nm.begin(), nm.end()};
}

}  // namespace

GdmlWriter::GdmlWriter(WavelengthRange range) : range_(range) {
  if (!(range.low_nm > 0.0 && range.high_nm >= range.low_nm))
    throw core::InternalError("a GDML document needs wavelengths above 0");
  // Light of one wavelength: tables need two energies.
  constexpr double kMargin = 1e-3;
  range_.low_nm *= 1.0 - kMargin;
  range_.high_nm *= 1.0 + kMargin;
  root_ = document_.append_child("gdml");
  for (const char* section : {"define", "materials", "solids", "structure", "setup"})
    root_.append_child(section);
}

std::string GdmlWriter::text() const {
  std::ostringstream stream;
  stream << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  document_.document_element().print(stream, " ");
  return stream.str();
}

void GdmlWriter::add_matrix(pugi::xml_node owner, const char* name, int columns, const std::string& values) {
  const std::string matrix_name = "m" + std::to_string(++matrices_);
  pugi::xml_node matrix = section("define").append_child("matrix");
  matrix.append_attribute("name") = matrix_name.c_str();
  matrix.append_attribute("coldim") = columns;
  matrix.append_attribute("values") = values.c_str();
  pugi::xml_node property = owner.append_child("property");
  property.append_attribute("name") = name;
  property.append_attribute("ref") = matrix_name.c_str();
}

void GdmlWriter::add_table(pugi::xml_node owner, const char* name, const core::Curve& curve,
                           const std::string& unit) {
  std::vector<double> nm = wavelengths(curve, range_.low_nm, range_.high_nm);
  std::string values;
  for (auto wavelength = nm.rbegin(); wavelength != nm.rend(); ++wavelength)
    values += fmt::format("{:.12g}*eV {:.12g}{} ", core::kHc_eV_nm / *wavelength, curve(*wavelength),
                          unit.empty() ? "" : "*" + unit);
  add_matrix(owner, name, 2, values);
}

void GdmlWriter::add_lengths(pugi::xml_node owner, const char* name, const core::Curve& per_mm) {
  constexpr double kNone_mm = 1e9;
  std::string values;
  std::vector<double> nm = wavelengths(per_mm, range_.low_nm, range_.high_nm);
  for (auto wavelength = nm.rbegin(); wavelength != nm.rend(); ++wavelength)
    values += fmt::format("{:.12g}*eV {:.12g}*mm ", core::kHc_eV_nm / *wavelength,
                          1.0 / std::max(per_mm(*wavelength), 1.0 / kNone_mm));
  add_matrix(owner, name, 2, values);
}

void GdmlWriter::add_spectrum(pugi::xml_node owner, const char* name, const core::Curve& per_nm) {
  std::vector<double> nm = wavelengths(per_nm, per_nm.x().front(), per_nm.x().back());
  std::string values;
  for (auto wavelength = nm.rbegin(); wavelength != nm.rend(); ++wavelength)
    values += fmt::format("{:.12g}*eV {:.12g} ", core::kHc_eV_nm / *wavelength,
                          per_nm(*wavelength) * *wavelength * *wavelength / core::kHc_eV_nm);
  add_matrix(owner, name, 2, values);
}

void GdmlWriter::add_number(pugi::xml_node owner, const char* name, double value, const std::string& unit) {
  add_matrix(owner, name, 1, fmt::format("{:.12g}{}", value, unit));
}

void GdmlWriter::note(const std::string& text) {
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

/// A name of the document: without blanks, brackets and quotes, and not given to anything before.
std::string GdmlWriter::new_name(const std::string& wanted) {
  std::string name;
  for (const char c : wanted) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
    name += plain ? c : '_';
  }
  const int count = ++taken_[name];
  return count == 1 ? name : name + "_" + std::to_string(count);
}

std::string GdmlWriter::material(const optics::Medium& medium, bool opaque) {
  const auto [known, is_new] = done_.try_emplace("medium " + medium.name);
  if (!is_new) return known->second;
  const std::string name = known->second = new_name(medium.name);
  // Elements come before the materials that name them.
  pugi::xml_node material = section("materials").append_child("material");
  material.append_attribute("name") = name.c_str();
  if (!opaque) {
    add_bulk(material, medium);
    add_scintillation(material, medium);
  }
  add_composition(material, medium);
  return name;
}

void GdmlWriter::add_bulk(pugi::xml_node material, const optics::Medium& medium) {
  if (medium.birefringence)
    note("medium " + medium.name +
         ": Geant4 has no birefringence: the mean index and the mean absorption of its axes are written");
  add_table(material, "RINDEX", medium.index);
  if (medium.group_index) {
    std::vector<double> velocity;
    const std::vector<double> nm = wavelengths(*medium.group_index, range_.low_nm, range_.high_nm);
    for (const double wavelength : nm)
      velocity.push_back(core::kSpeedOfLight_mm_per_ns / (*medium.group_index)(wavelength));
    add_table(material, "GROUPVEL", core::Curve(nm, velocity), "(mm/ns)");
  }
  add_lengths(material, "ABSLENGTH", medium.absorption_per_mm);
  if (medium.scattering_per_mm.max_y() > 0.0 && medium.scattering == optics::ScatteringKind::rayleigh)
    add_lengths(material, "RAYLEIGH", medium.scattering_per_mm);
  const bool isotropic =
      medium.scattering_per_mm.max_y() > 0.0 && medium.scattering == optics::ScatteringKind::isotropic;
  if (isotropic && medium.particles)
    note("medium " + medium.name +
         ": isotropic scattering beside particles: left out, light is scattered less");
  if (medium.particles || isotropic) {
    const auto particles = medium.particles.value_or(optics::ParticleScattering{medium.scattering_per_mm});
    add_lengths(material, "MIEHG", particles.per_mm);
    add_number(material, "MIEHG_FORWARD", particles.forward_g);
    add_number(material, "MIEHG_BACKWARD", particles.backward_g);
    add_number(material, "MIEHG_FORWARD_RATIO", particles.forward_share);
  }
  if (medium.shifter) add_shifters(material, medium);
}

void GdmlWriter::add_shifters(pugi::xml_node material, const optics::Medium& medium) {
  constexpr std::size_t kMostShifters = 2;
  const std::vector<optics::Fluorophore>& all = medium.shifter->fluorophores();
  const std::string of = "medium " + medium.name + ": ";
  if (all.size() > kMostShifters)
    note(of + "Geant4 has two wavelength shifters: the first two are written, and less light is shifted");
  for (std::size_t i = 0; i < std::min(all.size(), kMostShifters); ++i) {
    const optics::Fluorophore& one = all[i];
    const std::string number = i == 0 ? "" : "2";
    const auto key = [&](const char* name) { return name + number; };
    add_lengths(material, key("WLSABSLENGTH").c_str(), one.absorption_per_mm);
    add_spectrum(material, key("WLSCOMPONENT").c_str(), one.emission);
    const double low = one.quantum_yield.min_y(), high = one.quantum_yield.max_y();
    // Without a mean number Geant4 re-emits one photon for each that is absorbed.
    const bool one_each = one.statistics == optics::ShiftStatistics::single && low == 1.0;
    if (!one_each) add_number(material, key("WLSMEANNUMBERPHOTONS").c_str(), high);
    if (low < high)
      note(of +
           "the quantum yield of its shifter varies; Geant4 has one number: its largest is written, and "
           "more light is re-emitted");
    if (!one_each && one.statistics == optics::ShiftStatistics::single)
      note(of +
           "Geant4 draws the number of re-emitted photons from a Poisson distribution: the mean is the "
           "same, and some photons become several");
    if (one.rule == optics::ShiftRule::kasha)
      note(of +
           "its shifter emits the whole spectrum (Kasha's rule); Geant4 keeps to energies below that of "
           "the absorbed photon");
  }
  note(of +
       "the decay times of its shifter are left out (WLSTIMECONSTANT): shifted light is emitted at once");
}

void GdmlWriter::add_scintillation(pugi::xml_node material, const optics::Medium& medium) {
  if (!(medium.yield_per_keV > 0.0) || medium.decay.empty()) return;
  constexpr std::size_t kMostComponents = 3;
  std::vector<optics::DecayComponent> parts = medium.decay;
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.fraction > b.fraction; });
  if (parts.size() > kMostComponents) {
    note("medium " + medium.name + ": Geant4 has three scintillation components: the strongest are written");
    parts.resize(kMostComponents);
  }
  add_number(material, "SCINTILLATIONYIELD", 1000.0 * medium.yield_per_keV, "/MeV");
  // Geant4's width R sqrt(N), with R^2 - 1 = s^2 N: both grow as the root of the energy.
  add_number(material, "RESOLUTIONSCALE",
             std::sqrt(1.0 + std::pow(medium.intrinsic_fwhm / core::kFwhmPerSigma, 2) * medium.yield_per_keV *
                                 medium.intrinsic_keV));
  if (!medium.by_particle.empty())
    note("medium " + medium.name +
         ": its light by particle is left out: every particle has that of electrons");
  if (medium.birks_mm_per_keV > 0.0)
    note("medium " + medium.name + ": Birks' law is left out: light is proportional to energy");
  if (!medium.relative_yield.is_constant())
    note("medium " + medium.name + ": its non-proportionality is left out: light is proportional to energy");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    add_spectrum(material, ("SCINTILLATIONCOMPONENT" + number).c_str(), medium.emission);
    add_number(material, ("SCINTILLATIONTIMECONSTANT" + number).c_str(), parts[i].decay_ns, "*ns");
    add_number(material, ("SCINTILLATIONRISETIME" + number).c_str(), parts[i].rise_ns, "*ns");
    add_number(material, ("SCINTILLATIONYIELD" + number).c_str(), parts[i].fraction);
  }
}

void GdmlWriter::add_composition(pugi::xml_node material, const optics::Medium& medium) {
  // Geant4 requires a density and elements of every material.
  const bool stated = !medium.composition.empty() && medium.density_g_per_cm3 > 0.0;
  constexpr double kEmpty = 1e-25;  // Geant4's universe_mean_density, in g/cm3
  const auto composition = stated ? medium.composition : optics::Composition{{1, 1.0}};
  pugi::xml_node density = material.append_child("D");
  density.append_attribute("value") =
      fmt::format("{:.9g}", stated ? medium.density_g_per_cm3 : kEmpty).c_str();
  density.append_attribute("unit") = "g/cm3";
  if (!stated && !medium.empty_space)
    note("medium " + medium.name +
         " has no density and composition: written as empty space, which gammas pass; light is not affected");
  for (const optics::ElementShare& share : composition) {
    std::string& element = elements_[share.atomic_number];
    if (element.empty()) {
      element = new_name(optics::element_symbol(share.atomic_number));
      pugi::xml_node node = section("materials").prepend_child("element");
      node.append_attribute("name") = element.c_str();
      node.append_attribute("formula") = optics::element_symbol(share.atomic_number).c_str();
      node.append_attribute("Z") = share.atomic_number;
      node.append_child("atom").append_attribute("value") =
          fmt::format("{:.9g}", AtomicWeight(share.atomic_number, nullptr)).c_str();
    }
    pugi::xml_node fraction = material.append_child("fraction");
    fraction.append_attribute("n") = fmt::format("{:.12g}", share.mass_fraction).c_str();
    fraction.append_attribute("ref") = element.c_str();
  }
}

}  // namespace scintray::exchange::gdml
