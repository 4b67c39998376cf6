#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/text.hpp"
#include "scintray/core/value_text.hpp"
#include "scintray/results/detail/file_ids.hpp"
#include "scintray/results/detail/goniometer_columns.hpp"
#include "scintray/results/detail/point_groups.hpp"
#include "scintray/results/detail/point_records.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

namespace {

using format::describe;
using format::fate_names;
using format::name_dimensions;
using format::put_scale;

/// One row per point: the swept values, and the fates.
void put_sweep(core::h5::Group& root, const std::vector<std::string>& keys,
               const std::vector<tally::PointResult>& points) {
  core::h5::Group group = root.create_group("sweep");
  group.set_attribute("", "description", std::string("swept values and fates of all points"));
  std::vector<double> values, fractions, errors;
  std::vector<std::int64_t> traced;
  for (const tally::PointResult& point : points) {
    for (const std::string& text : point.parameters) {
      const auto value = core::value_of_text(text);
      values.push_back(value ? value->value : std::nan(""));
    }
    for (int fate = 0; fate < core::kFateCount; ++fate) {
      const core::Estimate share = point.fraction(core::fate_at(fate));
      fractions.push_back(share.value);
      errors.push_back(share.error);
    }
    traced.push_back(static_cast<std::int64_t>(point.photons));
  }
  put_scale(group, "swept_key", keys);
  put_scale(group, "fate", fate_names());
  const core::h5::Shape by_key{points.size(), keys.size()},
      by_fate{points.size(), std::size_t{core::kFateCount}};
  const auto write = [&](const char* name, const std::vector<double>& all, const core::h5::Shape& shape) {
    group.write(name, all, shape);
    describe(group, name);
  };
  write("parameter_value", values, by_key);
  write("fate_fraction", fractions, by_fate);
  write("fate_error", errors, by_fate);
  format::put(group, "photons_traced", traced);
  const std::vector<std::string> fates{"row", "fate"};
  name_dimensions(group, {{"parameter_value", {"row", "swept_key"}},
                          {"fate_fraction", fates},
                          {"fate_error", fates},
                          {"photons_traced", {"row"}}});
}

void put_header(core::h5::Group& root, const tally::RunHeader& header) {
  root.set_attribute("", "format", std::string(format::kFormat));
  root.set_attribute("", "version", kResultsVersion);
  root.set_attribute("", "scintray_version", header.version);
  root.set_attribute("", "title", header.title);
  root.set_attribute("", "scene_file", header.scene_file);
  format::put(root, "seed", header.seed);
  format::put_text(root, "scene", {header.scene_text});
  format::put_text(root, "sweep_keys", header.sweep_keys);
  format::put_text(root, "media", header.media.values());
  format::put_text(root, "surfaces", header.surfaces.values());
  format::put_text(root, "parts", header.parts.values());
  format::put_text(root, "faces", header.faces.values());
  format::put_text(root, "fate_names", fate_names());
  for (const char* name : {"scene", "sweep_keys", "media", "surfaces", "parts", "faces", "fate_names"})
    root.make_scale(name);
}

/// Refuses a name that promises another format.
void refuse_other_name(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  for (const char* known : {"", ".h5", ".hdf5", ".hdf"})
    if (core::same_but_case(extension, known)) return;
  auto other = path;
  other.replace_extension(".h5");
  throw core::InputError({{path.string()},
                          "results are an HDF5 file, but this name ends in \"" + extension + "\"",
                          "name it " + other.string() +
                              "; the page beside it ends in .html, and h5dump or Python reads its tables"});
}

/// A result may be overwritten; any other file may be the only copy.
void refuse_foreign_file(const std::filesystem::path& path) {
  const auto status = std::filesystem::status(path);
  if (!std::filesystem::exists(status) || is_results_file(path)) return;
  throw core::InputError({{path.string()},
                          "this exists and is not a ScintRay result, so it is not written over",
                          "choose another name for the result, or move that file away"});
}

}  // namespace

struct ResultsWriter::State {
  core::h5::File file;
  core::h5::Group root, points;
  format::PointNames names;
  std::string note;
  std::vector<tally::PointResult> points_written;  ///< parameters and fates of those written
  format::RowWriter<tally::DetectedPhoton> photons;
  format::RowWriter<format::EventRow> events;
  format::RowWriter<format::SignalRow> signals;
  format::SampleWriter orders, pulses;  ///< one row per signal
  std::optional<format::PathTables> paths{};
  std::optional<HistoryWriter> histories;
  std::map<std::size_t, std::vector<tally::ReadoutChannel>> channels;  ///< per point, until it is written
};

ResultsWriter::ResultsWriter(const std::filesystem::path& path, const tally::RunHeader& header,
                             bool photon_list) {
  refuse_other_name(path);
  refuse_foreign_file(path);
  core::h5::File file = core::h5::File::create(path);
  core::h5::Group root = file.root();
  put_header(root, header);
  core::h5::Group points = root.create_group("points");
  points.set_attribute("", "description", std::string("results, one group a point of the sweep"));
  state_.reset(new State{
      std::move(file),
      root,
      points,
      {header.sweep_keys, header.media.values(), header.surfaces.values(), header.faces, header.parts},
      header.note,
      {},
      {},
      {},
      {},
      {},
      {},
      {},
      {},
      {}});
  if (photon_list) begin_photons({});
}

void ResultsWriter::begin_photons(const PhotonListLayout& layout) {
  std::string description = "detected photons, one row a photon";
  if (layout.every > 1) description += fmt::format("; one in {}", layout.every);
  state_->photons = {state_->root, "photons", description,
                     [&](const std::string& column) { return layout.has(column); }};
  core::h5::Group group = state_->root.open_group("photons");
  group.set_attribute("", "one_in", static_cast<std::int64_t>(layout.every));
  group.set_attribute("", "columns", core::list_of(layout.columns, "\n"));
  group.set_attribute("", "channels", core::list_of(layout.channels, "\n"));
}

ResultsWriter::ResultsWriter(ResultsWriter&&) noexcept = default;
ResultsWriter& ResultsWriter::operator=(ResultsWriter&&) noexcept = default;
ResultsWriter::~ResultsWriter() = default;

void ResultsWriter::add_surfaces(const std::vector<analysis::SurfaceAnalysis>& analyses) {
  format::put_surface_analyses(state_->root, analyses);
}

void ResultsWriter::append_photons(const std::vector<tally::DetectedPhoton>& photons) {
  if (!state_->photons.exists()) throw core::InternalError("photons for a result that has no photon list");
  for (const tally::DetectedPhoton& photon : photons) state_->photons.add(photon);
}

void ResultsWriter::begin_paths() { state_->paths.emplace(state_->root); }

void ResultsWriter::append_paths(std::size_t point, const std::vector<tally::PhotonPath>& paths) {
  if (!state_->paths) throw core::InternalError("photon paths for a result that has none");
  state_->paths->add(point, paths);
}

void ResultsWriter::begin_events(std::size_t point, std::vector<tally::ReadoutChannel> channels,
                                 const std::optional<detector::ReadoutSpec>& readout) {
  state_->channels[point] = std::move(channels);
  const std::size_t orders = readout ? readout->photon_order.size() : 0;
  const std::size_t samples = readout && readout->pulses ? readout->samples() : 0;
  if (state_->events.exists()) {
    if (orders != state_->orders.width() || samples != state_->pulses.width())
      throw core::InputError(
          {readout ? readout->where : core::FileLocation{},
           "the points of the sweep differ in the number of samples or of n-th photons",
           "keep readout.window, readout.sampling, pulses and photon_order the same in all points, "
           "or run them separately"});
    return;
  }
  state_->events = {state_->root, "events", "events, one row an event"};
  state_->signals = {state_->root, "signals", "signals of channels, one row an event and channel"};
  if (orders > 0) {
    state_->orders = {state_->root, "photon_times", "times of the n-th photons, one row a signal", orders};
    format::put(state_->orders.group(), "order", readout->photon_order);
  }
  if (samples > 0) {
    state_->pulses = {state_->root, "pulses", "waveforms, one row a signal", samples};
    format::put(state_->pulses.group(), "period_ns", readout->period_ns);
    format::put(state_->pulses.group(), "first_sample_ns", -readout->before_ns);
  }
}

void ResultsWriter::append_events(const std::vector<tally::EventRecord>& events) {
  if (!state_->events.exists()) throw core::InternalError("events for a result that has none");
  for (const tally::EventRecord& event : events) {
    const std::uint64_t row = state_->events.rows();
    state_->events.add({event, state_->signals.rows()});
    for (std::uint32_t channel = 0; channel < event.channels.size(); ++channel) {
      const tally::ChannelRecord& signal = event.channels[channel];
      if (!format::has_signal(signal)) continue;
      state_->signals.add({row, channel, signal});
      state_->orders.add(signal.order_ns);
      state_->pulses.add(signal.waveform);
    }
  }
}

void ResultsWriter::begin_histories(HistoryColumns columns) {
  state_->histories.emplace(state_->root, std::move(columns));
}

void ResultsWriter::append_histories(const tally::PhotonHistories& histories,
                                     const tally::HistorySubjects& point) {
  if (!state_->histories) throw core::InternalError("histories for a result that has none");
  state_->histories->add(histories, point);
}

void ResultsWriter::add_point(const tally::PointResult& point, const tally::HistorySubjects* history,
                              const analysis::EventAnalysis* analysis) {
  const std::size_t number = state_->points_written.size();
  tally::PointResult& kept = state_->points_written.emplace_back();
  kept.parameters = point.parameters;
  kept.fates = point.fates;
  kept.photons = point.photons;
  kept.birth_efficiency = point.birth_efficiency;
  core::h5::Group group = state_->points.create_group(format::numbered(number));
  format::put_point(group, point, state_->names);
  if (state_->histories && history) state_->histories->describe_point(group, *history);
  format::put_point_facts(group, point);
  if (analysis) format::put_event_analysis(group, *analysis, state_->names.parts);
  if (const auto channels = state_->channels.find(number); channels != state_->channels.end()) {
    format::put_channels(group, channels->second);
    state_->channels.erase(channels);
  }
}

void ResultsWriter::set_note(const std::string& note) { state_->note = note; }

void ResultsWriter::commit(bool complete, const std::string& reason_if_partial) {
  state_->photons.write_waiting();
  state_->events.write_waiting();
  state_->signals.write_waiting();
  state_->orders.write_waiting();
  state_->pulses.write_waiting();
  if (state_->histories) state_->histories->write_waiting();
  if (state_->paths) state_->paths->finish();
  format::put_text(state_->root, "note", {state_->note});
  state_->root.make_scale("note");
  put_sweep(state_->root, state_->names.keys, state_->points_written);
  state_->root.set_attribute("", "complete", static_cast<std::int64_t>(complete));
  state_->root.set_attribute("", "partial_reason", complete ? std::string() : reason_if_partial);
  state_->file.commit();
}

}  // namespace scintray::results
