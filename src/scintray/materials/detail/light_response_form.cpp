#include "scintray/materials/detail/forms.hpp"

namespace scintray::materials {

namespace {

/// Largest accepted response relative to the yield: larger values are errors of unit.
constexpr double kGreatestResponse = 10.0;

}  // namespace

void read_light_response(const config::TomlTable& table, SourceRule rule, optics::Medium& medium) {
  if (const std::optional<config::TomlTable> block = table.optional_table("non_proportionality")) {
    read_source(*block, rule, medium.sources);
    medium.relative_yield = block->curve("response", core::Dimension::dimensionless, core::Dimension::energy);
    const core::Curve& curve = medium.relative_yield;
    block->expect("response", !curve.is_constant(),
                  "a response to energy needs energies, but this is one value",
                  "write { energy = [...], energy_unit = \"keV\", value = [...] }");
    block->expect("response", curve.min_y() > 0.0 && curve.max_y() <= kGreatestResponse,
                  "a response lies above 0 and up to 10, but this one runs from " +
                      std::to_string(curve.min_y()) + " to " + std::to_string(curve.max_y()),
                  "give the light per keV relative to the yield: 1 at the energy of the yield");
    block->expect("response", curve.x().front() > 0.0, "an energy must be positive");
  }
  if (const std::optional<config::TomlTable> block = table.optional_table("intrinsic_resolution")) {
    read_source(*block, rule, medium.sources);
    medium.intrinsic_fwhm = block->quantity("fwhm", core::Dimension::dimensionless);
    medium.intrinsic_keV = block->quantity("energy", core::Dimension::energy);
    block->expect("fwhm", medium.intrinsic_fwhm >= 0.0 && medium.intrinsic_fwhm < 1.0,
                  "a resolution lies from 0 to below 1",
                  "give the full width at half maximum over the mean, as \"8 %\"");
    block->expect("energy", medium.intrinsic_keV > 0.0, "an energy must be positive",
                  "give the energy at which the resolution holds, as \"662 keV\"");
  }
}

void refuse_light_response(const config::TomlTable& table) {
  for (const char* key : {"non_proportionality", "intrinsic_resolution", "birks", "particle_light"})
    if (table.has(key)) {
      table.take(key);
      table.report(key, std::string("\"") + key + "\" in a medium that does not scintillate",
                   "give [yield], [emission] and [[decay]] too, or remove it");
    }
}

}  // namespace scintray::materials
