#include <algorithm>
#include <cmath>

#include "scintray/core/face_axes.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/scene_file/tally_axis.hpp"
#include "scintray/tally/tally_plan.hpp"

namespace scintray::tally {

namespace {

/// Bins of one tally: 160 MB of sums.
constexpr double kMostBins = 1e7;
/// Sine of the angle up to which faces count as parallel, and a face as flat.
constexpr double kFlat = 1e-6;
constexpr const char* kAmbientName = "(ambient)";

std::vector<std::string> part_names(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::PartInfo& part : scene.parts) names.push_back(part.name);
  return names;
}

/// Names for the hint of an error, those of `wanted` part first and those of arrays as one pattern.
std::vector<std::string> names_near(const std::string& wanted, const std::vector<std::string>& names) {
  const auto part = [](const std::string& name) { return name.substr(0, name.find(':')); };
  std::vector<std::string> near, others;
  for (const std::string& name : names) {
    const bool matches = core::matches_pattern(part(wanted), part(name));
    const std::string shown = names.size() > 30 ? core::pattern_of(name) : name;
    std::vector<std::string>& list = matches ? near : others;
    if (std::find(list.begin(), list.end(), shown) == list.end()) list.push_back(shown);
  }
  near.insert(near.end(), others.begin(), others.end());
  return near;
}

/// For each of `names`, true when a pattern matches it. Throws InputError for a pattern without a match.
std::vector<bool> picked(const std::vector<config::NameRef>& patterns, const std::vector<std::string>& names,
                         const std::string& kind, const core::FileLocation& where) {
  std::vector<bool> result(names.size(), false);
  for (const config::NameRef& pattern : patterns) {
    bool any = false;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (core::matches_pattern(pattern.name, names[i])) result[i] = any = true;
    if (!any)
      throw core::unknown_name(pattern.where.file.empty() ? where : pattern.where, kind, pattern.name,
                               names_near(pattern.name, names));
  }
  return result;
}

/// Parts that the patterns match, by place (scene_file::place_of); empty without patterns.
std::vector<bool> picked_parts(const std::vector<config::NameRef>& patterns, const scene::Scene& scene,
                               const core::FileLocation& where) {
  if (patterns.empty()) return {};
  std::vector<bool> parts = picked(patterns, part_names(scene), "part", where);
  parts.insert(parts.begin(), false);  // the ambient space
  return parts;
}

/// Regions of the parts that the patterns match; empty without patterns.
core::IdVector<core::RegionId, bool> picked_regions(const std::vector<config::NameRef>& patterns,
                                                    const scene::Scene& scene,
                                                    const core::FileLocation& where) {
  const std::vector<bool> parts = picked_parts(patterns, scene, where);
  if (parts.empty()) return {};
  core::IdVector<core::RegionId, bool> regions;
  for (const scene::Region& region : scene.regions)
    regions.push_back(parts[scene_file::place_of(region.part)]);
  return regions;
}

/// Parts that are sensors.
std::vector<config::NameRef> sensor_parts(const scene::Scene& scene) {
  core::IdVector<core::PartId, bool> detects(scene.parts.size(), false);
  for (const scene::Interface& interface : scene.interfaces) {
    if (interface.back_sensor.has_value()) detects[interface.back_sensor_part] = true;
    if (interface.front_sensor.has_value()) detects[interface.front_sensor_part] = true;
  }
  std::vector<config::NameRef> names;
  for (const core::PartId part : detects.ids())
    if (detects[part]) names.push_back({scene.parts[part].name, {}});
  return names;
}

class CountBinder {
 public:
  CountBinder(const scene_file::TallySpec& spec, const std::vector<config::NameRef>& source_parts,
              const scene::Scene& scene)
      : spec_(spec), source_parts_(source_parts), scene_(scene), faces_(faces_of(spec, scene)) {}

  CountRequest bind() {
    CountRequest count;
    count.empty.name = spec_.name;
    count.empty.type = spec_.type;
    count.score = spec_.score;
    count.empty.score = spec_.score ? spec_.score->name : scene_file::kPhotonScore;
    count.empty.unit = spec_.score ? spec_.score->unit() : "1";
    for (const core::FaceId face : faces_) count.empty.faces.push_back(scene_.faces[face].name);
    count.empty.detected_only = spec_.detected_only();
    count.parts = picked_parts(spec_.parts, scene_, spec_.where);
    count.source_parts = picked_parts(spec_.source_parts, scene_, spec_.where);
    count.visited = picked_regions(spec_.visited, scene_, spec_.where);
    count.not_visited = picked_regions(spec_.not_visited, scene_, spec_.where);
    for (const core::StepEvent fate : spec_.fate) count.fates |= 1u << static_cast<unsigned>(fate);
    count.each = spec_.each;
    for (const scene_file::TallyRangeSpec& range : spec_.ranges)
      count.ranges.push_back({range.variable, range.along, range.low, range.high});
    double bins = 1.0;
    for (const scene_file::TallyAxisSpec& axis : spec_.axes) {
      axis.variable->is_name() ? bind_names(axis, count) : bind_numbers(axis, count);
      bins *= static_cast<double>(count.empty.axes.back().bins());
    }
    if (bins > kMostBins)
      throw core::InputError({spec_.where,
                              "the tally \"" + spec_.name + "\" has " + std::to_string(bins) +
                                  " bins, more than " + std::to_string(kMostBins),
                              "use fewer or coarser axes, or name fewer parts"});
    count.empty.index = medium_index();
    count.empty.sum.assign(static_cast<std::size_t>(bins), 0.0);
    count.empty.sum_of_squares = count.empty.sum;
    return count;
  }

 private:
  void bind_names(const scene_file::TallyAxisSpec& axis, CountRequest& count) {
    CountAxis bound;
    bound.variable = axis.variable;
    TallyAxis made;
    made.variable = axis.variable->name;
    const auto add = [&](std::size_t slot, const std::string& name) {
      bound.bin_of[slot] = BinId(made.names.size());
      made.names.push_back(name);
    };
    const core::FileLocation where = axis.where.file.empty() ? spec_.where : axis.where;
    const scene_file::VariableKind kind = axis.variable->kind;
    if (kind == scene_file::VariableKind::event) {
      bound.bin_of.resize(core::kStepEventCount);
      for (const core::StepEvent event : spec_.at) {
        if (event ==
            core::StepEvent::cut_time)  // in the bin of cut_interactions, which the same word stands for
          bound.bin_of[static_cast<std::size_t>(event)] =
              bound.bin_of[static_cast<std::size_t>(core::StepEvent::cut_interactions)];
        else
          add(static_cast<std::size_t>(event), core::word_of(scene_file::kEventWords, event));
      }
    } else if (kind == scene_file::VariableKind::face) {
      bound.bin_of.resize(scene_.faces.size());
      for (const core::FaceId face : faces_) add(face.index(), scene_.faces[face].name);
    } else {
      bound.bin_of.resize(scene_file::place_of(scene_.parts.next_id()));
      const std::vector<config::NameRef> patterns = axis.names.empty() ? usual_parts(kind) : axis.names;
      const std::vector<bool> parts = picked_parts(patterns, scene_, where);
      if (patterns.empty() && kind == scene_file::VariableKind::part)
        add(scene_file::place_of(core::PartId::none()), kAmbientName);
      for (const core::PartId part : scene_.parts.ids())
        if (parts.empty() || parts[scene_file::place_of(part)])
          add(scene_file::place_of(part), scene_.parts[part].name);
    }
    if (made.names.empty())
      throw core::InputError(
          {where, "an axis of " + made.variable + " without a name", "name some, or remove the axis"});
    bound.bins = static_cast<std::uint32_t>(made.names.size());
    count.axes.push_back(std::move(bound));
    count.empty.axes.push_back(std::move(made));
  }

  /// The default parts of an axis without names; empty: all.
  std::vector<config::NameRef> usual_parts(scene_file::VariableKind kind) const {
    if (kind == scene_file::VariableKind::source_part) return source_parts_;
    const bool at_sensors = std::all_of(spec_.at.begin(), spec_.at.end(), [](core::StepEvent event) {
      return event == core::StepEvent::detected || event == core::StepEvent::not_detected;
    });
    return at_sensors ? sensor_parts(scene_) : std::vector<config::NameRef>{};
  }

  void bind_numbers(const scene_file::TallyAxisSpec& axis, CountRequest& count) {
    CountAxis bound;
    bound.variable = axis.variable;
    bound.along = axis.across_face ? core::face_axes(plane_normal())[static_cast<std::size_t>(axis.across)]
                                   : axis.along;
    double low = axis.low.value_or(0.0), high = axis.high.value_or(0.0);
    bound.ends_low = axis.variable->low && axis.variable->low == axis.low;
    bound.ends_high = axis.variable->high && axis.variable->high == axis.high;
    if (!axis.low || !axis.high) {
      const auto [least, most] = extent(bound.along);
      low = axis.low.value_or(least);
      high = axis.high.value_or(most);
      bound.ends_low = !axis.low;
      bound.ends_high = !axis.high;
    }
    bound.bins = static_cast<std::uint32_t>(axis.bins);
    if (axis.pixel_mm) {
      const double pixels = std::ceil((high - low) / *axis.pixel_mm - 1e-9);
      if (pixels > kMostBins)
        throw core::InputError(
            {axis.where, "the pixels are so small that there are " + std::to_string(pixels) + " in a row",
             "give a larger pixel"});
      const double spare = 0.5 * (pixels * *axis.pixel_mm - (high - low));
      low -= spare;
      high += spare;
      bound.bins = static_cast<std::uint32_t>(pixels);
    }
    bound.low = low;
    bound.per_bin = bound.bins / (high - low);
    TallyAxis made;
    made.variable = axis.variable->name;
    made.unit = axis.variable->unit();
    made.along = {bound.along.x(), bound.along.y(), bound.along.z()};
    for (std::uint32_t i = 0; i <= bound.bins; ++i)
      made.edges.push_back(i == bound.bins ? high : low + i / bound.per_bin);
    count.axes.push_back(std::move(bound));
    count.empty.axes.push_back(std::move(made));
  }

  /// Refractive index of the medium of the directions, 0 for several.
  double medium_index() const {
    scene_file::FaceSide side = scene_file::FaceSide::none;
    for (const scene_file::TallyAxisSpec& axis : spec_.axes)
      if (axis.variable->side != scene_file::FaceSide::none) side = axis.variable->side;
    if (side == scene_file::FaceSide::none ||
        (spec_.way != scene_file::FaceWay::out && spec_.way != scene_file::FaceWay::in))
      return 0.0;
    const bool in_part = (spec_.way == scene_file::FaceWay::out) == (side == scene_file::FaceSide::before);
    core::MediumId medium;
    for (const scene::Interface& interface : scene_.interfaces)
      for (const core::FaceId face : faces_)
        for (const bool back : {true, false}) {
          if ((back ? interface.back_face : interface.front_face) != face) continue;
          const auto medium_at = [&](bool behind) {
            return scene_.regions[behind ? interface.back : interface.front].medium;
          };
          core::MediumId found = medium_at(back == in_part);
          // Light enters an opaque part with matched indices.
          if (scene_.media[found].is_opaque()) found = medium_at(back != in_part);
          if (medium.has_value() && medium != found) return 0.0;
          medium = found;
        }
    if (!medium.has_value()) return 0.0;
    return scene_.optics.index(medium, 0.5 * (scene_.low_nm + scene_.high_nm));
  }

  /// Normal of the plane to which the faces are parallel.
  core::Vec3 plane_normal() const {
    if (spec_.normal) return *spec_.normal;
    const core::Vec3 first = scene_.faces[faces_.front()].area_vector_mm2.normalized();
    for (const core::FaceId face : faces_) {
      const scene::FaceInfo& info = scene_.faces[face];
      if (info.area_vector_mm2.norm() < (1.0 - kFlat) * info.area_mm2)
        throw core::InputError(
            {spec_.where, "the face \"" + info.name + "\" is not flat, so a grid on it has no plane",
             "name a flat face, tag one with [[part.face]], or give the normal of the plane"});
      if (first.cross(info.area_vector_mm2.normalized()).norm() > kFlat)
        throw core::InputError({spec_.where,
                                "the faces \"" + scene_.faces[faces_.front()].name + "\" and \"" + info.name +
                                    "\" are not parallel, so a grid on them has no plane",
                                "name parallel faces, or give the normal of the plane"});
    }
    return first;
  }

  std::pair<double, double> extent(const core::Vec3& along) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const core::FaceId face : faces_)
      for (const core::Vec3& corner : scene_.faces[face].corners) {
        low = std::min(low, along.dot(corner));
        high = std::max(high, along.dot(corner));
      }
    if (!(high > low))
      throw core::InputError(
          {spec_.where, "the face \"" + scene_.faces[faces_.front()].name + "\" has no extent along an axis",
           "measure along another direction, or give from and to"});
    return {low, high};
  }

  const scene_file::TallySpec& spec_;
  const std::vector<config::NameRef>& source_parts_;
  const scene::Scene& scene_;
  std::vector<core::FaceId> faces_;
};

}  // namespace

CountRequest bind_count(const scene_file::TallySpec& spec, const std::vector<config::NameRef>& source_parts,
                        const scene::Scene& scene) {
  return CountBinder(spec, source_parts, scene).bind();
}

std::vector<core::FaceId> faces_of(const scene_file::TallySpec& spec, const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::FaceInfo& face : scene.faces) names.push_back(face.name);
  const std::vector<bool> wanted = picked(spec.faces, names, "face", spec.where);
  std::vector<core::FaceId> faces;
  for (const core::FaceId face : scene.faces.ids())
    if (wanted[face.index()]) faces.push_back(face);
  return faces;
}

}  // namespace scintray::tally
