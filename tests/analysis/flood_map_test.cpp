// Anger positions and the segmentation of flood maps.
#include "scintray/analysis/position/flood_map.hpp"

#include <doctest/doctest.h>

#include "analysis/toys.hpp"
#include "scintray/analysis/position/channel_layout.hpp"
#include "scintray/analysis/position/detail/watershed.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;
using namespace scintray::test;
using doctest::Approx;

namespace {

using Position = std::array<double, 2>;

/// Gaussian spots on a square grid of pitch 1 mm.
void spots(std::size_t side, double sigma, std::size_t events_each, std::vector<Position>& positions,
           std::vector<PartId>& parts, std::uint64_t stream) {
  Rng rng = toy_rng(stream);
  for (std::size_t k = 0; k < side * side; ++k)
    for (std::size_t i = 0; i < events_each; ++i) {
      positions.push_back({static_cast<double>(k % side) + sigma * sample_normal(rng),
                           static_cast<double>(k / side) + sigma * sample_normal(rng)});
      parts.emplace_back(10 + k);
    }
}

}  // namespace

TEST_CASE("Anger's position is the mean of the channels") {
  const std::vector<Position> channels{{0.0, 0.0}, {3.0, 0.0}, {0.0, 3.0}, {3.0, 3.0}};
  const auto middle = anger_position(std::vector<double>{5.0, 5.0, 5.0, 5.0}, channels);
  REQUIRE(middle);
  CHECK((*middle)[0] == Approx(1.5));
  const auto plain = anger_position(std::vector<double>{4.0, 2.0, 1.0, 1.0}, channels);
  CHECK((*plain)[0] == Approx(9.0 / 8.0));
  CHECK((*plain)[1] == Approx(6.0 / 8.0));
  const auto squared = anger_position(std::vector<double>{4.0, 2.0, 1.0, 1.0}, channels, {2.0, 0.0});
  CHECK((*squared)[0] == Approx(15.0 / 22.0));
  const auto cut = anger_position(std::vector<double>{4.0, 2.0, 1.0, 1.0}, channels, {1.0, 0.4});
  CHECK((*cut)[1] == Approx(0.0));
  CHECK_FALSE(anger_position(std::vector<double>{0.0, 0.0, 0.0, 0.0}, channels));
  CHECK_THROWS_AS(anger_position(std::vector<double>{1.0}, channels), std::invalid_argument);
  CHECK_THROWS_AS(anger_position(std::vector<double>(4, 1.0), channels, {1.0, 1.0}), std::invalid_argument);
}

TEST_CASE("The basins of a small map are the expected ones") {
  const std::vector<double> height{1, 9, 2, 1, 7, 1,  //
                                   1, 3, 2, 4, 3, 1,  //
                                   0, 0, 0, 0, 0, 0};
  const Basins all = find_basins(height, 3, 6, 0.0, 0.0, std::nullopt);
  REQUIRE(all.peaks.size() == 2);
  CHECK(all.peaks[0] == 1);
  CHECK(all.peaks[1] == 4);
  CHECK(all.of_cell[0] == 0);
  CHECK(all.of_cell[9] == 1);
  CHECK(all.of_cell[12] == Basins::kNone);
  CHECK(all.saddles.at({0, 1}) == 2.0);
  // The lower peak stands 7 - 2 above its saddle: 5 errors of sqrt(7) / 2 are more.
  CHECK(find_basins(height, 3, 6, 0.0, 0.5, std::nullopt).peaks.size() == 1);
  const Basins one = find_basins(height, 3, 6, 0.0, 0.0, 1);
  CHECK(one.peaks.size() == 1);
  CHECK(one.of_cell[4] == 0);
}

TEST_CASE("Well separated spots are all found and all events assigned correctly") {
  std::vector<Position> positions;
  std::vector<PartId> parts;
  spots(6, 0.08, 100, positions, parts, 40);
  const FloodMap known = flood_map(positions, parts, {256, 36});
  CHECK(known.peaks.size() == 36);
  CHECK(known.crystals_without_peak == 0);
  CHECK(known.share_right.value == 1.0);
  std::uint64_t events = 0;
  for (const FloodPeak& peak : known.peaks) {
    events += peak.events;
    const std::size_t crystal = known.crystals[peak.owner].index() - 10;
    CHECK(peak.position_mm[0] == Approx(static_cast<double>(crystal % 6)).epsilon(0.1).scale(1.0));
    CHECK(peak.position_mm[1] == Approx(static_cast<double>(crystal / 6)).epsilon(0.1).scale(1.0));
  }
  CHECK(events == positions.size());
  const FloodMap alone = flood_map(positions, {}, {});
  CHECK(alone.peaks.size() == 36);
  CHECK(alone.crystals.empty());
}

TEST_CASE(
    "Law: spots of width sigma at distance d are resolved with probability (2 Phi(d / 2 sigma) - 1)^2") {
  std::vector<Position> positions;
  std::vector<PartId> parts;
  const double sigma = 0.3;
  spots(5, sigma, 1500, positions, parts, 41);
  const FloodMap map = flood_map(positions, parts, {256, 25});
  REQUIRE(map.peaks.size() == 25);
  // Outer crystals have no neighbour on one side: the mean over a row of 5 is (3 (2 P - 1) + 2 P) / 5.
  const double phi = 0.5 * std::erfc(-0.5 / sigma / std::sqrt(2.0));
  const double row = (3.0 * (2.0 * phi - 1.0) + 2.0 * phi) / 5.0;
  // The watershed finds the straight border between spots to a fraction of a cell here and there, which costs
  // a percent more than chance.
  CHECK(map.share_right.value < row * row + kSigmas * map.share_right.error);
  CHECK(map.share_right.value > row * row - 0.01 - kSigmas * map.share_right.error);
  // Half way between two spots the sum of both is 2 exp(-(d / 2 sigma)^2 / 2) of one (further ones add 1 %),
  // smoothing widens both.
  const double width2 = sigma * sigma + map.smoothing_mm * map.smoothing_mm;
  double beside = 0.0;
  int count = 0;
  for (const FloodNeighbours& pair : map.neighbours) {
    const Position a = map.peaks[pair.a].position_mm, b = map.peaks[pair.b].position_mm;
    if (std::hypot(a[0] - b[0], a[1] - b[1]) > 1.25) continue;
    beside += pair.valley_to_peak;
    ++count;
  }
  CHECK(beside / count == Approx(2.0 * std::exp(-0.125 / width2)).epsilon(0.08));
  CHECK(map.worst_peak_to_valley < map.peak_to_valley);
}

TEST_CASE("12 x 12 crystals on 4 x 4 channels are resolved by their light") {
  Rng rng = toy_rng(42);
  std::vector<Position> channels;
  for (int k = 0; k < 16; ++k) channels.push_back({1.0 + 3.0 * (k % 4), 1.0 + 3.0 * (k / 4)});
  std::vector<Position> positions;
  std::vector<PartId> parts;
  for (std::uint32_t crystal = 0; crystal < 144; ++crystal) {
    const Position at{static_cast<double>(crystal % 12), static_cast<double>(crystal / 12)};
    std::vector<double> expected;
    double sum = 0.0;
    for (const Position& channel : channels) {
      // A point source over squares of glue: light falls with the cube of the distance.
      const double r2 = std::pow(at[0] - channel[0], 2) + std::pow(at[1] - channel[1], 2) + 9.0;
      expected.push_back(std::pow(r2, -1.5));
      sum += expected.back();
    }
    for (int event = 0; event < 250; ++event) {
      std::vector<double> light;
      for (const double share : expected) {
        const double photons = 4000.0 * share / sum;
        light.push_back(std::max(0.0, photons + std::sqrt(photons) * sample_normal(rng)));
      }
      // Plain weights fold the corners: light of the outermost crystals is spread more uniformly than that of
      // the next ones, which draws it to the middle.
      positions.push_back(*anger_position(light, channels, {2.0, 0.0}));
      parts.emplace_back(crystal);
    }
  }
  const FloodMap map = flood_map(positions, parts, {256, 144});
  CHECK(map.peaks.size() == 144);
  CHECK(map.crystals_without_peak == 0);
  CHECK(map.share_right.value > 0.9);
}

TEST_CASE("Blurred crystals that merge are counted as lost, not hidden") {
  std::vector<Position> positions;
  std::vector<PartId> parts;
  spots(4, 0.8, 500, positions, parts, 43);
  const FloodMap map = flood_map(positions, parts, {256, 16});
  CHECK(map.peaks.size() < 16);
  CHECK(map.crystals_without_peak > 0);
  CHECK(map.share_right.value < 0.6);
}

TEST_CASE("A flood map of nothing, or on a line, is refused") {
  CHECK(contains(complaint_of([] { flood_map(std::vector<Position>(20), {}); }), "20 events"));
  CHECK(contains(complaint_of([] {
                   flood_map(std::vector<Position>(200, Position{1.0, 2.0}), {});
                 }),
                 "one line"));
  CHECK_THROWS_AS(flood_map(std::vector<Position>(200), std::vector<PartId>(3)), std::invalid_argument);
}
