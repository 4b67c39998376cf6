#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <type_traits>

#include "scintray/analysis/light_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/results/detail/columns.hpp"
#include "scintray/results/detail/file_ids.hpp"
#include "scintray/results/detail/point_records.hpp"
#include "scintray/results/detail/row_table.hpp"
#include "scintray/results/results.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

namespace {

using format::damaged;
using format::open_results;

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

tally::PhotonMoments get_photon_moments(const core::h5::Group& point, const std::string& name) {
  tally::PhotonMoments moments{get_moments(point, name), {}};
  const core::h5::Group group = point.open_group(name);
  if (!group.has("events_counted")) return moments;
  moments.of_events = {get<std::uint64_t>(group, "events_counted"),
                       get<std::uint64_t>(group, "event_count_squares"),
                       get<double>(group, "event_sum_squares"), get<double>(group, "event_sum_products")};
  return moments;
}

/// Sums over groups of events of a tally with `bins` bins; empty where the file has none.
std::vector<double> get_group_sums(const core::h5::Group& tally, const std::string& name, std::size_t bins) {
  if (!tally.has(name)) return {};
  std::vector<double> sums = tally.read<double>(name);
  if (sums.size() != tally::kEventGroups * bins)
    throw core::SystemError(name + " does not match the bins of its tally");
  return sums;
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
    // Version 1 has neither of the two.
    point.emitted = point.photons;
    if (group_.has("birth_efficiency")) {
      point.emitted = get<std::uint64_t>(group_, "photons_emitted");
      point.birth_efficiency = get<double>(group_, "birth_efficiency");
      require(point.birth_efficiency > 0.0 && point.birth_efficiency <= 1.0,
              "birth_efficiency is not in 0 to 1");
    }
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
    const auto event_shares = [&](const char* name, std::size_t size) {
      return sound([&](const core::h5::Group& group) { return format::get_event_shares(group, name, size); });
    };
    point.events_in_medium = core::IdVector<core::MediumId, tally::EventShare>(
        event_shares("absorbed_in_medium", header_.media.size()));
    point.events_at_surface = core::IdVector<core::SurfaceId, tally::EventShare>(
        event_shares("absorbed_at_surface", header_.surfaces.size()));
    point.shifted_in_medium =
        core::IdVector<core::MediumId, optics::ShiftCount>(shifts("shifted_in_medium", header_.media.size()));
    point.shifted_at_surface = core::IdVector<core::SurfaceId, optics::ShiftCount>(
        shifts("shifted_at_surface", header_.surfaces.size()));
    point.sensor_faces = sensor_faces();
    if (group_.has("tallies")) point.tallies = tallies();
    add_exit_angles(point.tallies);
    point.interactions = get_photon_moments(group_, "interactions_per_photon");
    point.detected_path_mm = get_photon_moments(group_, "detected_path");
    point.detected_time_ns = get_photon_moments(group_, "detected_time");
    point.detected_interactions = get_photon_moments(group_, "detected_interactions");
    point.scatterings = get<std::uint64_t>(group_, "scatterings");
    point.segments = get<std::uint64_t>(group_, "segments");
    point.resolved_misses = get<std::uint64_t>(group_, "resolved_misses");
    point.lost = get<std::uint64_t>(group_, "lost");
    point.wall_seconds = get<double>(group_, "wall_seconds");
    if (group_.has("energy")) point.energy = energy();
    if (group_.has("until")) point.until = sound(format::get_until);
    if (group_.has("event_fate_products")) point.event_fates = sound(format::get_event_fates);
    require(point.event_fates.events <= point.energy.events, "more events have photons than there are");
    for (tally::TallyResult& tally : point.tallies) tally.events = point.event_counts();
    if (group_.has("light_timing")) point.light_timing = sound(format::get_light_timing);
    if (group_.has("omitted_effects")) point.omitted = sound(format::get_omitted_effects);
    check_counts(point);
    check_numbers(point);
    return point;
  }

 private:
  void require(bool holds, const std::string& what) const {
    if (!holds) throw format::damaged(path_, "in point " + name_ + ", " + what);
  }

  /// A record of the point; a contradiction in it is a damaged file.
  template <typename GetRecord>
  std::invoke_result_t<GetRecord, const core::h5::Group&> sound(const GetRecord& get_record) const {
    try {
      return get_record(group_);
    } catch (const std::invalid_argument& contradiction) {
      throw format::damaged(path_, "in point " + name_ + ", " + contradiction.what());
    }
  }

  template <typename Counts>
  void require_sum(const Counts& counts, std::uint64_t total, const std::string& what) const {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts) {
      require(count <= total - sum, what);
      sum += count;
    }
    require(sum == total, what);
  }

  /// Every photon has one fate, and what is counted by fate is counted by place, too.
  void check_counts(const tally::PointResult& point) const {
    require_sum(point.fates, point.photons, "the fates are not those of the photons traced");
    require_sum(point.absorbed_in_medium, point.count(core::Fate::absorbed_in_medium),
                "absorbed_in_medium does not sum to its fate");
    require_sum(point.absorbed_at_surface, point.count(core::Fate::absorbed_at_surface),
                "absorbed_at_surface does not sum to its fate");
    std::vector<std::uint64_t> detected, not_detected;
    for (const tally::SensorFaceCount& face : point.sensor_faces) {
      detected.push_back(face.detected);
      not_detected.push_back(face.not_detected);
    }
    require_sum(detected, point.count(core::Fate::detected), "sensor_faces does not sum to what is detected");
    require_sum(not_detected, point.count(core::Fate::not_detected),
                "sensor_faces does not sum to what is not detected");
    for (const std::uint64_t count : point.detected_path_histogram)
      require(count <= point.count(core::Fate::detected), "detected_path_histogram counts too many photons");
    require(
        point.energy.events <= point.energy.events_requested && point.energy.silent <= point.energy.events,
        "more events are traced than requested");
  }

  void require_number(double value, const char* name) const {
    require(std::isfinite(value) && value >= 0.0, std::string(name) + " is " + std::to_string(value));
  }

  /// The square of a mean is at most the mean of the squares.
  void require_moments(const core::Moments& moments, const char* name) const {
    require(std::isfinite(moments.sum), std::string(name) + " has a sum that is not a number");
    require_number(moments.sum_of_squares, name);
    constexpr double kRounding = 1e-6;
    const double most = static_cast<double>(moments.count) * moments.sum_of_squares;
    require(moments.sum * moments.sum <= most * (1.0 + kRounding),
            std::string("the sums of ") + name + " contradict each other");
  }

  void require_photon_moments(const tally::PhotonMoments& moments, const char* name) const {
    require_moments(moments, name);
    require_number(moments.of_events.squares, name);
    require(std::isfinite(moments.of_events.products) && moments.of_events.events <= moments.count,
            std::string("the sums over events of ") + name + " are no such sums");
  }

  void check_numbers(const tally::PointResult& point) const {
    require_photon_moments(point.interactions, "interactions_per_photon");
    require_photon_moments(point.detected_path_mm, "detected_path");
    require_photon_moments(point.detected_time_ns, "detected_time");
    require_photon_moments(point.detected_interactions, "detected_interactions");
    require_moments(point.energy.detected, "detected_per_event");
    require_number(point.wall_seconds, "wall_seconds");
    require_number(point.energy.started, "started_keV");
    require_number(point.energy.deposited, "deposited_keV");
    require_number(point.energy.escaped, "escaped_total_keV");
    require_number(point.energy.non_scintillating, "unseen_total_keV");
    for (const tally::TallyResult& tally : point.tallies) {
      for (const double sum : tally.sum)
        require(std::isfinite(sum), "the tally \"" + tally.name + "\" has a sum that is not a number");
      for (const double sum : tally.sum_of_squares) require_number(sum, "a sum of squares of a tally");
      for (const double sum : tally.event_squares) require_number(sum, "a sum over events of a tally");
      for (const double sum : tally.event_products)
        require(std::isfinite(sum), "a sum over events of a tally is not a number");
      for (const double sum : tally.group_sums) require_number(sum, "a sum over a group of events");
      require_number(tally.index, "refractive_index");
    }
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

  /// Zeros from a file older than wavelength shifters.
  std::vector<optics::ShiftCount> shifts(const std::string& name, std::size_t size) const {
    std::vector<optics::ShiftCount> counts(size);
    if (!group_.has(name)) return counts;
    const core::h5::Group group = group_.open_group(name);
    format::for_each_shift_column([&](const char* field, auto member) {
      if (!group.has(field) && std::string_view(field) == "shifter_additional") return;  // an older file
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
    if (group.has("detected_event_squares"))
      format::for_each_face_event_column([&](const char* name, const auto& member) {
        const auto column = group.read<std::uint64_t>(name);
        require(column.size() == counts.size(), "the columns of sensor_faces differ in length");
        for (std::size_t i = 0; i < column.size(); ++i) member(counts[i]) = column[i];
      });
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
      angles.inside_groups = get_group_sums(from, "inside_group_sums", angles.inside.size());
      angles.outside_groups = get_group_sums(from, "outside_group_sums", angles.outside.size());
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
      if (from.has("event_squares")) {
        tally.event_squares = from.read<double>("event_squares");
        tally.event_products = from.read<double>("event_products");
        require(tally.event_squares.size() == tally.bins() && tally.event_products.size() == tally.bins(),
                "the sums over events of the tally \"" + tally.name + "\" do not match its axes");
      }
      tally.group_sums = get_group_sums(from, "group_sums", tally.bins());
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

}  // namespace

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

}  // namespace scintray::results
