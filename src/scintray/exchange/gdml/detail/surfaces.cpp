#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scintray/exchange/gdml/detail/optical.hpp"
#include "scintray/tables/geant4_finish.hpp"

namespace scintray::exchange::gdml {

namespace {

// In the order of Geant4's enumerations G4OpticalSurfaceModel, G4SurfaceType and G4OpticalSurfaceFinish
// (Book For Application Developers, section "Boundary Process").
constexpr std::array kModels{"glisur", "unified", "LUT", "DAVIS", "dichroic"};
constexpr std::array kTypes{"dielectric_metal",
                            "dielectric_dielectric",
                            "dielectric_LUT",
                            "dielectric_LUTDAVIS",
                            "dielectric_dichroic",
                            "firsov",
                            "x_ray",
                            "coated"};
constexpr std::array kFinishes{"polished", "polishedfrontpainted", "polishedbackpainted",
                               "ground",   "groundfrontpainted",   "groundbackpainted"};

/// All finishes in the order of Geant4's enumeration, those of its tables after the others.
const std::vector<std::string>& all_finishes() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all(kFinishes.begin(), kFinishes.end());
    for (const auto* tabulated : {&tables::lbnl_finishes(), &tables::davis_finishes()})
      all.insert(all.end(), tabulated->begin(), tabulated->end());
    return all;
  }();
  return names;
}

/// A word, from itself or its number.
template <typename Words>
std::string word(Node node, const char* attribute, const Words& words) {
  const std::string text = node.attribute(attribute).value();
  const bool number = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!number || text.size() > 3) return text;
  const auto index = static_cast<std::size_t>(std::stoul(text));
  return index < words.size() ? std::string(words[index]) : text;
}

/// Applies the rules of Geant4's boundary process, G4OpBoundaryProcess of release 11.4, to one surface.
class SurfaceImporter {
 public:
  SurfaceImporter(Node surface, const OpticalTables& tables)
      : surface_(surface),
        tables_(tables),
        model_(word(surface, "model", kModels)),
        type_(word(surface, "type", kTypes)),
        finish_(word(surface, "finish", all_finishes())) {}

  ImportedSurface import() {
    note_others();
    const EnergyTable efficiency = table("EFFICIENCY");
    if (most(efficiency) > 0.0) result_.efficiency = curve(shares(efficiency));
    const bool known_model = glisur() || unified();
    const bool known_finish = std::find(kFinishes.begin(), kFinishes.end(), finish_) != kFinishes.end();
    if (type_ == kTypes[7]) {
      coated();
    } else if (type_ == kTypes[2] || type_ == kTypes[3]) {
      tabulated();
    } else if (type_ == kTypes[4]) {
      dichroic();
    } else if (!known_model || !known_finish) {
      note("model \"" + model_ + "\", finish \"" + finish_ +
           "\": its table is not in the file, and its type \"" + type_ + "\" does not name one of Geant4's");
    } else if (metallic()) {
      metal();
    } else if (type_ == kTypes[1]) {
      dielectric();
    } else {
      note("type \"" + type_ + "\" has no counterpart here");
    }
    return result_;
  }

 private:
  void note(std::string text) { result_.notes.push_back(std::move(text)); }
  bool glisur() const { return model_ == kModels[0]; }
  bool unified() const { return model_ == kModels[1]; }
  bool metallic() const { return type_ == kTypes[0]; }
  EnergyTable table(const char* name) const { return tables_.property(surface_, name); }
  static double most(const EnergyTable& values) {
    return values.empty() ? 0.0 : *std::max_element(values.value.begin(), values.value.end());
  }
  static double least(const EnergyTable& values) {
    return values.empty() ? 1.0 : *std::min_element(values.value.begin(), values.value.end());
  }
  /// Lobe constants are tables over energy in Geant4 and numbers here.
  double constant(const char* name) {
    const EnergyTable values = table(name);
    if (values.empty()) return 0.0;
    if (most(values) - least(values) > 1e-6)
      note(std::string("the change of its ") + name + " over energy: the value at the lowest energy is used");
    return values.value.front();
  }
  std::string curve(const EnergyTable& values) const {
    return curve_toml(values, "", tables_.low_nm(), tables_.high_nm());
  }

  /// REFLECTIVITY; 1 when left out, except that a metal which only has an EFFICIENCY is a sensor.
  std::string reflectivity() {
    const EnergyTable values = table("REFLECTIVITY");
    if (!values.empty()) return curve(shares(values));
    if (!metallic() || result_.efficiency.empty()) return "1.0";
    note(
        "it is a metal with EFFICIENCY and without REFLECTIVITY: taken as a sensor that reflects nothing, as "
        "GPU codes that read such files do. Geant4 takes REFLECTIVITY as 1, reflects all light, and detects "
        "none");
    return "0.0";
  }

  /// REFLECTIVITY and TRANSMITTANCE as Geant4 applies them before anything else; empty when all light is
  /// admitted.
  std::string admission() {
    const EnergyTable reflectivity_table = table("REFLECTIVITY"), transmittance = table("TRANSMITTANCE");
    if (reflectivity_table.empty()) {
      const std::string admitted = reflectivity();
      return admitted == "1.0" ? "" : "admitted = " + admitted + "\n";
    }
    if (least(reflectivity_table) >= 1.0) return "";
    if (most(transmittance) <= 0.0) return "admitted = " + reflectivity() + "\n";
    const SharesOfOneNumber both = shares_of_one_number(reflectivity_table, transmittance);
    return "admitted = " + curve(both.first) + "\nundeflected = " + curve(both.second) + "\n";
  }

  /// Two shares that one random number decides on in Geant4: the second takes at most what the first leaves.
  struct SharesOfOneNumber {
    EnergyTable first, second;
  };
  static SharesOfOneNumber shares_of_one_number(const EnergyTable& first, const EnergyTable& second) {
    SharesOfOneNumber both;
    std::set<double> energies(first.energy_eV.begin(), first.energy_eV.end());
    energies.insert(second.energy_eV.begin(), second.energy_eV.end());
    both.first.energy_eV = both.second.energy_eV = {energies.begin(), energies.end()};
    for (const double energy : energies) {
      both.first.value.push_back(std::clamp(value_at(first, energy), 0.0, 1.0));
      both.second.value.push_back(std::clamp(value_at(second, energy), 0.0, 1.0 - both.first.value.back()));
    }
    return both;
  }

  /// Values beyond 0 and 1 as Geant4 takes them: never, or always.
  static EnergyTable shares(EnergyTable values) {
    for (double& value : values.value) value = std::clamp(value, 0.0, 1.0);
    return values;
  }

  /// A face of paint or metal that reflects what it admits.
  void paint(bool specular) {
    const std::string base =
        std::string("base = \"geant4_") + (specular ? "polished" : "ground") + "frontpainted\"\n";
    result_.toml = most(table("TRANSMITTANCE")) > 0.0 ? base + "reflectance = 1.0\n" + admission()
                                                      : base + "reflectance = " + reflectivity() + "\n";
  }

  /// Geant4 calls the number "value": sigma alpha of the unified model, polish of glisur.
  double roughness() const {
    return std::clamp(tables_.definitions().number(surface_, "value", glisur() ? 1.0 : 0.0), 0.0, 1.5);
  }
  bool smeared() const { return glisur() && roughness() < 1.0; }

  /// Keys of facets and lobes, in a table of the model's own.
  std::string facets(const std::string& table_name) {
    if (smeared())
      return fmt::format("{} = {{ polish = {:.9g}, facets = \"geant4\" }}\n", table_name, roughness());
    return fmt::format(
        "{} = {{ sigma_alpha = \"{:.9g} rad\", definition = \"solid_angle\", facets = \"geant4\", lobe = "
        "{:.9g}, spike = {:.9g}, backscatter = {:.9g} }}\n",
        table_name, unified() ? roughness() : 0.0, unified() ? constant("SPECULARLOBECONSTANT") : 1.0,
        unified() ? constant("SPECULARSPIKECONSTANT") : 0.0,
        unified() ? constant("BACKSCATTERCONSTANT") : 0.0);
  }

  bool lobes_given() const {
    for (const char* name : {"SPECULARLOBECONSTANT", "SPECULARSPIKECONSTANT", "BACKSCATTERCONSTANT"})
      if (most(table(name)) > 0.0) return true;
    return false;
  }

  void metal() {
    const EnergyTable real = table("REALRINDEX"), imaginary = table("IMAGINARYRINDEX");
    const bool rough =
        finish_ == kFinishes[3] ? (unified() || smeared()) : unified() && finish_ != kFinishes[0];
    if (!real.empty() && !imaginary.empty() && table("REFLECTIVITY").empty()) {
      if (rough)
        note(
            "the roughness of a metal with a complex index, whose facets Geant4 does not follow either: "
            "smooth");
      result_.toml = "model = \"metal\"\nmetal = { n = " + curve(real) + ", k = " + curve(imaginary) + " }\n";
    } else if (!rough) {
      paint(true);
    } else if (unified() && !lobes_given()) {
      paint(false);
    } else {
      result_.toml = "model = \"metal\"\n" + facets("metal") + admission();
    }
  }

  void dielectric() {
    if (finish_.ends_with("frontpainted")) return paint(finish_.starts_with("polished"));
    if (finish_.ends_with("backpainted")) return back_painted();
    const std::string rest = "between_media_only = true\n" + admission();
    const double rms_mm = tables_.constant(surface_, {"SURFACEROUGHNESS"}).value_or(0.0);
    const bool smooth = finish_ == kFinishes[0] || (glisur() && !smeared());
    if (rms_mm > 0.0 && !smooth) note("its SURFACEROUGHNESS: only a face without facets has one here");
    if (smooth && rms_mm > 0.0) {
      result_.toml =
          fmt::format("model = \"slightly_rough\"\nslightly_rough = {{ rms_height = \"{:.9g} mm\" }}\n",
                      rms_mm) +
          rest;
    } else if (smooth) {
      result_.toml = "base = \"geant4_polished\"\n" + rest;
    } else if (smeared()) {
      result_.toml = "model = \"glisur\"\n" + facets("glisur") + rest;
    } else {
      result_.toml = "base = \"geant4_ground\"\n" + facets("unified") + rest;
    }
  }

  void back_painted() {
    const EnergyTable gap = table("RINDEX");
    if (gap.empty()) {
      note("finish \"" + finish_ + "\" without the RINDEX of its gap: Geant4 absorbs all light");
      result_.toml = "base = \"geant4_polishedfrontpainted\"\nreflectance = 0.0\n";
      return;
    }
    const bool dispersive = most(gap) - least(gap) > 1e-9;
    if (dispersive) result_.gap_index = curve(gap);
    const std::string table_name = smeared() ? "glisur" : "unified";
    result_.toml = (smeared() ? "model = \"glisur\"\nspecular_share = " +
                                    std::string(finish_.starts_with("polished") ? "1.0" : "0.0") + "\n"
                              : "base = \"geant4_" + finish_ + "\"\n") +
                   facets(table_name) +
                   (dispersive ? "gap = \"" + gap_name(surface_.attribute("name").value()) + "\"\n"
                               : fmt::format("gap = {:.9g}\n", gap.value.front())) +
                   paint_behind_gap();
  }

  /// Reflectance and transmittance of the paint of a back-painted face, where Geant4 draws both by one
  /// number; light passes it with its direction in the gap.
  std::string paint_behind_gap() {
    const EnergyTable transmittance = table("TRANSMITTANCE");
    if (most(transmittance) <= 0.0) return "reflectance = " + reflectivity() + "\n";
    EnergyTable reflectance = table("REFLECTIVITY");
    if (reflectance.empty()) reflectance = {{transmittance.energy_eV.front()}, {1.0}};
    const SharesOfOneNumber both = shares_of_one_number(reflectance, transmittance);
    return "reflectance = " + curve(both.first) + "\ntransmittance = " + curve(both.second) +
           "\ntransmitted_light = \"undeflected\"\n";
  }

  /// One film that interferes, between the two media.
  void coated() {
    const EnergyTable index = table("COATEDRINDEX");
    const std::optional<double> thickness_mm = tables_.constant(surface_, {"COATEDTHICKNESS"});
    if (index.empty() || !thickness_mm || !(*thickness_mm > 0.0)) {
      note("type \"coated\" without COATEDRINDEX or a COATEDTHICKNESS above 0: smooth");
      result_.toml = "base = \"geant4_polished\"\n";
      return;
    }
    // G4OpBoundaryProcess::CoatedDielectricDielectric: without frustrated transmission all light beyond the
    // film's critical angle is reflected; with an EFFICIENCY above 0 all that is transmitted is absorbed.
    std::string options;
    if (tables_.constant(surface_, {"COATEDFRUSTRATEDTRANSMISSION"}).value_or(0.0) == 0.0)
      options += ", frustrated_transmission = false";
    if (!result_.efficiency.empty()) {
      options += ", transmits = false";
      if (least(table("EFFICIENCY")) <= 0.0)
        note("its EFFICIENCY is 0 at some energies: Geant4 transmits light there, which is absorbed here");
    }
    // Facets of any finish but polished, without lobes.
    if (finish_ != kFinishes[0] && smeared())
      options += fmt::format(", polish = {:.9g}, facets = \"geant4\"", roughness());
    if (finish_ != kFinishes[0] && unified())
      options += fmt::format(
          ", sigma_alpha = \"{:.9g} rad\", definition = \"solid_angle\", facets = \"geant4\", lobe = 1.0",
          roughness());
    result_.toml = "model = \"thin_film\"\nthin_film = { layers = [{ index = " + curve(index) +
                   fmt::format(", thickness = \"{:.9g} mm\" }}]", *thickness_mm) + options + " }\n";
  }

  /// A dichroic filter, whose file G4DICHROICDATA names (G4OpBoundaryProcess::DielectricDichroic): what is
  /// not transmitted, undeflected, is reflected; REFLECTIVITY, TRANSMITTANCE and EFFICIENCY have no part in
  /// it.
  void dichroic() {
    note(
        "its table is read from the file that G4DICHROICDATA names when the scene is: set it, or write "
        "geant4_dichroic = { file = \"...\" }");
    result_.efficiency.clear();
    const bool mirror = glisur() || finish_ == kFinishes[0];
    if (!mirror && unified() && lobes_given())
      note("the facets and lobes of a dichroic face: what they would reflect is reflected by Lambert's law");
    result_.toml = std::string("model = \"angular\"\nangular = { transmitted = \"undeflected\", ") +
                   (mirror ? "" : "reflected = \"lambertian\", ") + "geant4_dichroic = {} }\n";
  }

  /// Geant4's tables: type dielectric_LUT with a finish of LBNL, dielectric_LUTDAVIS with one of Davis. They
  /// are used in the direction of the light, whatever the side.
  void tabulated() {
    const bool davis = type_ == kTypes[3];
    const std::optional<std::string> stem = tables::data_stem(finish_);
    if (!stem || davis != tables::is_davis_finish(finish_)) {
      note("type \"" + type_ + "\" with finish \"" + finish_ + "\", for which Geant4 has no table");
      return;
    }
    note(
        "its table " + *stem +
        " is read from Geant4's data RealSurface when the scene is: set G4REALSURFACEDATA, or write folder = "
        "\"...\" beside its finish");
    if (finish_.starts_with("Customized"))
      note("Geant4 itself has no finish " + finish_ + ": it is the pair of this name in the folder");
    const EnergyTable reflectivity_table = table("REFLECTIVITY"), transmittance = table("TRANSMITTANCE");
    std::string keys = "finish = \"" + finish_ + "\", from_outside = \"same\"";
    if (davis && !result_.efficiency.empty()) keys += ", unreflected = \"absorbed\"";
    std::string before;
    if (!davis && !reflectivity_table.empty() && most(reflectivity_table) <= 0.0) return paint(true);
    if (!davis && !reflectivity_table.empty()) {
      const bool constant_share = most(reflectivity_table) - least(reflectivity_table) <= 1e-9;
      if (constant_share && most(transmittance) <= 0.0) {
        keys += fmt::format(", reflectance = {:.9g}", std::min(1.0, most(reflectivity_table)));
      } else {
        note(
            "its REFLECTIVITY is drawn once a reflection; Geant4 draws it again with every direction that "
            "does not leave the surface");
        before = admission();
      }
    }
    result_.toml = "model = \"geant4_table\"\n" + before + "geant4_table = { " + keys + " }\n";
  }

  void note_others() {
    static const std::set<std::string> read{"REFLECTIVITY",
                                            "RINDEX",
                                            "SPECULARLOBECONSTANT",
                                            "SPECULARSPIKECONSTANT",
                                            "BACKSCATTERCONSTANT",
                                            "REALRINDEX",
                                            "IMAGINARYRINDEX",
                                            "EFFICIENCY",
                                            "TRANSMITTANCE",
                                            "COATEDRINDEX",
                                            "COATEDTHICKNESS",
                                            "COATEDFRUSTRATEDTRANSMISSION",
                                            "GROUPVEL",
                                            "SURFACEROUGHNESS"};
    for (const Node child : surface_.children("property")) {
      const std::string name = child.attribute("name").value();
      if (!read.contains(name)) note("its property " + name);
    }
  }

  Node surface_;
  const OpticalTables& tables_;
  std::string model_, type_, finish_;
  ImportedSurface result_;
};

}  // namespace

ImportedSurface import_surface(Node surface, const OpticalTables& tables) {
  return SurfaceImporter(surface, tables).import();
}

}  // namespace scintray::exchange::gdml
