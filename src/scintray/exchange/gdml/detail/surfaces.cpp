#include "scintray/exchange/gdml/detail/optical.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace scintray::exchange::gdml {

namespace {

// In the order of Geant4's enumerations G4OpticalSurfaceModel, G4SurfaceType and G4OpticalSurfaceFinish
// (Book For Application Developers, section "Boundary Process").
constexpr std::array kModels{"glisur", "unified", "LUT", "DAVIS", "dichroic"};
constexpr std::array kTypes{"dielectric_metal", "dielectric_dielectric", "dielectric_LUT",
                            "dielectric_LUTDAVIS", "dielectric_dichroic"};
constexpr std::array kFinishes{"polished", "polishedfrontpainted", "polishedbackpainted",
                               "ground",   "groundfrontpainted",   "groundbackpainted"};

/// A word, from itself or its number.
template <std::size_t N>
std::string word(Node node, const char* attribute, const std::array<const char*, N>& words) {
  const std::string text = node.attribute(attribute).value();
  const bool number = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!number || text.size() > 3) return text;
  const auto index = static_cast<std::size_t>(std::stoul(text));
  return index < N ? words[index] : text;
}

class SurfaceImporter {
 public:
  SurfaceImporter(Node surface, const GdmlFile& file, const Definitions& definitions)
      : surface_(surface),
        file_(file),
        definitions_(definitions),
        model_(word(surface, "model", kModels)),
        type_(word(surface, "type", kTypes)),
        finish_(word(surface, "finish", kFinishes)) {}

  ImportedSurface import() {
    note_others();
    const bool known_model = glisur() || unified();
    const bool known_finish = std::find(kFinishes.begin(), kFinishes.end(), finish_) != kFinishes.end();
    if (!known_model || !known_finish) {
      result_.notes.push_back("model \"" + model_ + "\", finish \"" + finish_ +
                              "\": its table is not in the file; import one with scintray table import");
      return result_;
    }
    if (metallic())
      metal();
    else if (type_ == kTypes[1])
      dielectric();
    else
      result_.notes.push_back("type \"" + type_ + "\" has no counterpart here");
    return result_;
  }

 private:
  bool glisur() const { return model_ == kModels[0]; }
  bool unified() const { return model_ == kModels[1]; }
  bool metallic() const { return type_ == kTypes[0]; }
  bool polished() const { return finish_.starts_with("polished"); }
  EnergyTable table(const char* name) const { return property(surface_, name, file_, definitions_); }
  double constant(const char* name) const {
    const EnergyTable values = table(name);
    return values.empty() ? 0.0 : values.value.front();
  }

  std::string reflectance() const {
    const EnergyTable values = table("REFLECTIVITY");
    return "reflectance = " + (values.empty() ? "1.0" : curve_toml(values, "", 0.0, 0.0)) + "\n";
  }

  /// Transmitted light continues straight in Geant4, as it does here through a film.
  bool lets_through_as_film() const {
    return polished() && (metallic() || finish_.ends_with("frontpainted"));
  }
  std::string transmittance() const {
    const EnergyTable values = lets_through_as_film() ? table("TRANSMITTANCE") : EnergyTable{};
    return values.empty() ? "" : "transmittance = " + curve_toml(values, "", 0.0, 0.0) + "\n";
  }

  /// Geant4 calls the number "value": sigma alpha of the unified model, polish of glisur.
  double roughness() const { return definitions_.number(surface_, "value", glisur() ? 1.0 : 0.0); }

  std::string facets() const {
    return fmt::format(
        "unified = {{ sigma_alpha = \"{:.9g} rad\", lobe = {:.9g}, spike = {:.9g}, backscatter = "
        "{:.9g} }}\n",
        unified() ? roughness() : 0.0, constant("SPECULARLOBECONSTANT"), constant("SPECULARSPIKECONSTANT"),
        constant("BACKSCATTERCONSTANT"));
  }

  bool lobes_given() const {
    for (const char* name : {"SPECULARLOBECONSTANT", "SPECULARSPIKECONSTANT", "BACKSCATTERCONSTANT"})
      if (!table(name).empty()) return true;
    return false;
  }

  void metal() {
    if (!polished() && glisur() && roughness() < 1.0) return no_polish();
    if (!table("REALRINDEX").empty() && table("REFLECTIVITY").empty()) {
      result_.notes.push_back("its reflectance follows from a complex index, which has no counterpart here");
      return;
    }
    if (!polished() && unified() && lobes_given()) {
      result_.notes.push_back("a rough metal with lobes has no counterpart here");
      return;
    }
    const bool mirror = polished() || glisur();
    result_.toml = std::string("base = \"geant4_") + (mirror ? "polished" : "ground") + "frontpainted\"\n" +
                   reflectance() + transmittance();
  }

  void dielectric() {
    if (finish_.ends_with("frontpainted")) {
      result_.toml = "base = \"geant4_" + finish_ + "\"\n" + reflectance() + transmittance();
      return;
    }
    if (finish_.ends_with("backpainted")) {
      const EnergyTable gap = table("RINDEX");
      if (gap.empty()) {
        result_.notes.push_back("finish \"" + finish_ + "\" without the RINDEX of its gap");
        return;
      }
      if (gap.value.size() > 1 && gap.value.front() != gap.value.back())
        result_.notes.push_back("the dispersion of its gap: the index at the lowest energy is used");
      result_.toml = "base = \"geant4_" + finish_ + "\"\n" + facets() +
                     fmt::format("gap = {:.9g}\n", gap.value.front()) + reflectance();
      return;
    }
    const EnergyTable reflectivity = table("REFLECTIVITY");
    if (std::any_of(reflectivity.value.begin(), reflectivity.value.end(), [](double r) { return r < 1.0; }))
      result_.notes.push_back(
          "its REFLECTIVITY below 1, by which Geant4 absorbs light before it is reflected or refracted");
    if (polished() || (glisur() && roughness() >= 1.0)) {
      result_.toml = "base = \"geant4_polished\"\n";
    } else if (glisur()) {
      no_polish();
    } else {
      result_.toml = "base = \"geant4_ground\"\n" + facets();
    }
  }

  void no_polish() {
    result_.notes.push_back(fmt::format("a glisur polish of {:.4g} has no counterpart here", roughness()));
  }

  void note_others() {
    static const std::set<std::string> read{
        "REFLECTIVITY",        "RINDEX",     "SPECULARLOBECONSTANT", "SPECULARSPIKECONSTANT",
        "BACKSCATTERCONSTANT", "REALRINDEX", "IMAGINARYRINDEX"};
    for (const Node child : surface_.children("property")) {
      const std::string name = child.attribute("name").value();
      if (name == "EFFICIENCY")
        result_.notes.push_back("its EFFICIENCY: give the part, or one of its faces, a sensor instead");
      else if (name == "TRANSMITTANCE" && lets_through_as_film())
        continue;
      else if (!read.contains(name))
        result_.notes.push_back("its property " + name);
    }
  }

  Node surface_;
  const GdmlFile& file_;
  const Definitions& definitions_;
  std::string model_, type_, finish_;
  ImportedSurface result_;
};

}  // namespace

ImportedSurface import_surface(Node surface, const GdmlFile& file, const Definitions& definitions) {
  return SurfaceImporter(surface, file, definitions).import();
}

}  // namespace scintray::exchange::gdml
