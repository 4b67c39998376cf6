#include "scintray/tally/tally_plan.hpp"

#include <algorithm>

namespace scintray::tally {

namespace {

/// Total reflections count themselves, or something is measured that they change.
bool needs_reflections(const scene_file::TallySpec& tally) {
  const auto needs = [](const auto& measured) { return measured.variable->direction_before; };
  return std::find(tally.at.begin(), tally.at.end(), core::StepEvent::reflected) != tally.at.end() ||
         std::any_of(tally.axes.begin(), tally.axes.end(), needs) ||
         std::any_of(tally.ranges.begin(), tally.ranges.end(), needs) ||
         (tally.score && tally.score->direction_before);
}

/// Parts in which light is stated to start; empty: not stated by part.
std::vector<config::NameRef> source_parts(const scene_file::SceneSpec& spec) {
  const std::variant<scene_file::RegionSpec, core::Vec3>* origin = &spec.source.origin;
  if (spec.energy_source) {
    const auto* placed = std::get_if<scene_file::SpectrumSpec>(&spec.energy_source->kind);
    origin = placed ? &placed->origin : nullptr;
  }
  const auto* region = origin ? std::get_if<scene_file::RegionSpec>(origin) : nullptr;
  return region ? std::vector<config::NameRef>{region->part} : std::vector<config::NameRef>{};
}

}  // namespace

TallyPlan::TallyPlan(const scene::Scene& scene, const scene_file::SceneSpec& spec)
    : channels(scene), photon_list(spec.run.photon_list) {
  if (spec.run.photon_history) history.emplace(scene);
  bind_ways(scene);
  bind_readout(spec, scene);
  if (spec.tallies.empty()) return;

  std::vector<std::vector<std::pair<std::uint32_t, scene_file::FaceWay>>> counts_of_face(scene.faces.size());
  for (const scene_file::TallySpec& tally : spec.tallies) {
    const auto number = static_cast<std::uint32_t>(counts.size());
    counts.push_back(bind_count(tally, source_parts(spec), scene));
    std::uint32_t events = 0;
    for (const core::StepEvent event : tally.at) {
      events |= 1u << static_cast<unsigned>(event);
      if (tally.faces.empty()) counts_on[static_cast<std::size_t>(event)].push_back(number);
    }
    events_of.push_back(events);
    for (const std::uint32_t face : faces_of(tally, scene))
      counts_of_face[face].emplace_back(number, tally.way);
    follows_reflections = follows_reflections || needs_reflections(tally);
    follows_regions = follows_regions || !counts.back().visited.empty() || !counts.back().not_visited.empty();
  }
  counts_at.resize(2 * scene.interfaces.size());
  const auto bind = [&](std::size_t way, std::int32_t face, scene_file::FaceWay seen) {
    if (face == scene::kNone) return;
    for (const auto& [count, wanted] : counts_of_face[static_cast<std::size_t>(face)])
      if (wanted == seen || wanted == scene_file::FaceWay::both)
        counts_at[way].push_back({count, static_cast<std::uint32_t>(face), seen == scene_file::FaceWay::in});
  };
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    const scene::Interface& interface = scene.interfaces[i];
    bind(2 * i + 1, interface.back_face, scene_file::FaceWay::out);
    bind(2 * i + 1, interface.front_face, scene_file::FaceWay::in);
    bind(2 * i, interface.front_face, scene_file::FaceWay::out);
    bind(2 * i, interface.back_face, scene_file::FaceWay::in);
  }
}

void TallyPlan::bind_readout(const scene_file::SceneSpec& spec, const scene::Scene& scene) {
  if (!spec.readout) return;
  if (!spec.energy_source)
    throw core::InputError({spec.readout->where,
                            "[readout] makes pulses of events, but this is a source of photons",
                            "use a source of energy (docs/gamma_sources.md), or remove [readout]"});
  for (const ReadoutChannel& channel : channels.list) {
    try {
      readout.emplace_back(scene.sensors[channel.sensor], *spec.readout,
                           detector::SensorFace{channel.width_mm, channel.height_mm});
    } catch (const core::InputError& error) {
      core::Problem problem = error.problems().front();
      problem.where = spec.readout->where;
      problem.what = "sensor \"" + channel.name + "\": " + problem.what;
      throw core::InputError(problem);
    }
  }
}

void TallyPlan::bind_ways(const scene::Scene& scene) {
  const std::size_t ways = 2 * scene.interfaces.size();
  sensor_faces.assign(ways, kNoSensor);
  for (std::uint32_t i = 0; i < scene.interfaces.size(); ++i) {
    const scene::Interface& interface = scene.interfaces[i];
    for (const bool from_back : {false, true}) {
      const std::size_t way = 2 * i + (from_back ? 1 : 0);
      const std::int32_t left_face = from_back ? interface.back_face : interface.front_face;
      const std::int32_t sensor = from_back ? interface.front_sensor : interface.back_sensor;
      if (sensor == scene::kNone) continue;
      const std::uint32_t part = from_back ? interface.front_sensor_part : interface.back_sensor_part;
      const std::int32_t own = from_back ? interface.front_face : interface.back_face;
      const std::int32_t face = own != scene::kNone ? own : left_face;
      const std::pair key{part, static_cast<std::uint32_t>(face)};
      const auto [known, is_new] = sensor_index_.try_emplace(key, sensor_face_names.size());
      if (is_new) sensor_face_names.push_back({key.first, key.second, 0, 0});
      sensor_faces[way] = static_cast<std::uint32_t>(known->second);
    }
  }
}

}  // namespace scintray::tally
