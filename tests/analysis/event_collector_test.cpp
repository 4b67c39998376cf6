// All analyses of a point, from made-up events.
#include "scintray/analysis/event_analysis.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "analysis/made_up_events.hpp"
#include "support/agreement.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::test;
using doctest::Approx;

TEST_CASE("Events of a dual-ended array have every analysis") {
  const MadeUpDetector detector;
  const EventAnalysis analysis = analyze_events(detector.events(6000, true), detector.setup());
  for (const std::string& line : analysis.left_out) MESSAGE(line);
  CHECK(analysis.left_out.empty());
  CHECK(analysis.events == 6000);
  // A Compton event of a keV or less may leave no photon.
  CHECK(analysis.pulses > 5980);
  CHECK(analysis.has_readout);
  REQUIRE(analysis.spectrum);
  CHECK(analysis.peak.status == PeakStatus::trusted);
  CHECK(analysis.selected > 2000);
  CHECK(analysis.selected < analysis.pulses);
  REQUIRE(analysis.light_against_depth);
  CHECK(analysis.light_against_depth->points.size() == 10);
  REQUIRE(analysis.doi);
  CHECK(sigmas(analysis.doi->residual.mean, {0.0, 0.0}) < kSigmas);
  REQUIRE(analysis.flood);
  CHECK(analysis.flood->peaks.size() == 16);
  CHECK(analysis.flood->share_right.value > 0.95);
  REQUIRE(analysis.pair_difference_ns);
  REQUIRE(analysis.first_photon_difference_ns);
  REQUIRE(analysis.end_difference_ns);
  REQUIRE(analysis.timing_against_depth);
  CHECK(analysis.timing_against_depth->slices.size() == 10);
}

TEST_CASE("Without a readout photons are the light and first photons the time") {
  const MadeUpDetector detector;
  const EventAnalysis analysis = analyze_events(detector.events(3000, false), detector.setup());
  CHECK_FALSE(analysis.has_readout);
  CHECK(analysis.pair_difference_ns);
  CHECK_FALSE(analysis.first_photon_difference_ns);
  CHECK(analysis.spectrum->low - std::floor(analysis.spectrum->low) == 0.5);  // whole numbers
}

TEST_CASE("The flood map is of one plane and the ends are two") {
  const MadeUpDetector detector;
  AnalysisSetup setup = detector.setup();
  const auto layout = layout_of(setup.channels_mm, setup.depth);
  REQUIRE(layout);
  CHECK(layout->near.size() == 16);
  CHECK(layout->far.size() == 16);
  // Turned round, the far end is the near one.
  setup.depth->direction = -Vec3::UnitZ();
  CHECK(layout_of(setup.channels_mm, setup.depth)->near.front() == 16);
  // One plane, whose axis need not be given.
  const std::vector<Vec3> plane(setup.channels_mm.begin(), setup.channels_mm.begin() + 16);
  const auto flat = layout_of(plane, std::nullopt);
  REQUIRE(flat);
  CHECK(flat->far.empty());
  CHECK(flat->across({1.0, 2.0, 3.0}) == std::array<double, 2>{1.0, 2.0});
  // A third plane between the two ends.
  setup.channels_mm.emplace_back(0.0, 0.0, 9.0);
  CHECK_FALSE(layout_of(setup.channels_mm, setup.depth));
  CHECK_FALSE(layout_of({}, std::nullopt));
}

TEST_CASE("An analysis that does not apply has the reason") {
  const MadeUpDetector detector;
  AnalysisSetup setup = detector.setup();
  std::vector<EventRecord> events = detector.events(3000, true);
  SUBCASE("no depth") {
    setup.depth.reset();
    const EventAnalysis analysis = analyze_events(events, setup);
    CHECK_FALSE(analysis.doi);
    CHECK_FALSE(analysis.light_against_depth);
    CHECK_FALSE(depth_point(analysis));
    for (const char* name : {"light against depth", "depth of interaction", "timing against depth"})
      CHECK_MESSAGE(reason_left_out(analysis, name) != "", name);
  }
  SUBCASE("few times at one end") {
    for (std::size_t i = 20; i < events.size(); ++i)
      for (std::size_t channel = 16; channel < events[i].channels.size(); ++channel)
        events[i].channels[channel].time_ns = std::nanf("");
    const EventAnalysis analysis = analyze_events(events, setup);
    CHECK(analysis.pair_difference_ns);
    CHECK_FALSE(analysis.end_difference_ns);
    check_contains(reason_left_out(analysis, "time between the ends"),
                   {" events with a time at both ends", "50"});
  }
  SUBCASE("one depth") {
    for (EventRecord& event : events) event.position_mm[2] = 7.0F;
    const EventAnalysis analysis = analyze_events(events, setup);
    CHECK_FALSE(analysis.doi);
    CHECK_FALSE(analysis.timing_against_depth);
    std::string reasons;
    for (const std::string& line : analysis.left_out) reasons += line + "\n";
    check_contains(reasons, "light against depth: the events lie at one depth");
    check_contains(reasons, "depth of interaction: the events lie at one depth");
    check_contains(reasons, "timing against depth: ");
    REQUIRE(depth_point(analysis));
    CHECK(depth_point(analysis)->depth_mm == Approx(7.0));
  }
  SUBCASE("no fluctuation") {
    for (EventRecord& event : events)
      for (ChannelRecord& channel : event.channels) channel.charge = 10.0F;
    const EventAnalysis analysis = analyze_events(events, setup);
    CHECK(analysis.peak.status == PeakStatus::no_peak);
    CHECK_FALSE(analysis.light_against_depth);
    CHECK_FALSE(analysis.doi);
  }
  SUBCASE("dark counts, which have no position") {
    for (std::size_t i = 0; i < events.size(); i += 2) events[i].part = PartId::none();
    const EventAnalysis analysis = analyze_events(events, setup);
    CHECK(analysis.pulses > 2980);
    REQUIRE(analysis.flood);
    CHECK(analysis.flood->crystals.size() == 16);
    REQUIRE(analysis.doi);
    CHECK(analysis.doi->residual.count < analysis.selected / 3);
    REQUIRE(analysis.mean_depth_mm);
    CHECK(analysis.mean_depth_mm->value == Approx(10.0).epsilon(0.05));
  }
  SUBCASE("few events") {
    events.resize(40);
    const EventAnalysis analysis = analyze_events(events, setup);
    CHECK(analysis.peak.status == PeakStatus::too_few);
    CHECK(analysis.selected == 40);
    CHECK(analysis.selection == "all pulses");
    CHECK(analysis.left_out.size() >= 3);
  }
  SUBCASE("no events") {
    const EventAnalysis analysis = analyze_events({}, setup);
    CHECK(analysis.events == 0);
    CHECK_FALSE(analysis.spectrum);
    CHECK_FALSE(depth_point(analysis));
  }
  SUBCASE("no light") {
    for (EventRecord& event : events)
      for (ChannelRecord& channel : event.channels) channel.charge = 0.0F;
    CHECK(analyze_events(events, setup).pulses == 0);
  }
}

TEST_CASE("Layers are classified by the ratio of the ends and by the flood map") {
  const MadeUpDetector detector;
  AnalysisSetup setup = detector.setup();
  std::vector<EventRecord> events = detector.events(6000, true);
  for (EventRecord& event : events)
    if (event.position_mm[2] > 10.0F) event.part = PartId(event.part.index() + 100);
  for (std::uint32_t part = 0; part < 200; ++part) setup.layer_of_part[PartId(part)] = part < 100 ? 0 : 1;
  const EventAnalysis analysis = analyze_events(events, setup);
  REQUIRE(analysis.layers_by_ratio);
  CHECK(analysis.layers_by_ratio->confusion.share_right().value > 0.9);
  // Layers right above each other look alike in a flood map: no better than a coin, and the analysis states
  // so.
  REQUIRE(analysis.layers_by_flood);
  CHECK(analysis.layers_by_flood->share_right().value < 0.6);
}

TEST_CASE("Events of another detector are refused") {
  const MadeUpDetector detector;
  EventCollector collector(detector.setup());
  EventRecord event;
  event.event = 12;
  event.channels.resize(3);
  check_contains(complaint_of([&] { collector.add(event); }), "event 12 has 3 readout channels; expected 32");
}
