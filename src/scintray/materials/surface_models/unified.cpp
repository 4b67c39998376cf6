#include "scintray/optics/unified.hpp"

#include <fmt/format.h>

#include "scintray/materials/detail/surface_values.hpp"
#include "scintray/materials/surface_models.hpp"

namespace scintray::materials {

namespace {

constexpr core::Word<optics::SigmaAlphaDefinition> kDefinitions[] = {
    {"solid_angle", optics::SigmaAlphaDefinition::solid_angle},
    {"polar_angle", optics::SigmaAlphaDefinition::polar_angle}};
constexpr core::Word<optics::FacetSampling> kFacets[] = {
    {"projected_area", optics::FacetSampling::projected_area}, {"geant4", optics::FacetSampling::geant4}};

std::string key_of(const optics::UnifiedSurface& surface) {
  return fmt::format("UNIFIED {} rad, {}, {}, lobe {}, spike {}, backscatter {}", surface.sigma_alpha_rad,
                     core::word_of(kDefinitions, surface.definition),
                     core::word_of(kFacets, surface.sampling), surface.lobe, surface.spike,
                     surface.backscatter);
}

}  // namespace

optics::FacetSampling read_facet_sampling(const config::TomlTable& table) {
  return table.choice("facets", kFacets);
}

optics::UnifiedSurface read_unified_facets(const config::TomlTable& table) {
  optics::UnifiedSurface surface;
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

SurfaceModel unified_model() {
  const auto read = [](const config::TomlTable& surface) {
    const optics::UnifiedSurface unified = read_unified_facets(surface.table("unified"));
    return FixedMicrosurface(unified, key_of(unified));
  };
  return {.word = "unified", .table = "unified", .read = read};
}

}  // namespace scintray::materials
