#include <fmt/format.h>

#include "scintray/exchange/gdml/detail/gdml_writer.hpp"
#include "scintray/optics/coherent_layers.hpp"
#include "scintray/optics/facets.hpp"

namespace scintray::exchange::gdml {

namespace {

pugi::xml_node append_surface(pugi::xml_node solids, const std::string& name) {
  pugi::xml_node node = solids.append_child("opticalsurface");
  node.append_attribute("name") = name.c_str();
  return node;
}

void set_kind(pugi::xml_node node, const char* type, const char* finish, double sigma_alpha_rad = 0.0) {
  node.append_attribute("model") = "unified";
  node.append_attribute("type") = type;
  node.append_attribute("finish") = finish;
  node.append_attribute("value") = fmt::format("{:.12g}", sigma_alpha_rad).c_str();
}

}  // namespace

std::string GdmlWriter::surface(const optics::Surface& surface, optics::Side from,
                                const detector::Sensor* sensor) {
  if (surface.plain() && !sensor) return {};
  // A reflector that light reaches from behind is paint on that side.
  const bool from_behind = surface.reflector && from == optics::Side::outside;
  const std::string wanted =
      surface.name + (from_behind ? "_from_behind" : "") + (sensor ? "_with_" + sensor->name : std::string());
  const auto [known, is_new] = done_.try_emplace("surface " + wanted);
  if (!is_new) return known->second;
  known->second = new_name(wanted);
  pugi::xml_node node = append_surface(section("solids"), known->second);
  add_finish(node, surface, from);
  if (sensor) {
    add_table(node, "EFFICIENCY", sensor->cathode ? sensor->cathode->escape : sensor->efficiency);
    note_face_response(*sensor);
  }
  return known->second;
}

void GdmlWriter::note_face_response(const detector::Sensor& sensor) {
  if (sensor.over_face)
    note("sensor " + sensor.name +
         ": its efficiency over the face is left out: it is the same at every place");
}

std::string GdmlWriter::absorbing_surface(const detector::Sensor& sensor) {
  const auto [known, is_new] = done_.try_emplace("sensor " + sensor.name);
  if (!is_new) return known->second;
  known->second = new_name(sensor.name);
  pugi::xml_node node = append_surface(section("solids"), known->second);
  set_kind(node, "dielectric_metal", "polished");
  add_table(node, "REFLECTIVITY", core::Curve::constant(0.0));
  add_table(node, "EFFICIENCY", sensor.efficiency);
  note_face_response(sensor);
  if (sensor.angle)
    note("sensor " + sensor.name +
         ": its dependence on angle is left out: it detects as at normal incidence");
  if (sensor.definition == detector::EfficiencyDefinition::external)
    note("sensor " + sensor.name +
         ": its efficiency includes the loss at its entrance, which Geant4 computes once more: fewer photons "
         "are detected by that loss");
  return known->second;
}

void GdmlWriter::add_finish(pugi::xml_node node, const optics::Surface& surface, optics::Side from) {
  if (!surface.mixture.empty())
    note("surface " + surface.name +
         ": its mixture cannot be written: smooth here, light does not see its shares");
  if (surface.reflector) {
    const optics::Reflector& reflector = *surface.reflector;
    const bool specular = reflector.specular_share >= 0.5;
    if (reflector.specular_share > 0.0 && reflector.specular_share < 1.0)
      note(
          fmt::format("surface {}: {:.0f} % of what its reflector returns is specular; Geant4's paint has {}",
                      surface.name, 100.0 * reflector.specular_share, specular ? "all" : "none"));
    if (reflector.transmittance)
      note("surface " + surface.name + ": the transmittance of its reflector: that light is absorbed");
    if (reflector.volume_index > 0.0)
      note("surface " + surface.name +
           ": its volume-like reflector becomes Lambertian paint of the same reflectance, without the faces "
           "of "
           "the volume");
    if (surface.gap_thickness_um || surface.gap_shifter)
      note("surface " + surface.name + ": the thickness of its gap: light is not absorbed or shifted in it");
    const bool painted =
        surface.microsurface->kind() == optics::MicrosurfaceKind::painted || from == optics::Side::outside;
    if (painted) {
      set_kind(node, "dielectric_dielectric", specular ? "polishedfrontpainted" : "groundfrontpainted");
    } else {
      const auto* facets = surface.microsurface.get_if<optics::FacetSurface>();
      set_kind(node, "dielectric_dielectric", specular ? "polishedbackpainted" : "groundbackpainted",
               facets ? facets->sigma_alpha_rad : 0.0);
      add_table(node, "RINDEX", surface.gap_index);
      add_rough(node, surface);
    }
    add_table(node, "REFLECTIVITY", reflector.reflectance);
    return;
  }
  if (const auto* metal = surface.microsurface.get_if<optics::MetalSurface>()) {
    set_kind(node, "dielectric_metal", metal->facets.sigma_alpha_rad > 0.0 ? "ground" : "polished",
             metal->facets.sigma_alpha_rad);
    if (metal->metal) {
      add_table(node, "REALRINDEX", metal->metal->n);
      add_table(node, "IMAGINARYRINDEX", metal->metal->k);
    } else {
      add_table(node, "REFLECTIVITY",
                surface.admission ? surface.admission->admitted : core::Curve::constant(1.0));
    }
    return;
  }
  const auto* facets = surface.microsurface.get_if<optics::FacetSurface>();
  set_kind(node, "dielectric_dielectric", facets ? "ground" : "polished",
           facets ? facets->sigma_alpha_rad : 0.0);
  add_rough(node, surface);
  if (surface.admission) {
    add_table(node, "REFLECTIVITY", surface.admission->admitted);
    if (surface.admission->undeflected.max_y() > 0.0)
      add_table(node, "TRANSMITTANCE", surface.admission->undeflected);
  }
}

void GdmlWriter::add_rough(pugi::xml_node node, const optics::Surface& surface) {
  if (surface.microsurface->kind() == optics::MicrosurfaceKind::smooth) {
    add_table(node, "SPECULARLOBECONSTANT", core::Curve::constant(1.0));
    return;
  }
  const auto* facets = surface.microsurface.get_if<optics::FacetSurface>();
  if (!facets) {
    note("surface " + surface.name +
         ": its microsurface (a table, a height map, films or another model) has no counterpart in GDML: "
         "smooth "
         "here. scintray table build and table export --format davis write it for Geant4's DAVIS model");
    add_table(node, "SPECULARLOBECONSTANT", core::Curve::constant(1.0));
    return;
  }
  if (facets->sampling == optics::FacetSampling::projected_area)
    note("surface " + surface.name +
         ": its facets are weighted by their projected area; Geant4 takes any that faces the light");
  if (facets->definition == optics::SigmaAlphaDefinition::polar_angle)
    note("surface " + surface.name +
         ": sigma_alpha is that of the polar angle; Geant4's is per solid angle, and "
         "its facets are tilted more");
  if (facets->smear > 0.0) note("surface " + surface.name + ": facets of GLISUR: flat here");
  add_table(node, "SPECULARLOBECONSTANT", core::Curve::constant(facets->lobe));
  add_table(node, "SPECULARSPIKECONSTANT", core::Curve::constant(facets->spike));
  add_table(node, "BACKSCATTERCONSTANT", core::Curve::constant(facets->backscatter));
}

}  // namespace scintray::exchange::gdml
