#include <fmt/format.h>

#include "scintray/materials/detail/surface_values.hpp"

namespace scintray::materials {

namespace {

constexpr core::Word<optics::SigmaAlphaDefinition> kDefinitions[] = {
    {"solid_angle", optics::SigmaAlphaDefinition::solid_angle},
    {"polar_angle", optics::SigmaAlphaDefinition::polar_angle}};
constexpr core::Word<optics::FacetSampling> kFacets[] = {
    {"projected_area", optics::FacetSampling::projected_area}, {"geant4", optics::FacetSampling::geant4}};

}  // namespace

optics::FacetSampling read_facet_sampling(const config::TomlTable& table) {
  return table.choice("facets", kFacets);
}

optics::FacetSurface read_facets(const config::TomlTable& table) {
  optics::FacetSurface surface;
  surface.sigma_alpha_rad = table.quantity("sigma_alpha", core::Dimension::angle);
  table.expect("sigma_alpha",
               surface.sigma_alpha_rad >= 0.0 && surface.sigma_alpha_rad < 90.0 * core::kDegree,
               "\"sigma_alpha\" lies between 0 and 90 deg");
  surface.definition = table.choice("definition", kDefinitions);
  surface.sampling = read_facet_sampling(table);
  surface.lobe = read_share(table, "lobe", std::nullopt);
  surface.spike = read_share(table, "spike", 0.0);
  surface.backscatter = read_share(table, "backscatter", 0.0);
  const double sum = surface.lobe + surface.spike + surface.backscatter;
  table.expect("lobe", sum <= 1.0 + 1e-12,
               "spike, lobe and backscatter sum to " + std::to_string(sum) + ", above 1",
               "they are shares of the reflected light; what is left of 1 is Lambertian");
  return surface;
}

optics::FacetSurface read_roughness(const config::TomlTable& table, const char* what) {
  optics::FacetSurface facets;
  const bool rough = table.has("sigma_alpha"), smeared = table.has("polish");
  if (!rough && !smeared) {
    for (const char* key : {"definition", "facets", "lobe", "spike", "backscatter"}) table.has(key);
    return facets;
  }
  if (rough) {
    facets = read_facets(table);
  } else {
    facets.sampling = read_facet_sampling(table);
  }
  if (smeared) facets.smear = 1.0 - read_share(table, "polish", std::nullopt);
  table.expect("polish", !rough, std::string(what) + " has both \"sigma_alpha\" and \"polish\"",
               "keep one of them");
  return facets;
}

std::string text_of(const optics::FacetSurface& facets) {
  return fmt::format("{} rad, {}, {}, lobe {}, spike {}, backscatter {}", facets.sigma_alpha_rad,
                     core::word_of(kDefinitions, facets.definition), core::word_of(kFacets, facets.sampling),
                     facets.lobe, facets.spike, facets.backscatter);
}

}  // namespace scintray::materials
