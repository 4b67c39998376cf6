#include "scintray/simulation/study_results.hpp"

#include "scintray/core/pattern.hpp"
#include "scintray/io/results.hpp"

namespace scintray {

namespace {

/// Events read at a time.
constexpr std::uint64_t kPortion = 8192;

std::map<std::uint32_t, std::size_t> layers_of(const AnalysisSpec& spec,
                                               const std::vector<std::string>& parts) {
  std::map<std::uint32_t, std::size_t> layers;
  for (std::size_t layer = 0; layer < spec.layers.size(); ++layer)
    for (const NameRef& name : spec.layers[layer]) {
      bool found = false;
      for (std::uint32_t part = 0; part < parts.size(); ++part) {
        if (!matches_pattern(name.name, parts[part])) continue;
        layers[part] = layer;
        found = true;
      }
      if (!found) throw unknown_name(name.where, "part", name.name, parts);
    }
  return layers;
}

StudySetup setup_of(const AnalysisSpec& spec, const std::vector<ReadoutChannel>& channels,
                    const std::vector<std::string>& parts) {
  StudySetup setup;
  for (const ReadoutChannel& channel : channels) setup.channels_mm.push_back(channel.position);
  if (spec.depth) setup.depth = {spec.depth->origin, spec.depth->along};
  setup.layer_of_part = layers_of(spec, parts);
  setup.photopeak.window = spec.photopeak;
  setup.anger = {spec.anger_power, spec.anger_threshold};
  setup.flood.expected = spec.peaks;
  setup.ratio = spec.log_ratio ? EndRatio::logarithm : EndRatio::share;
  setup.calibration = spec.linear_calibration ? DoiCalibrationKind::linear : DoiCalibrationKind::monotone;
  setup.slices = spec.slices;
  setup.photopeak_only = spec.photopeak_only;
  return setup;
}

}  // namespace

std::vector<EventStudy> study_results(const std::filesystem::path& path, const RunResult& run,
                                      const AnalysisSpec& spec) {
  if (read_results_status(path).listed_events == 0) return {};
  const std::vector<std::uint64_t> photon_order = read_photon_order(path);
  const EventDetail detail = photon_order.empty() ? EventDetail::numbers : EventDetail::photon_times;
  std::vector<EventStudy> studies;
  std::uint64_t row = 0;
  std::vector<EventRecord> events;
  std::size_t at = 0;
  for (std::size_t point = 0; point < run.points.size(); ++point) {
    StudySetup setup = setup_of(spec, read_channels(path, point), run.header.parts);
    setup.photon_order = photon_order;
    setup.light_timing = run.points[point].light_timing;
    EventCollector collector(std::move(setup));
    for (;;) {
      if (at == events.size()) {
        events = read_events(path, row, kPortion, detail);
        row += events.size();
        at = 0;
      }
      if (events.empty() || events[at].point != point) break;
      collector.add(events[at++]);
    }
    studies.push_back(collector.finish());
  }
  return studies;
}

}  // namespace scintray
