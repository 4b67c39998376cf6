#include "scintray/results/detail/point_groups.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/analysis/light_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/value_text.hpp"
#include "scintray/results/detail/columns.hpp"
#include "scintray/results/detail/file_ids.hpp"
#include "scintray/results/results_format.hpp"
#include "scintray/scene_file/tally.hpp"

namespace scintray::results::format {

namespace {

/// @param mean  of the moments
core::h5::Group put_moments(core::h5::Group& point, const std::string& name, const std::string& unit,
                            const std::string& description, const core::Moments& moments,
                            const core::Estimate& mean) {
  core::h5::Group group = point.create_group(name);
  group.set_attribute("", "description", description);
  group.set_attribute("", "unit", unit);
  put(group, "count", moments.count);
  put(group, "sum", moments.sum);
  put(group, "sum_of_squares", moments.sum_of_squares);
  put(group, "mean", mean.value);
  put(group, "mean_error", mean.error);
  return group;
}

void put_photon_moments(core::h5::Group& point, const std::string& name, const std::string& unit,
                        const std::string& description, const tally::PhotonMoments& moments) {
  core::h5::Group group = put_moments(point, name, unit, description, moments, moments.mean());
  if (moments.of_events.events == 0) return;
  put(group, "events_counted", moments.of_events.events);
  put(group, "event_count_squares", moments.of_events.count_squares);
  put(group, "event_sum_squares", moments.of_events.squares);
  put(group, "event_sum_products", moments.of_events.products);
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
  put(group, "fate_count", counts);
  put(group, "fate_fraction", fractions);
  put(group, "fate_error", errors);
  if (point.event_fates.events == 0) return;
  put(group, "events_with_photons", point.event_fates.events);
  std::vector<std::uint64_t> products;
  for (const auto& row : point.event_fates.products) products.insert(products.end(), row.begin(), row.end());
  group.write("event_fate_products", products,
              {std::size_t{core::kFateCount}, std::size_t{core::kFateCount}});
  describe(group, "event_fate_products");
}

void put_shifts(core::h5::Group& point, const std::string& name, const std::string& description,
                const std::vector<optics::ShiftCount>& counts) {
  core::h5::Group group = point.create_group(name);
  group.set_attribute("", "description", description);
  for_each_shift_column([&](const char* field, auto member) {
    std::vector<std::decay_t<decltype(optics::ShiftCount{}.*member)>> values;
    for (const optics::ShiftCount& count : counts) values.push_back(count.*member);
    put(group, field, values);
  });
  name_dimensions(group);
}

/// Sums over events of the photons absorbed in media, or at surfaces.
void put_event_shares(core::h5::Group& group, const std::string& name,
                      const std::vector<tally::EventShare>& shares) {
  std::vector<std::uint64_t> squares, products;
  for (const tally::EventShare& share : shares) {
    squares.push_back(share.squares);
    products.push_back(share.products);
  }
  put(group, name + "_event_squares", squares);
  put(group, name + "_event_products", products);
}

void put_sensor_faces(core::h5::Group& point, const std::vector<tally::SensorFaceCount>& faces,
                      bool has_events) {
  core::h5::Group group = point.create_group("sensor_faces");
  group.set_attribute("", "description", std::string("photons that reached each sensor through each face"));
  std::vector<std::uint32_t> part, face;
  std::vector<std::uint64_t> detected, not_detected;
  for (const tally::SensorFaceCount& count : faces) {
    part.push_back(to_file(count.part));
    face.push_back(to_file(count.face));
    detected.push_back(count.detected);
    not_detected.push_back(count.not_detected);
  }
  put(group, "part", part);
  put(group, "face", face);
  put(group, "detected", detected);
  put(group, "unconverted", not_detected);
  if (has_events)
    for_each_face_event_column([&](const char* name, const auto& member) {
      std::vector<std::uint64_t> column;
      for (const tally::SensorFaceCount& count : faces) column.push_back(member(count));
      put(group, name, column);
    });
  name_dimensions(group);
}

/// Sums over groups of events: the groups before the bins, whose shape is `shape`.
void put_group_sums(core::h5::Group& tally, const std::string& name, const std::vector<double>& sums,
                    std::vector<std::size_t> shape) {
  if (sums.empty()) return;
  shape.insert(shape.begin(), tally::kEventGroups);
  tally.write(name, sums, shape);
  describe(tally, name);
}

/// @param faces  of the run, to one of which each tally is bound
void put_exit_angles(core::h5::Group& point, const std::vector<analysis::CrossingAngles>& tallies,
                     const core::IdVector<core::FaceId, std::string>& faces) {
  core::h5::Group group = point.create_group("exit_angles");
  group.set_attribute("", "description", std::string("histograms of crossing angles, one group a tally"));
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    core::h5::Group tally = group.create_group(numbered(i));
    tally.set_attribute("", "name", tallies[i].name);
    const auto face = std::find(faces.begin(), faces.end(), tallies[i].face);
    if (face == faces.end()) throw core::InternalError("exit angles at a face that the run does not have");
    tally.set_attribute("", "face", static_cast<std::int64_t>(face - faces.begin()));
    tally.set_attribute("", "detected_only", static_cast<std::int64_t>(tallies[i].detected_only));
    put(tally, "inside", tallies[i].inside);
    put(tally, "outside", tallies[i].outside);
    put_group_sums(tally, "inside_group_sums", tallies[i].inside_groups, {tallies[i].inside.size()});
    put_group_sums(tally, "outside_group_sums", tallies[i].outside_groups, {tallies[i].outside.size()});
    std::vector<double> low;
    for (std::size_t bin = 0; bin < tallies[i].inside.size(); ++bin)
      low.push_back(90.0 * static_cast<double>(bin) / static_cast<double>(tallies[i].inside.size()));
    put(tally, "angle_low_deg", low);
    const std::vector<std::string> angles{"angle_low_deg"};
    const std::vector<std::string> groups{"event_group", "angle_low_deg"};
    name_dimensions(tally, {{"angle_low_deg", angles},
                            {"inside", angles},
                            {"outside", angles},
                            {"inside_group_sums", groups},
                            {"outside_group_sums", groups}});
  }
}

void put_axis(core::h5::Group& tally, const std::string& name, const tally::TallyAxis& axis) {
  core::h5::Group group = tally.create_group(name);
  group.set_attribute("", "variable", axis.variable);
  group.set_attribute("", "unit", axis.unit);
  if (axis.names.empty()) {
    put(group, "edges", axis.edges);
    put(group, "along", std::vector<double>(axis.along.begin(), axis.along.end()));
  } else {
    put_text(group, "names", axis.names);
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
    core::h5::Group tally = group.create_group(numbered(number++));
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
    if (!from.event_squares.empty()) {
      tally.write("event_squares", from.event_squares, shape);
      describe(tally, "event_squares");
      tally.write("event_products", from.event_products, shape);
      describe(tally, "event_products");
    }
    put_group_sums(tally, "group_sums", from.group_sums, shape);
    put(tally, "beyond", from.outside);
    put(tally, "refractive_index", from.index);
    std::vector<std::string> bins, groups{"event_group"};
    for (std::size_t k = 0; k < from.axes.size(); ++k) bins.push_back("bin_" + std::to_string(k));
    groups.insert(groups.end(), bins.begin(), bins.end());
    name_dimensions(tally, {{"sum", bins},
                            {"sum_of_squares", bins},
                            {"event_squares", bins},
                            {"event_products", bins},
                            {"group_sums", groups}});
  }
}

void put_energy(core::h5::Group& point, const tally::EnergyBalance& energy) {
  core::h5::Group group = point.create_group("energy");
  group.set_attribute("", "description", std::string("energy of the events"));
  put(group, "events_requested", energy.events_requested);
  put(group, "events_traced", energy.events);
  put(group, "events_silent", energy.silent);
  put(group, "started_keV", energy.started);
  put(group, "deposited_keV", energy.deposited);
  put(group, "escaped_total_keV", energy.escaped);
  put(group, "unseen_total_keV", energy.non_scintillating);
  put_moments(group, "detected_per_event", "1",
              "photons detected per event with energy deposited in a scintillator", energy.detected,
              energy.detected.mean());
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
  put(group, "decay_ns", decay);
  put(group, "rise_ns", rise);
  put(group, "decay_share", share);
  put(group, "time_spread_ns", timing.time_spread_ns);
  name_dimensions(group);
}

void put_omitted(core::h5::Group& point, const std::vector<tally::OmittedEffect>& effects) {
  core::h5::Group group = point.create_group("omitted_effects");
  group.set_attribute("", "description",
                      std::string("physical effects that the numbers of this point do not include"));
  for_each_omission_text([&](const char* name, auto member) {
    std::vector<std::string> column;
    for (const tally::OmittedEffect& effect : effects) column.push_back(effect.*member);
    put_text(group, name, column);
  });
  for_each_omission_figure([&](const char* name, auto member) {
    std::vector<std::uint8_t> column;
    for (const tally::OmittedEffect& effect : effects) column.push_back(effect.*member ? 1 : 0);
    put(group, name, column);
  });
  name_dimensions(group);
}

void put_until(core::h5::Group& point, const tally::UntilResult& until) {
  core::h5::Group group = point.create_group("until");
  group.set_attribute("", "description", std::string("what was to end the point, and what did"));
  if (until.of.empty()) {
    group.set_attribute("", "share_of", std::string(core::fate_name(until.fate)));
  } else {
    group.set_attribute("", "error_of", until.of);
    group.set_attribute("", "absolute_error_unit", until.unit);
  }
  group.set_attribute("", "reproducible", static_cast<std::int64_t>(until.is_reproducible()));
  std::vector<std::string> names;
  std::vector<double> goals, reached;
  std::vector<std::uint8_t> met;
  for (const tally::UntilCondition& condition : until.conditions) {
    names.push_back(condition.quantity);
    goals.push_back(condition.goal);
    reached.push_back(condition.reached);
    met.push_back(condition.met ? 1 : 0);
  }
  put_text(group, "condition", names);
  put(group, "goal", goals);
  put(group, "reached", reached);
  put(group, "met", met);
  name_dimensions(group);
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
  put_text(group, "parameters", parameters);
  put(group, "parameter_value", values);
  put_text(group, "parameter_unit", units);
}

}  // namespace

void put_scale(core::h5::Group& group, const std::string& name, const std::vector<std::string>& values) {
  put_text(group, name, values);
  group.make_scale(name);
}

std::vector<std::string> fate_names() {
  std::vector<std::string> names;
  for (int fate = 0; fate < core::kFateCount; ++fate)
    names.emplace_back(core::fate_name(core::fate_at(fate)));
  return names;
}

void put_point(core::h5::Group& group, const tally::PointResult& point, const PointNames& names) {
  group.set_attribute("", "complete", static_cast<std::int64_t>(point.complete));
  put_parameters(group, names.keys, point.parameters);
  put(group, "photons_requested", point.photons_requested);
  put(group, "photons_emitted", point.emitted);
  put(group, "photons_traced", point.photons);
  put(group, "birth_efficiency", point.birth_efficiency);
  put_fates(group, point);
  put_scale(group, "medium", names.media);
  put_scale(group, "surface", names.surfaces);
  put(group, "absorbed_in_medium", point.absorbed_in_medium.values());
  put(group, "absorbed_at_surface", point.absorbed_at_surface.values());
  if (point.event_fates.events > 0 && point.events_in_medium.size() == point.absorbed_in_medium.size()) {
    put_event_shares(group, "absorbed_in_medium", point.events_in_medium.values());
    put_event_shares(group, "absorbed_at_surface", point.events_at_surface.values());
  }
  put(group, "detected_path_histogram",
      std::vector<std::uint64_t>(point.detected_path_histogram.begin(), point.detected_path_histogram.end()));
  put(group, "path_low_mm", path_bins());
  put_scale(group, "fate", fate_names());
  const std::vector<std::string> fates{"fate"}, keys{"swept_key"}, path{"path_low_mm"};
  name_dimensions(group, {{"fate_count", fates},
                          {"fate_fraction", fates},
                          {"fate_error", fates},
                          {"event_fate_products", fates},
                          {"parameters", keys},
                          {"parameter_value", keys},
                          {"parameter_unit", keys},
                          {"path_low_mm", path},
                          {"detected_path_histogram", path},
                          {"absorbed_in_medium", {"medium"}},
                          {"absorbed_at_surface", {"surface"}},
                          {"absorbed_in_medium_event_squares", {"medium"}},
                          {"absorbed_in_medium_event_products", {"medium"}},
                          {"absorbed_at_surface_event_squares", {"surface"}},
                          {"absorbed_at_surface_event_products", {"surface"}}});
  put_shifts(group, "shifted_in_medium", "wavelength shifting in each medium",
             point.shifted_in_medium.values());
  put_shifts(group, "shifted_at_surface", "wavelength shifting in the gap of each surface",
             point.shifted_at_surface.values());
  put_sensor_faces(group, point.sensor_faces, point.event_fates.events > 0);
  put_exit_angles(group, analysis::crossing_angles(point), names.faces);
  put_tallies(group, point.tallies);
  put_photon_moments(group, "interactions_per_photon", "1", "boundary interactions of each photon",
                     point.interactions);
  put_photon_moments(group, "detected_path", "mm", "path length of detected photons", point.detected_path_mm);
  put_photon_moments(group, "detected_time", "ns", "time of detection since the event",
                     point.detected_time_ns);
  put_photon_moments(group, "detected_interactions", "1", "boundary interactions of detected photons",
                     point.detected_interactions);
  put(group, "scatterings", point.scatterings);
  put(group, "segments", point.segments);
  put(group, "resolved_misses", point.resolved_misses);
  put(group, "lost", point.lost);
  put(group, "wall_seconds", point.wall_seconds);
}

void put_point_facts(core::h5::Group& group, const tally::PointResult& point) {
  if (point.energy.events_requested > 0) put_energy(group, point.energy);
  if (point.light_timing) put_light_timing(group, *point.light_timing);
  if (point.omitted) put_omitted(group, *point.omitted);
  if (point.until) put_until(group, *point.until);
}

}  // namespace scintray::results::format
