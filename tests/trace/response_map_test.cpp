#include <algorithm>

#include "support/words.hpp"
#include "trace/mapped.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

bool same(const ResponseMap& a, const ResponseMap& b) {
  if (a.channels != b.channels || a.grids.size() != b.grids.size()) return false;
  return std::equal(a.grids.begin(), a.grids.end(), b.grids.begin(),
                    [](const ResponseGrid& one, const ResponseGrid& other) {
                      return one.photons == other.photons && one.detected == other.detected &&
                             one.delays_ns == other.delays_ns && one.cells == other.cells;
                    });
}

bool same(const EventRecord& a, const EventRecord& b) {
  return a.event == b.event && a.energy_keV == b.energy_keV && a.emitted == b.emitted &&
         a.detected == b.detected && a.position_mm == b.position_mm &&
         std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(),
                    [](const ChannelRecord& one, const ChannelRecord& other) {
                      const bool neither = one.detected == 0 && other.detected == 0;
                      return one.detected == other.detected && (neither || one.first_ns == other.first_ns);
                    });
}

/// A map of two cells along z for one channel, made up.
ResponseMap two_cells(std::uint32_t low, std::uint32_t high) {
  ResponseMap map;
  map.channels = {"sensor"};
  map.photons_per_cell = 100;
  map.delays_kept = 4;
  ResponseGrid grid;
  grid.part = "crystal";
  grid.region = RegionId(1);
  grid.pitch = Vec3(2, 2, 5);
  grid.cells = {1, 1, 2};
  grid.photons = {100, 100};
  grid.detected = {low, high};
  grid.delays_ns.assign(map.kept(low), 1.0f);
  grid.delays_ns.insert(grid.delays_ns.end(), map.kept(high), 2.0f);
  map.grids = {grid};
  return map;
}

double probability_at(const ResponseMap& map, const Vec3& position) {
  std::vector<PlaceResponse> response;
  MappedResponse(map).at(position, RegionId(1), response);
  return response.at(0).probability();
}

}  // namespace

TEST_CASE("A response map and events from it are the same to the last bit for 1, 2 and 7 threads") {
  const MappedScene scene(two_ends(6.0, placed(600)));
  const ResponseSettings fineness{2.0, 400, 16};
  const ResponseMap one = scene.map(fineness, 1);
  REQUIRE(one.grids.size() == 1);
  CHECK((one.grids[0].cells == std::array<std::uint32_t, 3>{1, 1, 3}));
  const std::vector<EventRecord> events = scene.mapped(one, 1);
  REQUIRE(events.size() == 600);
  for (const int threads : {2, 7}) {
    CHECK(same(scene.map(fineness, threads), one));
    const std::vector<EventRecord> others = scene.mapped(one, threads);
    CHECK(std::equal(events.begin(), events.end(), others.begin(), others.end(),
                     [](const EventRecord& a, const EventRecord& b) { return same(a, b); }));
  }
}

TEST_CASE("Events from a response map have the deposits and emitted photons of traced ones") {
  const MappedScene scene(two_ends(6.0, placed(20)));
  const std::vector<EventRecord> traced = scene.traced(), mapped = scene.mapped(scene.map({2.0, 400, 16}));
  REQUIRE(traced.size() == mapped.size());
  for (std::size_t i = 0; i < traced.size(); ++i) {
    CHECK(traced[i].emitted == mapped[i].emitted);
    CHECK(traced[i].position_mm == mapped[i].position_mm);
    CHECK(mapped[i].detected == mapped[i].channels[0].detected + mapped[i].channels[1].detected);
    CHECK(mapped[i].detected < mapped[i].emitted);
  }
}

TEST_CASE("Probabilities are linear between centres of cells, constant beyond, and blind to empty cells") {
  ResponseMap map = two_cells(10, 30);
  CHECK(probability_at(map, {1, 1, 0}) == doctest::Approx(0.1));
  CHECK(probability_at(map, {1, 1, 2.5}) == doctest::Approx(0.1));
  CHECK(probability_at(map, {1, 1, 5.0}) == doctest::Approx(0.2));
  CHECK(probability_at(map, {1, 1, 6.25}) == doctest::Approx(0.25));
  CHECK(probability_at(map, {1, 1, 10}) == doctest::Approx(0.3));
  map.grids[0].photons[0] = map.grids[0].detected[0] = 0;
  map.grids[0].delays_ns.erase(map.grids[0].delays_ns.begin(), map.grids[0].delays_ns.begin() + 4);
  CHECK(probability_at(map, {1, 1, 5.0}) == doctest::Approx(0.3));
  CHECK(probability_at(map, {1, 1, 0.0}) == doctest::Approx(0.3));  // the nearest that is not empty
}

TEST_CASE("Delays come from the cells around as often as light detected from them does") {
  const ResponseMap map = two_cells(10, 30);
  std::vector<PlaceResponse> response;
  MappedResponse(map).at({1, 1, 5.0}, RegionId(1), response);
  Rng rng(1, StreamKind::other, 0);
  std::uint64_t late = 0;
  constexpr std::uint64_t kDraws = 20'000;
  for (std::uint64_t i = 0; i < kDraws; ++i) late += response[0].sample_delay(rng) == 2.0 ? 1 : 0;
  CHECK(sigmas(binomial_estimate(late, kDraws), {0.75, 0.0}) < kSigmas);
}

TEST_CASE("The first of many photons comes as early as the earliest of times drawn one by one") {
  const ResponseMap map = two_cells(10, 30);
  std::vector<PlaceResponse> response;
  MappedResponse(map).at({1, 1, 5.0}, RegionId(1), response);
  const std::vector<DecayComponent> decay{{40.0, 0.5, 0.7}, {3.0, 0.0, 0.3}};
  for (const std::uint64_t photons : {1u, 3u, 200u}) {
    CAPTURE(photons);
    Rng rng(2, StreamKind::other, photons);
    Moments quick, plain, quick_squares, plain_squares;
    for (int i = 0; i < 4'000; ++i) {
      const double first = sample_first(photons, decay, response[0], rng);
      double earliest = std::numeric_limits<double>::infinity();
      for (std::uint64_t k = 0; k < photons; ++k)
        earliest = std::min(earliest, sample_decay(decay, rng) + response[0].sample_delay(rng));
      quick.add(first);
      plain.add(earliest);
      quick_squares.add(first * first);
      plain_squares.add(earliest * earliest);
    }
    CHECK(sigmas(quick.mean(), plain.mean()) < kSigmas);
    CHECK(sigmas(quick_squares.mean(), plain_squares.mean()) < kSigmas);
  }
}

TEST_CASE("Cells outside a round part are empty, and those it cuts are filled") {
  const MappedScene scene(R"(
ambient = "vacuum"
[[part]]
name = "crystal"
sphere = { radius = "4 mm" }
medium = "LSO_roncali2013"
surface = "flat"
[[part.face]]
name = "exit"
select = { box = { low = ["-9 mm", "-9 mm", "-9 mm"], high = ["9 mm", "9 mm", "0 mm"] } }
sensor = "perfect"
)" + placed(1));
  const ResponseMap map = scene.map({1.0, 1, 1});
  const ResponseGrid& grid = map.grids.at(0);
  std::size_t filled = 0;
  double furthest_filled = 0.0, nearest_empty = 1e9;
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const std::size_t z = cell % grid.cells[2], y = cell / grid.cells[2] % grid.cells[1];
    const std::size_t x = cell / grid.cells[2] / grid.cells[1];
    const Vec3 centre =
        grid.low + grid.pitch.cwiseProduct(Vec3(0.5 + double(x), 0.5 + double(y), 0.5 + double(z)));
    const double from_middle = (centre - Vec3(scene.built.scene.parts.front().bounds.center())).norm();
    if (grid.photons[cell] > 0) {
      ++filled;
      furthest_filled = std::max(furthest_filled, from_middle);
    } else {
      nearest_empty = std::min(nearest_empty, from_middle);
    }
  }
  const double half_diagonal = 0.5 * grid.pitch.norm();
  CHECK(filled < grid.size());
  CHECK(furthest_filled < 4.0 + half_diagonal);
  CHECK(nearest_empty > 4.0 - half_diagonal);
}

TEST_CASE("Impossible response maps are refused with the reason") {
  const MappedScene scene(two_ends(6.0, placed(1)));
  const auto refusal = [&](const ResponseSettings& fineness) {
    return complaint_of([&] { scene.map(fineness); });
  };
  check_contains(refusal({1e-3, 1, 1}), "24000000000 cells for 2 channels");
  check_contains(refusal({1e-7, 1, 1}), "along one edge of \"crystal\"");
  check_contains(refusal({0.01, 100'000, 100}), "keep fewer delays");

  const MappedScene other(two_ends(6.0, placed(1)));
  ResponseMap foreign = other.map({2.0, 10, 4});
  foreign.grids[0].region = RegionId(foreign.grids[0].region.index() + 1);
  check_contains(complaint_of([&] { scene.mapped(foreign); }),
                 "\"crystal\", which the response map does not cover");
}
