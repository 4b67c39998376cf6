// The scenes that README.md shows, as a reader pastes them.
#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scintray/simulation/simulation.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

/// The blocks of TOML in a page.
std::vector<std::string> toml_blocks(const std::filesystem::path& page) {
  std::ifstream stream(page);
  std::vector<std::string> blocks;
  bool inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (line == "```toml") {
      inside = true;
      blocks.emplace_back();
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

}  // namespace

TEST_CASE("The scenes of the README are complete, and detect light") {
  const std::vector<std::string> blocks = toml_blocks(source_file("README.md"));
  CHECK_FALSE(blocks.empty());
  for (const std::string& block : blocks) {
    CAPTURE(block);
    simulation::SimulationOptions options;
    options.photons = 1000;
    simulation::Simulation simulation(scene_file::SceneFile::from_text(block, "README.md"), options);
    const tally::RunResult result = simulation.run_all();
    REQUIRE(result.points.size() == 1);
    CHECK(result.points[0].emitted == 1000);
    CHECK(result.points[0].count(core::Fate::detected) > 0);
    CHECK(result.points[0].lost == 0);
  }
}
