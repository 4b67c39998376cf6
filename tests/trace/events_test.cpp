// Events of energy, traced.
#include <cmath>
#include <cstring>

#include "physics/traced.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

std::string scene_with(const std::string& source, const std::string& more = "") {
  return R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["4 mm", "4 mm", "10 mm"]
medium = "LSO_roncali2013"
surface = "flat"
)" + more +
         R"(
[[part]]
name = "pmt"
box = ["4 mm", "4 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "perfect"
)" + source;
}

const std::string kGammas = R"(
[source]
type = "gammas"
events = 60
emission = "gamma"
energy = "300 keV"
position = ["0 mm", "0 mm", "30 mm"]
direction = [0, 0, -1]
vacuum = ["pmt"]
)";

const std::string kPlaced = R"(
[source]
type = "gamma_events"
events = 40
region = { part = "crystal" }
energy = "100 keV"
)";

std::uint64_t total(const std::vector<EventRecord>& events, std::uint64_t EventRecord::*member) {
  std::uint64_t sum = 0;
  for (const EventRecord& event : events) sum += event.*member;
  return sum;
}

}  // namespace

TEST_CASE("Events are the same to the last bit for 1, 2 and 7 threads") {
  const Traced one = trace(scene_with(kGammas), 1);
  for (const int threads : {2, 7}) {
    const Traced other = trace(scene_with(kGammas), threads);
    CHECK(other.result.fates == one.result.fates);
    CHECK(other.result.energy.deposited == one.result.energy.deposited);
    REQUIRE(other.events.size() == one.events.size());
    for (std::size_t i = 0; i < one.events.size(); ++i) {
      const EventRecord &a = one.events[i], &b = other.events[i];
      CHECK(a.event == i);
      CHECK((a.event == b.event && a.energy_keV == b.energy_keV && a.position_mm == b.position_mm &&
             a.emitted == b.emitted && a.detected == b.detected));
      CHECK(std::memcmp(&a.channels[0].first_ns, &b.channels[0].first_ns, sizeof(float)) == 0);
    }
  }
}

TEST_CASE("Every event's energy is in its record, and its photons in the fates") {
  const Traced traced = trace(scene_with(kGammas));
  const EnergyBalance& energy = traced.result.energy;
  CHECK(energy.events_requested == 60);
  CHECK(energy.events == 60);
  CHECK(energy.started == doctest::Approx(60 * 300.0));
  CHECK(energy.deposited + energy.escaped + energy.non_scintillating ==
        doctest::Approx(energy.started).epsilon(1e-9));
  CHECK(energy.silent > 0);
  CHECK(energy.silent < 60);
  for (const EventRecord& event : traced.events) {
    CHECK(event.energy_keV + event.escaped_keV + event.non_scintillating_keV ==
          doctest::Approx(300.0).epsilon(1e-5));
    CHECK((event.energy_keV > 0.0f) == (event.emitted > 0));
    REQUIRE(event.channels.size() == 1);
    CHECK(event.channels[0].detected == event.detected);
    CHECK((event.detected > 0) == !std::isnan(event.channels[0].first_ns));
  }
  CHECK(total(traced.events, &EventRecord::emitted) == traced.result.photons);
  CHECK(total(traced.events, &EventRecord::detected) == traced.result.count(Fate::detected));
  CHECK(energy.detected.count == 60 - energy.silent);
  CHECK(energy.detected.sum == static_cast<double>(traced.result.count(Fate::detected)));
}

TEST_CASE("Light of events and light of photons placed alike have the same fates") {
  const Traced events = trace(scene_with(kPlaced));
  const Traced photons = trace(scene_with(R"(
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
time = "decay"
photons = 100_000
)"));
  // The events' places are few: their fractions spread by more than the photons' numbers alone.
  double sum = 0.0, squares = 0.0;
  for (const EventRecord& event : events.events) {
    const double share = static_cast<double>(event.detected) / static_cast<double>(event.emitted);
    sum += share;
    squares += share * share;
  }
  const auto n = static_cast<double>(events.events.size());
  const Estimate mean{sum / n, std::sqrt((squares / n - sum * sum / n / n) / (n - 1))};
  CHECK(sigmas(mean, photons.result.fraction(Fate::detected)) < kSigmas);
}

TEST_CASE("Each sensor and each face that is one has a channel, with its place and size") {
  const SceneSpec spec = scene_spec(scene_with(kPlaced, R"(
[[part.face]]
name = "back"
select = { normal = [0, 0, 1] }
sensor = "perfect"
)"));
  SceneBuilder builder;
  const BuiltScene built = builder.build(spec);
  const ReadoutChannels channels(built.scene);
  REQUIRE(channels.list.size() == 2);
  for (const ReadoutChannel& channel : channels.list) {
    CAPTURE(channel.name);
    const bool pmt = channel.name == "pmt";
    CHECK((pmt || channel.name == "crystal:back"));
    CHECK(channel.face.has_value() != pmt);
    CHECK((channel.position - Vec3(0, 0, pmt ? 0 : 10)).norm() < 1e-9);
    CHECK((channel.normal - Vec3(0, 0, pmt ? -1 : 1)).norm() < 1e-9);
    CHECK(channel.area_mm2 == doctest::Approx(16.0));
    CHECK(channel.width_mm == doctest::Approx(4.0));
    CHECK(channel.height_mm == doctest::Approx(4.0));
  }
}

TEST_CASE("Energy outside scintillators is refused with the reason") {
  const std::string glass = R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["4 mm", "4 mm", "10 mm"]
medium = "glass"
surface = "flat"
)" + kPlaced;
  CHECK(contains(complaint_of([&] { SceneBuilder().build(scene_spec(glass)); }), "no part scintillates"));
}

TEST_CASE(
    "The time of one photon is known where all light has one emission and all sensors one time spread") {
  const auto timing = [](const std::string& text) { return ready(scene_spec(text))->timing(); };
  const std::string readout =
      "[readout]\nperiod = \"1 ns\"\nbefore = \"5 ns\"\nwindow = \"100 ns\"\n"
      "shaping = { order = 1, time_constant = \"4 ns\" }\nthreshold = 1\n";
  const std::string spread = "[sensors.perfect.transit_time]\nsigma = \"0.2 ns\"\n";
  const auto known = timing(scene_with(kPlaced) + readout + spread);
  REQUIRE(known);
  CHECK(known->time_spread_ns == doctest::Approx(0.2));
  REQUIRE_FALSE(known->decay.empty());
  CHECK(known->decay.front().decay_ns > 10.0);
  CHECK_FALSE(timing(scene_with(kPlaced)));  // no electronics: no time spread either
  CHECK_FALSE(timing(scene_with(kPlaced + "cherenkov = true\n") + readout + spread));
  const std::string other =
      "[[part]]\nname = \"side\"\nbox = [\"4 mm\", \"1 mm\", \"10 mm\"]\nplace = { touch = "
      "\"crystal\", side = \"+y\" }\nsensor = \"ideal\"\n";
  CHECK_FALSE(timing(scene_with(kPlaced, other) + readout + spread));
}
