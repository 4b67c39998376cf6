/// The quickstart scene against what README states it prints, with another seed.

#include <doctest/doctest.h>

#include <fstream>
#include <regex>

#include "scintray/core/statistics.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::simulation;

namespace {

constexpr std::size_t kSurfaces = 3, kDepths = 5;

/// README's table, by surface, then depth.
std::vector<std::vector<Estimate>> printed_table() {
  std::ifstream readme(test::source_file("README.md"));
  std::vector<std::vector<Estimate>> table(kSurfaces);
  const std::regex row(R"(^\s+\d+ mm((\s+[\d.]+ ± [\d.]+)+)\s*$)"), cell(R"(([\d.]+) ± ([\d.]+))");
  for (std::string line; std::getline(readme, line);) {
    std::smatch found;
    if (!std::regex_match(line, found, row)) continue;
    const std::string cells = found[1];
    std::size_t surface = 0;
    for (std::sregex_iterator it(cells.begin(), cells.end(), cell), end; it != end; ++it, ++surface)
      table.at(surface).push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  }
  return table;
}

}  // namespace

TEST_CASE(
    "The quickstart has the results that README prints, and the rough crystal's light falls with depth") {
  const auto printed = printed_table();
  for (const auto& depths : printed) REQUIRE(depths.size() == kDepths);

  const SceneFile file = SceneFile::load(test::source_file("scenes/quickstart.toml"));
  SimulationOptions options;
  options.photons = 100'000;
  options.seed = 20;
  const RunResult result = Simulation(file, options).run_all();
  REQUIRE(result.points.size() == kSurfaces * kDepths);

  const auto detected = [&](std::size_t surface, std::size_t depth) {
    return result.points[surface * kDepths + depth].fraction(Fate::detected);
  };
  for (std::size_t surface = 0; surface < kSurfaces; ++surface)
    for (std::size_t depth = 0; depth < kDepths; ++depth) {
      CAPTURE(surface);
      CAPTURE(depth);
      const Estimate now = detected(surface, depth);
      CAPTURE(now.value);
      // Seeds differ, so the two are independent; one false alarm in 15,800 comparisons.
      CHECK(sigmas(now, printed[surface][depth]) < 4.0);
    }
  enum { polished, table, unified };
  CHECK(detected(table, 4).value < 0.5 * detected(table, 0).value);
  for (std::size_t depth = 0; depth < kDepths; ++depth) {
    CAPTURE(depth);
    CHECK(detected(table, depth).value < detected(unified, depth).value);
    CHECK(detected(unified, depth).value < detected(polished, depth).value);
  }
}
