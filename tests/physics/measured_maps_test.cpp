#include "physics/crystal_scene.hpp"
#include "physics/traced.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

/// A measured map on the faces of a crystal: the table built from it gives the same light as the map
/// traced on the spot.
void compare_table_with_map(const std::string& file) {
  const auto map = shared_file("data/topography/" + file);
  if (!map) return;
  for (const double z : {2.0, 10.0}) {
    const auto traced = [&](const std::string& mode) {
      return trace(rough_crystal(z, {map->string(), "plane", false, mode}, 200'000)).result;
    };
    const PointResult spot = traced("on_the_spot"), table = traced("table");
    for (const Fate fate : {Fate::detected, Fate::escaped, Fate::absorbed_in_medium}) {
      const Estimate a = table.fraction(fate), b = spot.fraction(fate);
      evidence("table_against_map",
               {file, fmt::format("{:g} mm", z), std::string(fate_name(fate)),
                fmt::format("{:.5f} ± {:.5f}", a.value, a.error),
                fmt::format("{:.5f} ± {:.5f}", b.value, b.error), fmt::format("{:.2f}", sigmas(a, b))});
      CAPTURE(z);
      CAPTURE(fate_name(fate));
      CAPTURE(a.value);
      CAPTURE(b.value);
      CHECK(sigmas(a, b) < kSigmas);
    }
  }
}

}  // namespace

TEST_CASE("Measured map: optical profile of a ground surface, in rad by the header's factor") {
  compare_table_with_map("matrix-2.txt.gz");
}

TEST_CASE("Measured map: etched chip in strong relief") { compare_table_with_map("chip.gsf"); }
