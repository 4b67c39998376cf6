#include <algorithm>
#include <array>
#include <map>

#include "scintray/analysis/light_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/results/detail/columns.hpp"
#include "scintray/results/detail/file_ids.hpp"
#include "scintray/results/detail/goniometer_columns.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

namespace {

using format::damaged;
using format::has_format;
using format::open_results;

core::InputError wrong(const std::filesystem::path& path, const std::string& what, const std::string& hint) {
  return core::InputError({{path.string()}, what, hint});
}

template <typename T>
T get(const core::h5::Group& group, const std::string& name) {
  const auto values = group.read<T>(name);
  if (values.size() != 1)
    throw core::SystemError(name + " holds " + std::to_string(values.size()) + " values, not one");
  return values.front();
}

std::string get_text(const core::h5::Group& group, const std::string& name) {
  const auto values = group.read_strings(name);
  return values.empty() ? "" : values.front();
}

core::Moments get_moments(const core::h5::Group& point, const std::string& name) {
  const core::h5::Group group = point.open_group(name);
  return {get<std::uint64_t>(group, "count"), get<double>(group, "sum"),
          get<double>(group, "sum_of_squares")};
}

template <typename IdType>
core::IdVector<IdType, std::string> get_names(const core::h5::Group& root, const std::string& name) {
  return core::IdVector<IdType, std::string>(root.read_strings(name));
}

tally::RunHeader get_header(const core::h5::Group& root) {
  tally::RunHeader header;
  header.title = root.string_attribute("", "title");
  header.version = root.string_attribute("", "scintray_version");
  header.scene_file = root.string_attribute("", "scene_file");
  header.scene_text = get_text(root, "scene");
  header.seed = get<std::uint64_t>(root, "seed");
  header.sweep_keys = root.read_strings("sweep_keys");
  header.media = get_names<core::MediumId>(root, "media");
  header.surfaces = get_names<core::SurfaceId>(root, "surfaces");
  header.parts = get_names<core::PartId>(root, "parts");
  header.faces = get_names<core::FaceId>(root, "faces");
  header.note = get_text(root, "note");
  return header;
}

/// The point `name` of a file, read with checks against the header.
class PointReader {
 public:
  PointReader(const std::filesystem::path& path, const tally::RunHeader& header,
              const core::h5::Group& points, const std::string& name)
      : path_(path), header_(header), name_(name), group_(points.open_group(name)) {}

  tally::PointResult read() const {
    tally::PointResult point;
    point.parameters = group_.read_strings("parameters");
    require(point.parameters.size() == header_.sweep_keys.size(), "parameters do not match the swept keys");
    point.photons_requested = get<std::uint64_t>(group_, "photons_requested");
    point.photons = get<std::uint64_t>(group_, "photons_traced");
    point.complete = group_.integer_attribute("", "complete") != 0;
    copy("fate_count", point.fates);
    copy("detected_path_histogram", point.detected_path_histogram);
    point.absorbed_in_medium =
        core::IdVector<core::MediumId, std::uint64_t>(group_.read<std::uint64_t>("absorbed_in_medium"));
    point.absorbed_at_surface =
        core::IdVector<core::SurfaceId, std::uint64_t>(group_.read<std::uint64_t>("absorbed_at_surface"));
    require(point.absorbed_in_medium.size() == header_.media.size(),
            "absorbed_in_medium does not match media");
    require(point.absorbed_at_surface.size() == header_.surfaces.size(),
            "absorbed_at_surface does not match surfaces");
    point.shifted_in_medium =
        core::IdVector<core::MediumId, optics::ShiftCount>(shifts("shifted_in_medium", header_.media.size()));
    point.shifted_at_surface = core::IdVector<core::SurfaceId, optics::ShiftCount>(
        shifts("shifted_at_surface", header_.surfaces.size()));
    point.sensor_faces = sensor_faces();
    if (group_.has("tallies")) point.tallies = tallies();
    add_exit_angles(point.tallies);
    point.interactions = get_moments(group_, "interactions_per_photon");
    point.detected_path_mm = get_moments(group_, "detected_path");
    point.detected_time_ns = get_moments(group_, "detected_time");
    point.detected_interactions = get_moments(group_, "detected_interactions");
    point.scatterings = get<std::uint64_t>(group_, "scatterings");
    point.segments = get<std::uint64_t>(group_, "segments");
    point.resolved_misses = get<std::uint64_t>(group_, "resolved_misses");
    point.lost = get<std::uint64_t>(group_, "lost");
    point.wall_seconds = get<double>(group_, "wall_seconds");
    if (group_.has("energy")) point.energy = energy();
    if (group_.has("light_timing")) point.light_timing = light_timing();
    return point;
  }

 private:
  void require(bool holds, const std::string& what) const {
    if (!holds) throw format::damaged(path_, "in point " + name_ + ", " + what);
  }

  template <std::size_t Size>
  void copy(const std::string& dataset, std::array<std::uint64_t, Size>& to) const {
    const auto values = group_.read<std::uint64_t>(dataset);
    require(values.size() == Size, dataset + " has " + std::to_string(values.size()) + " values");
    std::copy(values.begin(), values.end(), to.begin());
  }

  tally::EnergyBalance energy() const {
    const core::h5::Group group = group_.open_group("energy");
    tally::EnergyBalance energy;
    energy.events_requested = get<std::uint64_t>(group, "events_requested");
    energy.events = get<std::uint64_t>(group, "events_traced");
    energy.silent = get<std::uint64_t>(group, "events_silent");
    energy.started = get<double>(group, "started_keV");
    energy.deposited = get<double>(group, "deposited_keV");
    energy.escaped = get<double>(group, "escaped_total_keV");
    energy.non_scintillating = get<double>(group, "unseen_total_keV");
    energy.detected = get_moments(group, "detected_per_event");
    return energy;
  }

  tally::LightTiming light_timing() const {
    const core::h5::Group group = group_.open_group("light_timing");
    const auto decay = group.read<double>("decay_ns"), rise = group.read<double>("rise_ns"),
               share = group.read<double>("decay_share");
    require(!decay.empty() && rise.size() == decay.size() && share.size() == decay.size(),
            "the columns of light_timing differ in length");
    tally::LightTiming timing;
    for (std::size_t i = 0; i < decay.size(); ++i) timing.decay.push_back({decay[i], rise[i], share[i]});
    timing.time_spread_ns = get<double>(group, "time_spread_ns");
    return timing;
  }

  /// Zeros from a file older than wavelength shifters.
  std::vector<optics::ShiftCount> shifts(const std::string& name, std::size_t size) const {
    std::vector<optics::ShiftCount> counts(size);
    if (!group_.has(name)) return counts;
    const core::h5::Group group = group_.open_group(name);
    format::for_each_shift_column([&](const char* field, auto member) {
      const auto values = group.read<std::decay_t<decltype(optics::ShiftCount{}.*member)>>(field);
      require(values.size() == size, name + " has " + std::to_string(values.size()) + " rows in " + field);
      for (std::size_t i = 0; i < size; ++i) counts[i].*member = values[i];
    });
    for (const optics::ShiftCount& count : counts)
      require(count.emitted <= count.absorbed, name + " has more photons emitted than absorbed");
    return counts;
  }

  std::vector<tally::SensorFaceCount> sensor_faces() const {
    const core::h5::Group group = group_.open_group("sensor_faces");
    const auto part = group.read<std::uint32_t>("part"), face = group.read<std::uint32_t>("face");
    const auto detected = group.read<std::uint64_t>("detected");
    const auto not_detected = group.read<std::uint64_t>("unconverted");
    require(
        face.size() == part.size() && detected.size() == part.size() && not_detected.size() == part.size(),
        "the columns of sensor_faces differ in length");
    std::vector<tally::SensorFaceCount> counts;
    for (std::size_t i = 0; i < part.size(); ++i) {
      tally::SensorFaceCount& count = counts.emplace_back();
      format::from_file(part[i], count.part);
      format::from_file(face[i], count.face);
      require(header_.parts.contains(count.part) && header_.faces.contains(count.face),
              "sensor_faces names a part or face that does not exist");
      count.detected = detected[i];
      count.not_detected = not_detected[i];
    }
    return counts;
  }

  void add_exit_angles(std::vector<tally::TallyResult>& tallies) const {
    const core::h5::Group group = group_.open_group("exit_angles");
    for (const std::string& member : group.members()) {
      const core::h5::Group from = group.open_group(member);
      analysis::CrossingAngles angles;
      angles.name = from.string_attribute("", "name");
      const std::int64_t face = from.integer_attribute("", "face");
      require(face >= 0 && static_cast<std::size_t>(face) < header_.faces.size(),
              "an exit angle tally names a face that does not exist");
      angles.face = header_.faces[core::FaceId(face)];
      angles.detected_only = from.integer_attribute("", "detected_only") != 0;
      angles.inside = from.read<std::uint64_t>("inside");
      angles.outside = from.read<std::uint64_t>("outside");
      for (tally::TallyResult& tally : analysis::tallies_of(angles)) tallies.push_back(std::move(tally));
    }
  }

  tally::TallyAxis axis(const core::h5::Group& group) const {
    tally::TallyAxis axis;
    axis.variable = group.string_attribute("", "variable");
    axis.unit = group.string_attribute("", "unit");
    if (group.has("names")) {
      axis.names = group.read_strings("names");
      require(!axis.names.empty(), "an axis of a tally has no names");
      return axis;
    }
    axis.edges = group.read<double>("edges");
    require(axis.edges.size() >= 2 && std::is_sorted(axis.edges.begin(), axis.edges.end()),
            "the edges of an axis of a tally do not rise");
    const auto along = group.read<double>("along");
    require(along.size() == 3, "the direction of an axis does not have three components");
    std::copy(along.begin(), along.end(), axis.along.begin());
    return axis;
  }

  std::vector<tally::TallyResult> tallies() const {
    const core::h5::Group group = group_.open_group("tallies");
    std::vector<tally::TallyResult> tallies;
    for (const std::string& member : group.members()) {
      const core::h5::Group from = group.open_group(member);
      tally::TallyResult tally;
      tally.name = from.string_attribute("", "name");
      tally.type = from.string_attribute("", "type");
      tally.score = from.string_attribute("", "score");
      tally.unit = from.string_attribute("", "unit");
      for (std::size_t k = 0; from.has("axis_" + std::to_string(k)); ++k)
        tally.axes.push_back(axis(from.open_group("axis_" + std::to_string(k))));
      tally.sum = from.read<double>("sum");
      tally.sum_of_squares = from.read<double>("sum_of_squares");
      require(tally.sum.size() == tally.bins() && tally.sum_of_squares.size() == tally.bins(),
              "the sums of the tally \"" + tally.name + "\" do not match its axes");
      tally.outside = get<double>(from, "beyond");
      tally.index = get<double>(from, "refractive_index");
      tallies.push_back(std::move(tally));
    }
    return tallies;
  }

  const std::filesystem::path& path_;
  const tally::RunHeader& header_;
  std::string name_;
  core::h5::Group group_;
};

std::vector<tally::ReadoutChannel> get_channels(const std::filesystem::path& path,
                                                const core::h5::Group& root, std::size_t point) {
  const core::h5::Group points = root.open_group("points");
  const std::string name = format::numbered(point);
  if (!points.has(name) || !points.open_group(name).has("channels")) return {};
  const core::h5::Group group = points.open_group(name).open_group("channels");
  const std::vector<std::string> names = group.read_strings("channel_name");
  const auto parts = group.read<std::uint32_t>("channel_part");
  std::vector<tally::ReadoutChannel> channels(names.size());
  const auto require = [&](std::size_t size) {
    if (size != names.size()) throw format::damaged(path, "the columns of channels differ in length");
  };
  require(parts.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    channels[i].name = names[i];
    format::from_file(parts[i], channels[i].part);
  }
  format::for_each_channel_number([&](const char* column, auto member) {
    const auto values = group.read<double>(column);
    require(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) member(channels[i]) = values[i];
  });
  return channels;
}

/// Rows of the samples of a group one after the other; empty without that group.
std::vector<float> samples_of(const core::h5::Group& root, const std::string& name, std::uint64_t first,
                              std::uint64_t count) {
  if (!root.has(name)) return {};
  return root.open_group(name).read_part<float>("samples", first, count);
}

std::vector<float> row_of(const std::vector<float>& samples, std::size_t row, std::size_t rows) {
  const std::size_t width = samples.size() / rows;
  const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(row * width);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

/// Attaches the signals of the channels to events.
void add_signals(const std::filesystem::path& path, const core::h5::Group& root, std::uint64_t offset,
                 const std::vector<format::EventRow>& rows, EventDetail detail,
                 std::vector<tally::EventRecord>& events) {
  std::map<std::uint32_t, std::size_t> channels;  // of each point
  for (tally::EventRecord& event : events) {
    const auto [known, is_new] = channels.try_emplace(event.point, 0);
    if (is_new) known->second = get_channels(path, root, event.point).size();
    event.channels.resize(known->second);
  }
  const core::h5::Group group = root.open_group("signals");
  const std::uint64_t first = rows.front().first_signal;
  const auto next = format::read_rows<format::EventRow>(root.open_group("events"), offset + rows.size(), 1);
  const std::uint64_t end =
      next && !next->empty() ? next->front().first_signal : group.shape("channel").at(0);
  if (end < first) throw format::damaged(path, "the signals of events are out of order");
  const auto signals = format::read_rows<format::SignalRow>(group, first, end - first);
  if (!signals) throw format::damaged(path, "the columns of signals differ in length");
  const auto samples = [&](const std::string& name, EventDetail from) {
    return samples_of(root, name, first, detail >= from ? end - first : 0);
  };
  const std::vector<float> orders = samples("photon_times", EventDetail::photon_times);
  const std::vector<float> pulses = samples("pulses", EventDetail::all);
  for (std::size_t i = 0; i < signals->size(); ++i) {
    const format::SignalRow& signal = (*signals)[i];
    if (signal.event_row < offset || signal.event_row - offset >= events.size() ||
        signal.channel >= events[signal.event_row - offset].channels.size())
      throw format::damaged(path, "a signal names an event or a channel that does not exist");
    tally::ChannelRecord& record = events[signal.event_row - offset].channels[signal.channel];
    record = signal.signal;
    record.order_ns = row_of(orders, i, signals->size());
    record.waveform = row_of(pulses, i, signals->size());
  }
}

}  // namespace

bool is_results_file(const std::filesystem::path& path) {
  try {
    return format::has_format(core::h5::File::open(path).root());
  } catch (const core::Error&) {
    return false;
  }
}

tally::RunResult read_results(const std::filesystem::path& path) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  tally::RunResult result;
  result.header = get_header(root);
  const core::h5::Group points = root.open_group("points");
  for (const std::string& name : points.members())
    result.points.push_back(PointReader(path, result.header, points, name).read());
  if (root.integer_attribute("", "complete") == 0) {
    result.partial_reason = root.string_attribute("", "partial_reason");
    if (result.partial_reason.empty()) result.partial_reason = "the file is marked partial";
  }
  return result;
}

ResultsStatus read_results_status(const std::filesystem::path& path) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  ResultsStatus status;
  status.complete = root.integer_attribute("", "complete") != 0;
  status.reason = root.string_attribute("", "partial_reason");
  status.has_photon_list = root.has("photons");
  if (status.has_photon_list) status.listed_photons = root.open_group("photons").shape("point").at(0);
  if (root.has("events")) status.listed_events = root.open_group("events").shape("point").at(0);
  return status;
}

std::vector<tally::DetectedPhoton> read_photons(const std::filesystem::path& path, std::uint64_t offset,
                                                std::uint64_t count) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  if (!root.has("photons"))
    throw wrong(path, "this result has no list of detected photons",
                "request the list when running the scene");
  auto photons = format::read_rows<tally::DetectedPhoton>(root.open_group("photons"), offset, count);
  if (!photons) throw format::damaged(path, "the columns of photons differ in length");
  return std::move(*photons);
}

std::vector<analysis::SurfaceAnalysis> read_surfaces(const std::filesystem::path& path) {
  const core::h5::File file = format::open_results(path);
  try {
    return format::get_surface_analyses(file.root());
  } catch (const std::invalid_argument& contradiction) {
    throw format::damaged(path, contradiction.what());
  }
}

std::vector<tally::ReadoutChannel> read_channels(const std::filesystem::path& path, std::size_t point) {
  const core::h5::File file = format::open_results(path);
  return get_channels(path, file.root(), point);
}

std::vector<std::uint64_t> read_photon_order(const std::filesystem::path& path) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  if (!root.has("photon_times")) return {};
  return root.open_group("photon_times").read<std::uint64_t>("order");
}

std::vector<tally::EventRecord> read_events(const std::filesystem::path& path, std::uint64_t offset,
                                            std::uint64_t count, EventDetail detail) {
  const core::h5::File file = format::open_results(path);
  const core::h5::Group root = file.root();
  if (!root.has("events"))
    throw wrong(path, "this result has no events", "run a scene whose [source] is an event source");
  const auto rows = format::read_rows<format::EventRow>(root.open_group("events"), offset, count);
  if (!rows) throw format::damaged(path, "the columns of events differ in length");
  std::vector<tally::EventRecord> events;
  for (const format::EventRow& row : *rows) events.push_back(row.event);
  if (events.empty()) return events;
  add_signals(path, root, offset, *rows, detail, events);
  return events;
}

}  // namespace scintray::results
