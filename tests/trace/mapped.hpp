#pragma once
/// Scenes whose events are made by tracing and from a map.

#include <cmath>
#include <string>
#include <vector>

#include "physics/traced.hpp"
#include "scintray/simulation/response_map.hpp"

namespace scintray::test {

/// A scene whose events are traced, or made from a map.
struct MappedScene {
  explicit MappedScene(const std::string& text) : point(ready(scene_spec(text))) {}

  simulation::ResponseMap map(const simulation::ResponseSettings& fineness, int threads = 0) const {
    simulation::RunSettings run = point->settings();
    run.threads = threads;
    run.seed += 20'000;  // light of its own, not that of the events
    return simulation::build_response_map(built.scene, point->source().regions(),
                                          point->spec().energy_source->unpolarised, fineness, run);
  }
  std::vector<tally::EventRecord> traced() const {
    return gathered([&](const simulation::RunHooks& hooks) { point->trace(hooks); });
  }
  std::vector<tally::EventRecord> mapped(const simulation::ResponseMap& map, int threads = 0) const {
    scene_file::SceneSpec spec = point->spec();
    if (threads > 0) spec.run.threads = threads;
    const simulation::SimulationPoint with_threads(std::move(spec), point->built());
    const simulation::MappedResponse response(map);
    return gathered([&](const simulation::RunHooks& hooks) { with_threads.trace(response, hooks); });
  }

  std::shared_ptr<const simulation::SimulationPoint> point;
  const scene::BuiltScene& built = *point->built();

 private:
  template <typename Run>
  std::vector<tally::EventRecord> gathered(const Run& run) const {
    std::vector<tally::EventRecord> all;
    simulation::RunHooks hooks;
    hooks.events = [&](const std::vector<tally::EventRecord>& events) {
      all.insert(all.end(), events.begin(), events.end());
    };
    run(hooks);
    return all;
  }
};

/// A crystal of 2 x 2 x `length` mm with a sensor at each end, "low" and "high".
inline std::string two_ends(double length_mm, const std::string& more) {
  return fmt::format(R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "{0} mm"]
medium = "LSO_roncali2013"
surface = "ground"
[[part.face]]
name = "ends"
select = {{ normal = [0, 0, 1] }}
surface = "flat"
[[part.face]]
name = "other_end"
select = {{ normal = [0, 0, -1] }}
surface = "flat"
[[part]]
name = "low"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "crystal", side = "-z" }}
sensor = "perfect"
[[part]]
name = "high"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "crystal", side = "+z" }}
sensor = "perfect"
{1}
[surfaces.ground]
model = "unified"
unified = {{ sigma_alpha = "18 deg", definition = "solid_angle", facets = "projected_area", lobe = 1.0 }}
)",
                     length_mm, more);
}

/// One deposit an event of 100 keV in a part of the crystal.
inline std::string placed(int events, const std::string& slab = "") {
  return fmt::format(R"(
[source]
type = "gamma_events"
events = {}
region = {{ part = "crystal"{} }}
energy = "100 keV"
)",
                     events, slab);
}

/// Photons of events that a channel detected, and those emitted.
inline std::uint64_t detected_in(const std::vector<tally::EventRecord>& events, std::size_t channel) {
  std::uint64_t sum = 0;
  for (const tally::EventRecord& event : events) sum += event.channels.at(channel).detected;
  return sum;
}
inline std::uint64_t emitted_in(const std::vector<tally::EventRecord>& events) {
  std::uint64_t sum = 0;
  for (const tally::EventRecord& event : events) sum += event.emitted;
  return sum;
}

}  // namespace scintray::test
