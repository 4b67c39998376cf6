// Events from a response map against events traced photon by photon.
#include <algorithm>

#include "trace/mapped.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::tally;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

/// Photons of each cell of the maps of these tests.
constexpr std::uint32_t kPerCell = 4'000;

/// Standard error of a mean of mapped probabilities: the binomial one of `photons` photons and that of the
/// map, whose cells enter with weights of this sum of squares.
double mapped_error(double probability, std::uint64_t photons, double squared_weights) {
  const double variance = probability * (1.0 - probability);
  return std::sqrt(variance / static_cast<double>(photons) + variance * squared_weights / kPerCell);
}

void check_shares(const std::vector<EventRecord>& traced, const std::vector<EventRecord>& mapped,
                  double squared_weights) {
  REQUIRE(traced.size() == mapped.size());
  const std::uint64_t emitted = emitted_in(traced);
  REQUIRE(emitted_in(mapped) == emitted);
  for (std::size_t channel = 0; channel < traced.front().channels.size(); ++channel) {
    CAPTURE(channel);
    const Estimate direct = binomial_estimate(detected_in(traced, channel), emitted);
    const double share = static_cast<double>(detected_in(mapped, channel)) / static_cast<double>(emitted);
    const Estimate from_map{share, mapped_error(share, emitted, squared_weights)};
    MESSAGE("channel " << channel << ": traced " << direct.value << " +- " << direct.error << ", mapped "
                       << from_map.value << " +- " << from_map.error);
    CHECK(sigmas(direct, from_map) < kSigmas);
  }
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Mean and standard deviation, with standard errors that `independent` of the values would have; that of
/// the deviation is sqrt((m4 - m2^2) / (4 m2 n)) (Kendall and Stuart, The Advanced Theory of Statistics,
/// vol. 1, section 10.5).
std::pair<Estimate, Estimate> mean_and_spread(const std::vector<double>& values, double independent) {
  const double mean = mean_of(values);
  double m2 = 0.0, m4 = 0.0;
  for (const double value : values) {
    const double square = (value - mean) * (value - mean);
    m2 += square;
    m4 += square * square;
  }
  m2 /= static_cast<double>(values.size());
  m4 /= static_cast<double>(values.size());
  return {{mean, std::sqrt(m2 / independent)},
          {std::sqrt(m2), std::sqrt((m4 - m2 * m2) / (4.0 * m2 * independent))}};
}

}  // namespace

TEST_CASE("Light detected at both ends against depth is the same from a response map as traced") {
  const ResponseMap map = MappedScene(two_ends(10.0, placed(1))).map({1.0, kPerCell, 64});
  // Slabs as thick as a layer of 2 x 2 cells: over each, linear interpolation gives its layer 3/4 of the
  // weight and the two beside it 1/8 each; the outermost layer has 7/8 and lends 1/8.
  for (const double low : {0.0, 2.0, 5.0, 9.0}) {
    CAPTURE(low);
    const MappedScene scene(
        two_ends(10.0, placed(60, fmt::format(", slab_z = [\"{} mm\", \"{} mm\"]", low, low + 1.0))));
    const bool outermost = low == 0.0 || low == 9.0;
    const double layers = outermost ? 49.0 / 64.0 + 1.0 / 64.0 : 9.0 / 16.0 + 2.0 / 64.0;
    check_shares(scene.traced(), scene.mapped(map), layers / 4.0);
  }
}

TEST_CASE("Four sensors under a slab share its light alike from a response map and traced") {
  std::string text = R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["8 mm", "8 mm", "4 mm"]
medium = "LSO_roncali2013"
surface = "white"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "flat"
)";
  for (const int x : {-1, 1})
    for (const int y : {-1, 1})
      text += fmt::format(R"(
[[part]]
name = "sensor_{0}_{1}"
box = {{ low = ["{2} mm", "{3} mm", "-1 mm"], high = ["{4} mm", "{5} mm", "0 mm"] }}
sensor = "perfect"
)",
                          x > 0 ? "right" : "left", y > 0 ? "up" : "down", x > 0 ? 0 : -4, y > 0 ? 0 : -4,
                          x > 0 ? 4 : 0, y > 0 ? 4 : 0);
  const MappedScene scene(
      text + placed(60, R"(, box = { low = ["1 mm", "0 mm", "2 mm"], high = ["3 mm", "2 mm", "3 mm"] })"));
  const std::vector<EventRecord> traced = scene.traced();
  // Four cells across, one along z and its neighbours: no cell has more than 3/4^3 / 4 of the weight, and the
  // sum of squares over all is that of one axis, cubed: (9/16 + 2/64) of a cell alone, and two cells beside
  // each other have (7/8)^2 / 2 + 2 (1/8)^2 / 4.
  const double along = 9.0 / 16.0 + 2.0 / 64.0, across = 49.0 / 128.0 + 1.0 / 128.0;
  check_shares(traced, scene.mapped(scene.map({1.0, kPerCell, 64})), along * across * across);
  CHECK(detected_in(traced, 3) > detected_in(traced, 0));
}

TEST_CASE("Times from emission to detection have the mean and spread of traced photons") {
  const MappedScene scene(two_ends(10.0, placed(1)));
  const ResponseMap map = scene.map({1.0, kPerCell, 256});
  const MappedResponse response(map);

  SceneSpec photons = scene_spec(two_ends(10.0, R"(
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
photons = 100_000
[run]
photon_list = true
)"));
  const SimulationPoint light(photons, scene.point->built());
  const TallyPlan& plan = light.plan();
  std::vector<std::vector<double>> traced(2), mapped(2);
  RunHooks hooks;
  hooks.detected = [&](const std::vector<DetectedPhoton>& list) {
    for (const DetectedPhoton& photon : list)
      traced[plan.channels.list[0].part == photon.part ? 0 : 1].push_back(photon.time_ns);
  };
  light.trace(hooks);

  Rng rng(1, StreamKind::other, 0);
  const PartInfo& crystal = scene.built.scene.parts.front();
  std::vector<PlaceResponse> seen;
  for (int i = 0; i < 300'000; ++i) {
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    response.at(crystal.bounds.min() + crystal.bounds.sizes().cwiseProduct(Vec3(x, y, z)), crystal.region,
                seen);
    for (std::size_t channel = 0; channel < 2; ++channel)
      if (rng.uniform() < seen[channel].probability())
        mapped[channel].push_back(seen[channel].sample_delay(rng));
  }
  for (std::size_t channel = 0; channel < 2; ++channel) {
    CAPTURE(channel);
    // As many are independent as the map kept: half its list, or fewer when fewer were drawn.
    const double independent = 1.0 / (2.0 / static_cast<double>(map.grids[0].delays_ns.size()) +
                                      1.0 / static_cast<double>(mapped[channel].size()));
    const auto direct = mean_and_spread(traced[channel], static_cast<double>(traced[channel].size()));
    const auto from_map = mean_and_spread(mapped[channel], independent);
    MESSAGE("mean " << direct.first.value << " +- " << direct.first.error << " ns traced, "
                    << from_map.first.value << " +- " << from_map.first.error << " ns mapped; spread "
                    << direct.second.value << " +- " << direct.second.error << ", " << from_map.second.value
                    << " +- " << from_map.second.error);
    CHECK(sigmas(direct.first, from_map.first) < kSigmas);
    CHECK(sigmas(direct.second, from_map.second) < kSigmas);
  }
}

TEST_CASE("First photons and read-out signals of events are the same from a response map as traced") {
  const std::string readout = R"(
[readout]
sampling = "1 GHz"
before = "10 ns"
window = "300 ns"
shaping = { order = 1, time_constant = "10 ns" }
threshold = 3.0
)";
  const auto compare = [](const MappedScene& scene, const ResponseMap& map, float ChannelRecord::*number,
                          double map_error) {
    const std::vector<EventRecord> traced = scene.traced(), mapped = scene.mapped(map);
    REQUIRE(traced.size() == mapped.size());
    for (std::size_t channel = 0; channel < 2; ++channel) {
      CAPTURE(channel);
      Moments difference, sum;  // event by event: both have the same places and photons
      for (std::size_t i = 0; i < traced.size(); ++i) {
        difference.add(mapped[i].channels[channel].*number - traced[i].channels[channel].*number);
        sum.add(traced[i].channels[channel].*number);
      }
      const Estimate mean = difference.mean();
      MESSAGE("traced " << sum.mean().value << ", mapped differs by " << mean.value << " +- " << mean.error);
      CHECK(std::abs(mean.value) < kSigmas * std::hypot(mean.error, map_error * sum.mean().value));
    }
  };
  const MappedScene plain(two_ends(10.0, placed(150)));
  const ResponseMap map = plain.map({1.0, kPerCell, 256});
  // The map's own error in a time of flight of some 0.1 ns, from 10,000 kept ones, is far below that of the
  // first times of 150 events, whose spread is as large.
  compare(plain, map, &ChannelRecord::first_ns, 0.0);
  // Events are all over the 40 cells, each of which detects at least a tenth of its light.
  const double map_error = std::sqrt(0.9 / 0.1 / (40.0 * kPerCell));
  const MappedScene behind(two_ends(10.0, placed(150) + readout));
  compare(behind, map, &ChannelRecord::charge, map_error);
  compare(behind, map, &ChannelRecord::amplitude, map_error);
}
