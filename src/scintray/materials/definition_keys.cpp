#include "scintray/materials/detail/forms.hpp"
#include "scintray/materials/material_forms.hpp"

namespace scintray::materials {

namespace {

/// Placeholders for undefined names, while keys are explored.
SurfaceLookup any_names(const SurfaceModels& models) {
  return {[](const std::string&, const core::FileLocation&) { return optics::Medium{}; },
          [](const std::string&, const core::FileLocation&) { return SurfaceSpec{}; },
          [](const std::string&, const core::FileLocation&) { return optics::Reflector{}; }, models};
}

}  // namespace

std::vector<config::KeyUse> definition_key_uses(const std::string& tables,
                                                const config::TomlNodePtr& definition) {
  core::Problems ignored;
  const config::TomlTable table(definition, ignored, tables + ".NAME");
  table.record_uses();
  try {
    if (tables == "media") {
      read_medium(table, "NAME", SourceRule::optional);
    } else if (tables == "sensors") {
      table.optional_string("base");  // the database merges a sensor with its base before it is read
      read_sensor(table, "NAME", SourceRule::optional);
    } else if (tables == "reflectors") {
      read_reflector(table, "NAME", SourceRule::optional);
    } else {
      const SurfaceModels models;
      read_surface(table, "NAME", any_names(models), ignored);
    }
  } catch (const core::InputError&) {  // what was used until then counts
  }
  return table.key_uses();
}

}  // namespace scintray::materials
