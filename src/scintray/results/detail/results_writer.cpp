#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "scintray/analysis/analysis_fields.hpp"
#include "scintray/analysis/light_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/text.hpp"
#include "scintray/core/value_text.hpp"
#include "scintray/results/detail/columns.hpp"
#include "scintray/results/detail/file_ids.hpp"
#include "scintray/results/detail/goniometer_columns.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"
#include "scintray/scene_file/tally.hpp"

namespace scintray::results {

namespace {

using format::describe;
using format::name_dimensions;
using format::numbered;
using format::put;
using format::put_text;

void put_moments(core::h5::Group& point, const std::string& name, const std::string& unit,
                 const std::string& description, const core::Moments& moments) {
  core::h5::Group group = point.create_group(name);
  group.set_attribute("", "description", description);
  group.set_attribute("", "unit", unit);
  format::put(group, "count", moments.count);
  format::put(group, "sum", moments.sum);
  format::put(group, "sum_of_squares", moments.sum_of_squares);
  format::put(group, "mean", moments.mean().value);
  format::put(group, "mean_error", moments.mean().error);
}

/// Lower ends of the bins of path length.
std::vector<double> path_bins() {
  std::vector<double> low(tally::PointResult{}.detected_path_histogram.size());
  for (std::size_t i = 0; i < low.size(); ++i) low[i] = 10.0 * static_cast<double>(i);
  return low;
}

void put_fates(core::h5::Group& group, const tally::PointResult& point) {
  std::vector<std::uint64_t> counts(point.fates.begin(), point.fates.end());
  std::vector<double> fractions, errors;
  for (int fate = 0; fate < core::kFateCount; ++fate) {
    const core::Estimate estimate = point.fraction(core::fate_at(fate));
    fractions.push_back(estimate.value);
    errors.push_back(estimate.error);
  }
  format::put(group, "fate_count", counts);
  format::put(group, "fate_fraction", fractions);
  format::put(group, "fate_error", errors);
}

/// Texts along a dimension as its scale.
void put_scale(core::h5::Group& group, const std::string& name, const std::vector<std::string>& values) {
  format::put_text(group, name, values);
  group.make_scale(name);
}

std::vector<std::string> fate_names() {
  std::vector<std::string> names;
  for (int fate = 0; fate < core::kFateCount; ++fate)
    names.emplace_back(core::fate_name(core::fate_at(fate)));
  return names;
}

void put_shifts(core::h5::Group& point, const std::string& name, const std::string& description,
                const std::vector<optics::ShiftCount>& counts) {
  core::h5::Group group = point.create_group(name);
  group.set_attribute("", "description", description);
  format::for_each_shift_column([&](const char* field, auto member) {
    std::vector<std::decay_t<decltype(optics::ShiftCount{}.*member)>> values;
    for (const optics::ShiftCount& count : counts) values.push_back(count.*member);
    format::put(group, field, values);
  });
  name_dimensions(group);
}

void put_sensor_faces(core::h5::Group& point, const std::vector<tally::SensorFaceCount>& faces) {
  core::h5::Group group = point.create_group("sensor_faces");
  group.set_attribute("", "description", std::string("photons that reached each sensor through each face"));
  std::vector<std::uint32_t> part, face;
  std::vector<std::uint64_t> detected, not_detected;
  for (const tally::SensorFaceCount& count : faces) {
    part.push_back(format::to_file(count.part));
    face.push_back(format::to_file(count.face));
    detected.push_back(count.detected);
    not_detected.push_back(count.not_detected);
  }
  format::put(group, "part", part);
  format::put(group, "face", face);
  format::put(group, "detected", detected);
  format::put(group, "unconverted", not_detected);
  name_dimensions(group);
}

/// @param faces  of the run, to one of which each tally is bound
void put_exit_angles(core::h5::Group& point, const std::vector<analysis::CrossingAngles>& tallies,
                     const core::IdVector<core::FaceId, std::string>& faces) {
  core::h5::Group group = point.create_group("exit_angles");
  group.set_attribute("", "description", std::string("histograms of crossing angles, one group a tally"));
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    core::h5::Group tally = group.create_group(format::numbered(i));
    tally.set_attribute("", "name", tallies[i].name);
    const auto face = std::find(faces.begin(), faces.end(), tallies[i].face);
    if (face == faces.end()) throw core::InternalError("exit angles at a face that the run does not have");
    tally.set_attribute("", "face", static_cast<std::int64_t>(face - faces.begin()));
    tally.set_attribute("", "detected_only", static_cast<std::int64_t>(tallies[i].detected_only));
    format::put(tally, "inside", tallies[i].inside);
    format::put(tally, "outside", tallies[i].outside);
    std::vector<double> low;
    for (std::size_t bin = 0; bin < tallies[i].inside.size(); ++bin)
      low.push_back(90.0 * static_cast<double>(bin) / static_cast<double>(tallies[i].inside.size()));
    format::put(tally, "angle_low_deg", low);
    const std::vector<std::string> angles{"angle_low_deg"};
    name_dimensions(tally, {{"angle_low_deg", angles}, {"inside", angles}, {"outside", angles}});
  }
}

void put_axis(core::h5::Group& tally, const std::string& name, const tally::TallyAxis& axis) {
  core::h5::Group group = tally.create_group(name);
  group.set_attribute("", "variable", axis.variable);
  group.set_attribute("", "unit", axis.unit);
  if (axis.names.empty()) {
    format::put(group, "edges", axis.edges);
    format::put(group, "along", std::vector<double>(axis.along.begin(), axis.along.end()));
  } else {
    format::put_text(group, "names", axis.names);
  }
  name_dimensions(group);
}

/// Those that are no exit angles.
void put_tallies(core::h5::Group& point, const std::vector<tally::TallyResult>& tallies) {
  core::h5::Group group = point.create_group("tallies");
  group.set_attribute("", "description", std::string("tallies of the scene, one group a tally"));
  std::size_t number = 0;
  for (const tally::TallyResult& from : tallies) {
    if (from.type == scene_file::kExitAngle || from.type == scene_file::kExitAngleBeyond) continue;
    core::h5::Group tally = group.create_group(format::numbered(number++));
    tally.set_attribute("", "name", from.name);
    tally.set_attribute("", "type", from.type);
    tally.set_attribute("", "score", from.score);
    tally.set_attribute("", "unit", from.unit);
    std::vector<std::size_t> shape;
    for (std::size_t k = 0; k < from.axes.size(); ++k) {
      put_axis(tally, "axis_" + std::to_string(k), from.axes[k]);
      shape.push_back(from.axes[k].bins());
    }
    tally.write("sum", from.sum, shape);
    describe(tally, "sum");
    tally.write("sum_of_squares", from.sum_of_squares, shape);
    describe(tally, "sum_of_squares");
    format::put(tally, "beyond", from.outside);
    format::put(tally, "refractive_index", from.index);
    std::vector<std::string> bins;
    for (std::size_t k = 0; k < from.axes.size(); ++k) bins.push_back("bin_" + std::to_string(k));
    name_dimensions(tally, {{"sum", bins}, {"sum_of_squares", bins}});
  }
}

void put_energy(core::h5::Group& point, const tally::EnergyBalance& energy) {
  core::h5::Group group = point.create_group("energy");
  group.set_attribute("", "description", std::string("energy of the events"));
  format::put(group, "events_requested", energy.events_requested);
  format::put(group, "events_traced", energy.events);
  format::put(group, "events_silent", energy.silent);
  format::put(group, "started_keV", energy.started);
  format::put(group, "deposited_keV", energy.deposited);
  format::put(group, "escaped_total_keV", energy.escaped);
  format::put(group, "unseen_total_keV", energy.non_scintillating);
  put_moments(group, "detected_per_event", "1",
              "photons detected per event with energy deposited in a scintillator", energy.detected);
}

void put_light_timing(core::h5::Group& point, const tally::LightTiming& timing) {
  core::h5::Group group = point.create_group("light_timing");
  group.set_attribute(
      "", "description",
      std::string("distribution of the detection time of one photon, without its time of flight"));
  std::vector<double> decay, rise, share;
  for (const optics::DecayComponent& component : timing.decay) {
    decay.push_back(component.decay_ns);
    rise.push_back(component.rise_ns);
    share.push_back(component.fraction);
  }
  format::put(group, "decay_ns", decay);
  format::put(group, "rise_ns", rise);
  format::put(group, "decay_share", share);
  format::put(group, "time_spread_ns", timing.time_spread_ns);
  name_dimensions(group);
}

void put_omitted(core::h5::Group& point, const std::vector<tally::OmittedEffect>& effects) {
  core::h5::Group group = point.create_group("omitted_effects");
  group.set_attribute("", "description",
                      std::string("physical effects that the numbers of this point do not include"));
  format::for_each_omission_text([&](const char* name, auto member) {
    std::vector<std::string> column;
    for (const tally::OmittedEffect& effect : effects) column.push_back(effect.*member);
    format::put_text(group, name, column);
  });
  format::for_each_omission_figure([&](const char* name, auto member) {
    std::vector<std::uint8_t> column;
    for (const tally::OmittedEffect& effect : effects) column.push_back(effect.*member ? 1 : 0);
    format::put(group, name, column);
  });
  name_dimensions(group);
}

/// Fields of an analysis as datasets.
class GroupSink : public analysis::FieldSink {
 public:
  explicit GroupSink(core::h5::Group root) : open_{std::move(root)} {}
  /// Gives the dimensions of the outermost group their scales.
  void finish() { name_dimensions(open_.front()); }

  void begin_group(const std::string& name, const std::string& description) override {
    open_.push_back(open_.back().create_group(name));
    open_.back().set_attribute("", "description", description);
  }
  void end_group() override {
    name_dimensions(open_.back());
    open_.pop_back();
  }
  void number(const analysis::FieldMeaning& field, double value) override {
    open_.back().write(field.name, std::vector<double>{value}, {});
    describe_field(field);
  }
  void count(const analysis::FieldMeaning& field, std::int64_t value) override {
    open_.back().write(field.name, std::vector<std::int64_t>{value}, {});
    describe_field(field);
  }
  void text(const analysis::FieldMeaning& field, const std::string& value) override {
    open_.back().set_attribute("", field.name, value);
  }
  void numbers(const analysis::FieldMeaning& field, const std::vector<double>& values) override {
    open_.back().write(field.name, values);
    describe_field(field);
  }
  void counts(const analysis::FieldMeaning& field, const std::vector<std::int64_t>& values) override {
    open_.back().write(field.name, values);
    describe_field(field);
  }
  void texts(const analysis::FieldMeaning& field, const std::vector<std::string>& values) override {
    open_.back().write_strings(field.name, values);
    describe_field(field);
  }

 private:
  void describe_field(const analysis::FieldMeaning& field) {
    open_.back().set_attribute(field.name, "description", std::string(field.description));
    open_.back().set_attribute(field.name, "unit", std::string(field.unit));
  }

  std::vector<core::h5::Group> open_;
};

void put_event_analysis(core::h5::Group& point, const analysis::EventAnalysis& analysis,
                        const core::IdVector<core::PartId, std::string>& parts) {
  core::h5::Group group = point.create_group("analysis");
  group.set_attribute("", "description", std::string("analysis of the events, by the scene's [analysis]"));
  GroupSink sink(group);
  analysis::list_fields(analysis, parts, sink);
  sink.finish();
}

void put_channels(core::h5::Group& point, const std::vector<tally::ReadoutChannel>& channels) {
  core::h5::Group group = point.create_group("channels");
  group.set_attribute("", "description", std::string("readout channels of the sensors"));
  std::vector<std::string> names;
  std::vector<std::uint32_t> parts;
  for (const tally::ReadoutChannel& channel : channels) {
    names.push_back(channel.name);
    parts.push_back(format::to_file(channel.part));
  }
  format::put_text(group, "channel_name", names);
  format::put(group, "channel_part", parts);
  format::for_each_channel_number([&](const char* name, auto member) {
    std::vector<double> column;
    for (const tally::ReadoutChannel& channel : channels) column.push_back(member(channel));
    format::put(group, name, column);
  });
  std::vector<std::int64_t> numbers(channels.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  format::put(group, "channel_index", numbers);
  format::DimensionNames dimensions;
  for (const std::string& member : group.members()) dimensions[member] = {"channel_index"};
  name_dimensions(group, dimensions);
}

/// The values of the swept keys, as text and as numbers with their units.
void put_parameters(core::h5::Group& group, const std::vector<std::string>& keys,
                    const std::vector<std::string>& parameters) {
  std::vector<double> values;
  std::vector<std::string> units;
  for (const std::string& text : parameters) {
    const auto value = core::value_of_text(text);
    values.push_back(value ? value->value : std::nan(""));
    units.push_back(value ? value->unit : "");
  }
  put_scale(group, "swept_key", keys);
  format::put_text(group, "parameters", parameters);
  format::put(group, "parameter_value", values);
  format::put_text(group, "parameter_unit", units);
}

/// One row a point: what was swept, and the fates.
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
  core::IdVector<core::FaceId, std::string> faces;
  core::IdVector<core::PartId, std::string> parts;
  std::string note;
  std::vector<std::string> keys, media, surfaces;  ///< swept keys; names
  std::vector<tally::PointResult> points_written;  ///< parameters and fates of those written
  format::RowWriter<tally::DetectedPhoton> photons;
  format::RowWriter<format::EventRow> events;
  format::RowWriter<format::SignalRow> signals;
  format::SampleWriter orders, pulses;  ///< a row a signal
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
  state_.reset(new State{std::move(file),
                         root,
                         points,
                         header.faces,
                         header.parts,
                         header.note,
                         header.sweep_keys,
                         header.media.values(),
                         header.surfaces.values(),
                         {},
                         {},
                         {},
                         {},
                         {},
                         {},
                         {},
                         {}});
  if (photon_list) state_->photons = {state_->root, "photons", "detected photons, one row a photon"};
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
  group.set_attribute("", "complete", static_cast<std::int64_t>(point.complete));
  put_parameters(group, state_->keys, point.parameters);
  format::put(group, "photons_requested", point.photons_requested);
  format::put(group, "photons_emitted", point.emitted);
  format::put(group, "photons_traced", point.photons);
  format::put(group, "birth_efficiency", point.birth_efficiency);
  put_fates(group, point);
  put_scale(group, "medium", state_->media);
  put_scale(group, "surface", state_->surfaces);
  format::put(group, "absorbed_in_medium", point.absorbed_in_medium.values());
  format::put(group, "absorbed_at_surface", point.absorbed_at_surface.values());
  format::put(
      group, "detected_path_histogram",
      std::vector<std::uint64_t>(point.detected_path_histogram.begin(), point.detected_path_histogram.end()));
  format::put(group, "path_low_mm", path_bins());
  put_scale(group, "fate", fate_names());
  const std::vector<std::string> fates{"fate"}, keys{"swept_key"}, path{"path_low_mm"};
  name_dimensions(group, {{"fate_count", fates},
                          {"fate_fraction", fates},
                          {"fate_error", fates},
                          {"parameters", keys},
                          {"parameter_value", keys},
                          {"parameter_unit", keys},
                          {"path_low_mm", path},
                          {"detected_path_histogram", path},
                          {"absorbed_in_medium", {"medium"}},
                          {"absorbed_at_surface", {"surface"}}});
  put_shifts(group, "shifted_in_medium", "wavelength shifting in each medium",
             point.shifted_in_medium.values());
  put_shifts(group, "shifted_at_surface", "wavelength shifting in the gap of each surface",
             point.shifted_at_surface.values());
  put_sensor_faces(group, point.sensor_faces);
  put_exit_angles(group, analysis::crossing_angles(point), state_->faces);
  put_tallies(group, point.tallies);
  put_moments(group, "interactions_per_photon", "1", "boundary interactions of each photon",
              point.interactions);
  put_moments(group, "detected_path", "mm", "path length of detected photons", point.detected_path_mm);
  put_moments(group, "detected_time", "ns", "time of detection since the event", point.detected_time_ns);
  put_moments(group, "detected_interactions", "1", "boundary interactions of detected photons",
              point.detected_interactions);
  format::put(group, "scatterings", point.scatterings);
  format::put(group, "segments", point.segments);
  format::put(group, "resolved_misses", point.resolved_misses);
  format::put(group, "lost", point.lost);
  format::put(group, "wall_seconds", point.wall_seconds);
  if (state_->histories && history) state_->histories->describe_point(group, *history);
  if (point.energy.events_requested > 0) put_energy(group, point.energy);
  if (point.light_timing) put_light_timing(group, *point.light_timing);
  if (point.omitted) put_omitted(group, *point.omitted);
  if (analysis) put_event_analysis(group, *analysis, state_->parts);
  if (const auto channels = state_->channels.find(number); channels != state_->channels.end()) {
    put_channels(group, channels->second);
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
  format::put_text(state_->root, "note", {state_->note});
  state_->root.make_scale("note");
  put_sweep(state_->root, state_->keys, state_->points_written);
  state_->root.set_attribute("", "complete", static_cast<std::int64_t>(complete));
  state_->root.set_attribute("", "partial_reason", complete ? std::string() : reason_if_partial);
  state_->file.commit();
}

}  // namespace scintray::results
