#include "scintray/cli/bench_options.hpp"

#include <fmt/format.h>

#include "scintray/cli/watched_surfaces.hpp"
#include "scintray/core/units.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene/read_scene.hpp"

namespace scintray::cli {

void add_bench_options(CLI::App& app, BenchOptions& options, std::uint64_t rays) {
  options.rays = rays;
  app.add_option("--inside", options.inside, "Medium of the part whose face it is")->capture_default_str();
  app.add_option("--wavelength", options.wavelength, "Wavelength of the light")->capture_default_str();
  app.add_option("--scene", options.scene, "Scene file whose own surfaces and media are known as well");
  app.add_option("--rays", options.rays, "Rays at each angle")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Seed of the random numbers")->capture_default_str();
}

Library library_of(const BenchOptions& options) {
  return options.scene.empty() ? Library::shipped() : library_for(SceneFile::load(options.scene).spec(0));
}

BenchPlace place_of(const BenchOptions& options, const std::string& surface, const std::string& outside) {
  return {surface, options.inside, outside, parse_quantity(options.wavelength, Dimension::wavelength)};
}

double angle_rad(const std::string& text) { return parse_quantity(text, Dimension::angle); }

SurfaceMaker watched_maker(ProgressLine& line) { return SurfaceMaker(watched_surfaces(line)); }

std::string share_text(const Estimate& share) {
  return fmt::format("{:.5f} +- {:.5f}", share.value, share.error);
}

}  // namespace scintray::cli
