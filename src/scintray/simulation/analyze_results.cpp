#include "scintray/simulation/analyze_results.hpp"

#include "scintray/core/activity.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/results/results.hpp"

namespace scintray::simulation {

namespace {

/// Events read at a time.
constexpr std::uint64_t kPortion = 8192;

std::map<core::PartId, std::size_t> layers_of(const scene_file::AnalysisSpec& spec,
                                              const core::IdVector<core::PartId, std::string>& parts) {
  std::map<core::PartId, std::size_t> layers;
  for (std::size_t layer = 0; layer < spec.layers.size(); ++layer)
    for (const config::NameRef& name : spec.layers[layer]) {
      bool found = false;
      for (const core::PartId part : parts.ids()) {
        if (!core::matches_pattern(name.name, parts[part])) continue;
        layers[part] = layer;
        found = true;
      }
      if (!found) throw core::unknown_name(name.where, "part", name.name, parts.values());
    }
  return layers;
}

}  // namespace

analysis::AnalysisSetup analysis_setup(const scene_file::AnalysisSpec& spec,
                                       const std::vector<tally::ReadoutChannel>& channels,
                                       const core::IdVector<core::PartId, std::string>& parts) {
  analysis::AnalysisSetup setup;
  for (const tally::ReadoutChannel& channel : channels) setup.channels_mm.push_back(channel.position);
  if (spec.depth) setup.depth = {spec.depth->origin, spec.depth->along};
  setup.layer_of_part = layers_of(spec, parts);
  setup.photopeak.window = spec.photopeak;
  setup.anger = {spec.anger_power, spec.anger_threshold};
  setup.flood.expected = spec.peaks;
  setup.ratio = spec.log_ratio ? analysis::EndRatio::logarithm : analysis::EndRatio::share;
  setup.calibration =
      spec.linear_calibration ? analysis::DoiCalibrationKind::linear : analysis::DoiCalibrationKind::monotone;
  setup.slices = spec.slices;
  setup.photopeak_only = spec.photopeak_only;
  return setup;
}

std::vector<analysis::EventAnalysis> analyze_results(const std::filesystem::path& path,
                                                     const tally::RunResult& run,
                                                     const scene_file::AnalysisSpec& spec) {
  const std::uint64_t listed = results::read_results_status(path).listed_events;
  if (listed == 0) return {};
  const std::vector<std::uint64_t> photon_order = results::read_photon_order(path);
  const results::EventDetail detail =
      photon_order.empty() ? results::EventDetail::numbers : results::EventDetail::photon_times;
  std::vector<analysis::EventAnalysis> analyses;
  std::uint64_t row = 0;
  std::vector<tally::EventRecord> events;
  std::size_t at = 0;
  for (std::size_t point = 0; point < run.points.size(); ++point) {
    analysis::AnalysisSetup setup =
        analysis_setup(spec, results::read_channels(path, point), run.header.parts);
    setup.photon_order = photon_order;
    setup.light_timing = run.points[point].light_timing;
    analysis::EventCollector collector(std::move(setup));
    for (;;) {
      if (at == events.size()) {
        core::report_activity("analysing the events", row, listed);
        events = results::read_events(path, row, kPortion, detail);
        row += events.size();
        at = 0;
      }
      if (events.empty() || events[at].point != point) break;
      collector.add(events[at++]);
    }
    analyses.push_back(collector.finish());
  }
  return analyses;
}

RunningAnalysis::RunningAnalysis(const tally::RunHeader& header)
    : parts_(header.parts), spec_(scene_file::analysis_of_text(header.scene_text, header.scene_file)) {}

void RunningAnalysis::begin_point(const std::vector<tally::ReadoutChannel>& channels,
                                  const std::optional<detector::ReadoutSpec>& readout) {
  analysis::AnalysisSetup setup = analysis_setup(spec_, channels, parts_);
  if (readout) setup.photon_order = readout->photon_order;
  collector_.emplace(std::move(setup));
}

void RunningAnalysis::add(const std::vector<tally::EventRecord>& events) {
  for (const tally::EventRecord& event : events) collector_->add(event);
}

std::optional<analysis::EventAnalysis> RunningAnalysis::finish_point(const tally::PointResult& result) {
  if (!collector_) return std::nullopt;
  collector_->set_light_timing(result.light_timing);
  const analysis::EventAnalysis analysis = collector_->finish();
  collector_.reset();
  return analysis;
}

}  // namespace scintray::simulation
