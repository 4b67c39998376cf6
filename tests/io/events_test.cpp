// The tables of events in a results file, and their analysis.
#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/activity.hpp"
#include "scintray/core/error.hpp"
#include "scintray/results/results.hpp"
#include "scintray/scene_file/analysis.hpp"
#include "scintray/simulation/analyze_results.hpp"
#include "support/made_up_result.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::detector;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::results;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

constexpr std::uint32_t kPoints = 2, kChannels = 3;
constexpr std::uint64_t kEvents = 70'000;  ///< of each point: more than one block of rows

ReadoutSpec readout(std::uint64_t samples, std::vector<std::uint64_t> order) {
  ReadoutSpec spec;
  spec.period_ns = 0.5;
  spec.before_ns = 2.0;
  spec.window_ns = 0.5 * static_cast<double>(samples);
  spec.pulses = samples > 0;
  spec.photon_order = std::move(order);
  return spec;
}

std::vector<ReadoutChannel> channels() {
  std::vector<ReadoutChannel> list(kChannels);
  for (std::uint32_t i = 0; i < kChannels; ++i) {
    list[i].name = "sensor" + std::to_string(i);
    list[i].part = PartId(1);
    list[i].position = Vec3(i, 2.0 * i, -1.0);
    list[i].normal = Vec3(0, 0, -1);
    list[i].area_mm2 = 4.0 + i;
  }
  return list;
}

/// Channel 1 sees no light in odd events; without a readout it then has no row.
EventRecord made_up_event(std::uint32_t point, std::uint64_t number, bool read_out) {
  EventRecord event;
  const auto x = static_cast<float>(number % 1000);
  event.point = point;
  event.event = number;
  event.energy_keV = 100.0F + x;
  event.escaped_keV = 1.5F * x;
  event.non_scintillating_keV = 0.25F;
  event.position_mm = {x, -x, 0.5F};
  event.part = PartId(1);
  event.emitted = 1000 + number;
  event.channels.resize(kChannels);
  for (std::uint32_t i = 0; i < kChannels; ++i) {
    ChannelRecord& channel = event.channels[i];
    if (i == 1 && number % 2 == 1) continue;
    channel.detected = static_cast<std::uint32_t>(10 * i + number % 7 + 1);
    channel.first_ns = 0.5F + x;
    event.detected += channel.detected;
    if (!read_out) continue;
    channel.charge = 1.25F * static_cast<float>(channel.detected);
    channel.amplitude = 0.5F;
    channel.time_ns = 3.0F;
    channel.order_ns = {x, 2.0F * x};
    channel.waveform = {0.0F, x, 1.0F, -x};
  }
  if (read_out && number % 2 == 1) {  // a dark channel is read out too
    event.channels[1].charge = 0.0F;
    event.channels[1].order_ns = {-1.0F, -2.0F};
    event.channels[1].waveform = {4.0F, 5.0F, 6.0F, 7.0F};
  }
  return event;
}

std::filesystem::path written(const std::string& name, bool read_out) {
  const auto path = scratch_folder("events_" + name) / "events.h5";
  RunResult run = made_up_run();
  run.points.resize(kPoints);
  ResultsWriter writer(path, run.header, false);
  for (std::uint32_t point = 0; point < kPoints; ++point) {
    writer.begin_events(point, channels(),
                        read_out ? std::optional(readout(4, {1, 20})) : std::optional<ReadoutSpec>());
    for (std::uint64_t number = 0; number < kEvents; number += 10'000) {
      std::vector<EventRecord> block;
      for (std::uint64_t i = 0; i < 10'000; ++i) block.push_back(made_up_event(point, number + i, read_out));
      writer.append_events(block);
    }
    run.points[point].energy.events_requested = run.points[point].energy.events = kEvents;
    run.points[point].energy.deposited = 12.5;
    writer.add_point(run.points[point]);
  }
  writer.commit(true);
  return path;
}

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void check_same(const EventRecord& a, const EventRecord& b) {
  CHECK((a.point == b.point && a.event == b.event && a.energy_keV == b.energy_keV &&
         a.escaped_keV == b.escaped_keV && a.non_scintillating_keV == b.non_scintillating_keV &&
         a.position_mm == b.position_mm && a.part == b.part && a.emitted == b.emitted &&
         a.detected == b.detected));
  REQUIRE(a.channels.size() == b.channels.size());
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    const ChannelRecord &x = a.channels[i], &y = b.channels[i];
    CHECK((x.detected == y.detected && same(x.first_ns, y.first_ns) && same(x.charge, y.charge) &&
           same(x.amplitude, y.amplitude) && same(x.time_ns, y.time_ns) && x.order_ns == y.order_ns &&
           x.waveform == y.waveform));
  }
}

}  // namespace

TEST_CASE("Events come back from a file as they went in, wherever reading starts") {
  for (const bool read_out : {false, true}) {
    CAPTURE(read_out);
    const auto path = written(read_out ? "read_out" : "bare", read_out);
    CHECK(read_results_status(path).listed_events == kPoints * kEvents);
    const std::vector<ReadoutChannel> list = read_channels(path, 1);
    REQUIRE(list.size() == kChannels);
    CHECK(list[2].name == "sensor2");
    CHECK(list[2].position == Vec3(2, 4, -1));
    CHECK(list[2].area_mm2 == 6.0);
    CHECK(read_results(path).points[1].energy.deposited == 12.5);
    // 65,536 rows make a block; the last rows end with the file.
    for (const std::uint64_t offset :
         {std::uint64_t{0}, std::uint64_t{65'530}, kEvents - 5, 2 * kEvents - 9}) {
      const auto events = read_events(path, offset, 12);
      CHECK(events.size() == std::min<std::uint64_t>(12, 2 * kEvents - offset));
      for (std::size_t i = 0; i < events.size(); ++i)
        check_same(events[i], made_up_event(static_cast<std::uint32_t>((offset + i) / kEvents),
                                            (offset + i) % kEvents, read_out));
    }
    const auto numbers = read_events(path, 3, 1, EventDetail::numbers);
    CHECK(numbers.at(0).channels[0].waveform.empty());
    CHECK(numbers.at(0).channels[0].detected == made_up_event(0, 3, read_out).channels[0].detected);
    CHECK(read_events(path, 2 * kEvents, 5).empty());
  }
}

TEST_CASE("Points whose waveforms differ in length are refused with the place") {
  const auto path = scratch_folder("events_differ") / "events.h5";
  ResultsWriter writer(path, made_up_run().header, false);
  writer.begin_events(0, channels(), readout(4, {}));
  for (const ReadoutSpec& other : {readout(5, {}), readout(4, {1})})
    check_contains(complaint_of([&] { writer.begin_events(1, channels(), other); }),
                   {"differ", "number of samples"});
}

TEST_CASE("A result without events has no analysis, and reading its events is refused with what is missing") {
  const auto path = scratch_folder("events_none") / "none.h5";
  const RunResult run = made_up_run();
  ResultsWriter writer(path, run.header, false);
  for (const PointResult& point : run.points) writer.add_point(point);
  writer.commit(true);
  CHECK(analyze_results(path, run, AnalysisSpec()).empty());
  CHECK(read_channels(path, 0).empty());
  check_contains(complaint_of([&] { read_events(path, 0, 1); }), "no events");
}

TEST_CASE("The analysis of a file reports how far it is") {
  const auto path = written("progress", true);
  const RunResult run = read_results(path);
  std::vector<Activity> seen;
  const ActivityObserver observer([&](const Activity& activity) { seen.push_back(activity); });
  analyze_results(path, run, AnalysisSpec());
  REQUIRE(!seen.empty());
  CHECK(seen.front().what == "analysing the events");
  CHECK(seen.front().done == 0);
  CHECK(seen.front().total == kPoints * kEvents);
  CHECK(seen.back().done == kPoints * kEvents);
}

TEST_CASE("The analysis of a file uses the events of each point and the requested settings") {
  const auto path = written("study", true);
  const RunResult run = read_results(path);
  const AnalysisSpec spec = analysis_of_text("[analysis]\ndepth = { along = [1, 0, 0] }\n", "a.toml");
  const std::vector<EventAnalysis> analyses = analyze_results(path, run, spec);
  REQUIRE(analyses.size() == kPoints);
  double light = 0.0, energy = 0.0;
  for (std::uint64_t i = 0; i < kEvents; ++i) {
    const EventRecord event = made_up_event(0, i, true);
    energy += event.energy_keV;
    for (const ChannelRecord& channel : event.channels) light += channel.charge;
  }
  for (const EventAnalysis& analysis : analyses) {
    CHECK(analysis.events == kEvents);
    CHECK(analysis.has_readout);
    CHECK(analysis.light_per_keV.value == doctest::Approx(light / energy).epsilon(1e-6));
    REQUIRE(analysis.mean_depth_mm);
    CHECK(analysis.mean_depth_mm->value == doctest::Approx(499.5));
  }
  AnalysisSpec layers = spec;
  layers.layers = {{{"crystal", {}}}, {{"crystle", {}}}};
  check_contains(complaint_of([&] { analyze_results(path, run, layers); }), "did you mean \"crystal\"?");
}
