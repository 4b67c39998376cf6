#include "scintray/cli/goniometer_options.hpp"

#include <fmt/format.h>

#include "scintray/cli/count_option.hpp"
#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/core/units.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"

namespace scintray::cli {

void add_sample_options(CLI::App& app, SampleOptions& options, std::uint64_t rays) {
  options.rays = rays;
  app.add_option("--inside", options.inside, "Medium of the part with the face")->capture_default_str();
  app.add_option("--wavelength", options.wavelength, "Wavelength of the light")->capture_default_str();
  app.add_option("--scene", options.scene,
                 "Scene file, or file of definitions, whose own surfaces and media are used as well");
  app.add_option("--rays", options.rays, "Rays at each angle")
      ->transform(whole_count())
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Seed of the random numbers")->capture_default_str();
}

materials::MaterialDatabase database_of(const SampleOptions& options) {
  return options.scene.empty() ? materials::MaterialDatabase::shipped()
                               : scene::database_for(scene_file::SceneFile::load_definitions(options.scene));
}

void add_file_surface(materials::MaterialDatabase& database, const std::string& surface) {
  std::error_code status;
  if (!std::filesystem::is_regular_file(surface, status)) return;
  const std::string file = "file = " + exchange::toml_string(std::filesystem::absolute(surface).string());
  const bool table = std::filesystem::path(surface).extension() == ".h5";
  const std::string text = table
                               ? "model = \"table\"\ntable = { " + file + " }\n"
                               : "model = \"height_map\"\nheight_map = { " + file + ", level = \"plane\" }\n";
  database.add(materials::DefinitionKind::surface, {{surface, config::parse_toml(text, surface)}});
}

analysis::SamplePlace place_of(const SampleOptions& options, const std::string& surface,
                               const std::string& outside) {
  return {surface, options.inside, outside,
          core::parse_quantity(options.wavelength, core::Dimension::wavelength)};
}

double angle_rad(const std::string& text) { return core::parse_quantity(text, core::Dimension::angle); }

materials::SurfaceFactory watched_factory(ProgressLine& line) {
  return materials::SurfaceFactory(watched_surfaces(line));
}

std::string share_text(const core::Estimate& share) {
  return fmt::format("{:.5f} +- {:.5f}", share.value, share.error);
}

}  // namespace scintray::cli
