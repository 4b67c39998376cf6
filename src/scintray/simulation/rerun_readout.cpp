
#include <map>

#include "scintray/core/activity.hpp"
#include "scintray/core/error.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"
#include "scintray/simulation/analyze_results.hpp"
#include "scintray/simulation/simulation.hpp"
#include "scintray/tally/event_tally.hpp"

namespace scintray::simulation {

namespace {

constexpr std::uint64_t kRows = 8192;

core::InputError not_to_read_out(const std::filesystem::path& path, const std::string& what,
                                 const std::string& hint) {
  return core::InputError({{path.string()}, what, hint});
}

/// The photons of a result, event after event.
class ListedPhotons {
 public:
  explicit ListedPhotons(const std::filesystem::path& path) : path_(path) {}

  /// The next photon of this event; null after the last.
  const tally::DetectedPhoton* next(std::uint32_t point, std::uint64_t event) {
    if (at_ == photons_.size()) {
      offset_ += photons_.size();
      photons_ = results::read_photons(path_, offset_, kRows);
      at_ = 0;
    }
    if (at_ == photons_.size() || photons_[at_].point != point || photons_[at_].event != event)
      return nullptr;
    return &photons_[at_++];
  }

 private:
  std::filesystem::path path_;
  std::vector<tally::DetectedPhoton> photons_;
  std::uint64_t offset_ = 0;
  std::size_t at_ = 0;
};

/// The channels of one point, with the new electronics.
class PointElectronics {
 public:
  PointElectronics(const std::filesystem::path& path, const tally::RunResult& run,
                   const SimulationPoint& point, const std::vector<tally::ReadoutChannel>& recorded)
      : path_(path),
        run_(run),
        plan_(point.plan()),
        settings_(point.settings()),
        arrivals_(plan_.channels.list.size()) {
    const tally::TallyPlan& plan = plan_;
    for (std::uint32_t i = 0; i < plan.channels.list.size(); ++i) {
      const tally::ReadoutChannel& channel = plan.channels.list[i];
      if (i >= recorded.size() || recorded[i].name != channel.name) break;
      numbers_[channel.name] = i;
    }
    if (numbers_.size() != recorded.size() || recorded.size() != plan.channels.list.size())
      throw not_to_read_out(path, "the scene of this result has other sensors than those of its events",
                            "a file that the scene names has changed since; run it again");
  }

  /// Computes the signals of an event from its photons.
  void read_out(tally::EventRecord& event, ListedPhotons& photons) {
    for (std::vector<detector::Arrival>& arrivals : arrivals_) arrivals.clear();
    std::uint64_t listed = 0;
    for (; const tally::DetectedPhoton* photon = photons.next(event.point, event.event); ++listed)
      add(*photon);
    if (listed != event.detected)
      throw results::format::damaged(path_, std::to_string(listed) + " photons listed of " +
                                                std::to_string(event.detected) + " detected in event " +
                                                std::to_string(event.event));
    event.channels.assign(arrivals_.size(), {});
    for (std::uint32_t channel = 0; channel < arrivals_.size(); ++channel) {
      tally::ChannelRecord& record = event.channels[channel];
      record.detected = static_cast<std::uint32_t>(arrivals_[channel].size());
      core::Rng rng = sensor_stream(settings_, event.event, channel);
      tally::write_signal(plan_.readout[channel].respond(arrivals_[channel], rng), record);
    }
  }

 private:
  void add(const tally::DetectedPhoton& photon) {
    if (!run_.header.parts.contains(photon.part) || !run_.header.faces.contains(photon.face))
      throw results::format::damaged(path_, "a photon names a part or face that does not exist");
    auto known = numbers_.find(run_.header.parts[photon.part]);
    if (known == numbers_.end()) known = numbers_.find(run_.header.faces[photon.face]);
    if (known == numbers_.end())
      throw results::format::damaged(path_, "a photon was detected by no channel of its point");
    const tally::ReadoutChannel& channel = plan_.channels.list[known->second];
    const core::Vec3 place(photon.position_mm[0], photon.position_mm[1], photon.position_mm[2]);
    const core::Vec3 from = place - channel.position;
    arrivals_[known->second].push_back(
        {static_cast<double>(photon.time_ns), from.dot(channel.x), from.dot(channel.y)});
  }

  const std::filesystem::path& path_;
  const tally::RunResult& run_;
  const tally::TallyPlan& plan_;
  RunSettings settings_;
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::vector<detector::Arrival>> arrivals_;
};

}  // namespace

void rerun_readout(const std::filesystem::path& path, const tally::RunResult& run,
                   const detector::ReadoutSpec& readout, const std::filesystem::path& output,
                   SimulationOptions options, const scene_file::Extensions& extensions) {
  const results::ResultsStatus status = results::read_results_status(path);
  if (status.listed_events == 0)
    throw not_to_read_out(path, "this result has no events to read out",
                          "run a scene whose [source] is an event source");
  if (!status.has_photon_list)
    throw not_to_read_out(path, "this result has no list of detected photons to read out again",
                          "write photon_list = true in [run] of the scene and run it again");
  if (!results::read_photon_layout(path).is_whole())
    throw not_to_read_out(
        path, "the list of photons of this result has not all columns of every photon",
        "remove photon_columns, photon_sample and photon_channels from [run] and run it again");
  std::error_code ignored;
  if (std::filesystem::equivalent(path, output, ignored))
    throw not_to_read_out(output, "the new result would replace its own source", "name another file");
  const scene_file::SceneFile file =
      scene_file::SceneFile::from_text(run.header.scene_text, run.header.scene_file, extensions);
  tally::RunHeader header = run.header;
  header.note += (header.note.empty() ? "" : "\n") + std::string("electronics applied again by ") +
                 readout.where.file + " from the photons of " + path.filename().string();
  results::ResultsWriter writer(output, header, false);
  RunningAnalysis analysis(header);
  options.seed = run.header.seed;
  options.change = [&, own = options.change](scene_file::SceneSpec& spec) {
    if (own) own(spec);
    spec.readout = readout;
    spec.run.photon_list = spec.run.photon_history = false;
  };
  Simulation simulation(file, options);
  ListedPhotons photons(path);
  std::vector<tally::EventRecord> events;
  std::uint64_t row = 0;
  std::size_t at = 0;
  for (std::size_t number = 0; number < run.points.size(); ++number) {
    const auto built = simulation.point(number);
    const std::vector<tally::ReadoutChannel> recorded = results::read_channels(path, number);
    writer.begin_events(number, recorded, readout);
    analysis.begin_point(recorded, readout);
    PointElectronics electronics(path, run, *built, recorded);
    for (;;) {
      if (at == events.size()) {
        core::report_activity("applying the electronics", row, status.listed_events);
        events = results::read_events(path, row, kRows, results::EventDetail::numbers);
        row += events.size();
        at = 0;
      }
      if (events.empty() || events[at].point != number) break;
      electronics.read_out(events[at], photons);
      writer.append_events({events[at]});
      analysis.add({events[at++]});
    }
    tally::PointResult point = run.points[number];
    point.light_timing = built->timing();
    point.omitted = built->omitted();
    const std::optional<analysis::EventAnalysis> analyzed = analysis.finish_point(point);
    writer.add_point(point, nullptr, analyzed ? &*analyzed : nullptr);
    simulation.release(number);
  }
  writer.commit(run.complete(), run.partial_reason);
}

}  // namespace scintray::simulation
