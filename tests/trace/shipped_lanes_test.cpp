#ifndef SCINTRAY_SANITIZED  // their tables take minutes there
#include <filesystem>
#include <regex>
#include <set>

#include "physics/traced.hpp"
#include "scintray/core/lane_width.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::simulation;
using namespace scintray::test;

TEST_CASE("The shipped scenes have the same results for every width of the lanes") {
  std::string name;
  SUBCASE("block_detector") { name = "block_detector"; }
  SUBCASE("doi_block") { name = "doi_block"; }
  SUBCASE("dual_ended") { name = "dual_ended"; }
  SUBCASE("light_output") { name = "roncali2013/light_output"; }
  SUBCASE("monolithic_slab") { name = "monolithic_slab"; }
  SUBCASE("phosphor_coated") { name = "phosphor_coated"; }
  SUBCASE("polished_fall") { name = "roncali2013/polished_fall"; }
  SUBCASE("quickstart") { name = "quickstart"; }
  SUBCASE("torture") { name = "torture"; }
  const std::filesystem::path path = source_file("scenes/" + name + ".toml");
  std::string text = config::read_text_file(path);
  text = std::regex_replace(text, std::regex("\nphotons = [0-9_]+"), "\nphotons = 900");
  text = std::regex_replace(text, std::regex("\nevents = [0-9_]+"), "\nevents = 5");
  // The same coarse table for every width.
  text = std::regex_replace(text, std::regex("\ntracing = \\{"), "\ntracing = { rays = 100,");
  const SceneFile file = SceneFile::from_text(text, path.string());
  scene::SceneBuilder builder(tables_of_this_build());
  // Points differ in surfaces, or in the place of the light.
  for (const std::size_t point : std::set<std::size_t>{0, file.points() / 2, file.points() - 1}) {
    CAPTURE(point);
    const SceneSpec spec = file.spec(point);
    const TracedPhotons alone = trace_with(spec, 1, builder);
    REQUIRE(alone.result.segments > 500);
    for (const int width : core::lane_widths()) {
      CAPTURE(width);
      check_same(alone, trace_with(spec, width, builder));
    }
  }
}
#endif
