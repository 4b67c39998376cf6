#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "scintray/report/plots/png_image.hpp"
#include "scintray/report/plots/scene_picture.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/view/detail/view_data.hpp"

namespace scintray::report {

namespace {

using ViewJson = nlohmann::json;

/// Positions of names in a list without repetitions.
class ViewNames {
 public:
  std::size_t of(const std::string& name) {
    const auto [at, is_new] = index_.try_emplace(name, index_.size());
    if (is_new) list_.push_back(name);
    return at->second;
  }
  const std::vector<std::string>& list() const { return list_; }

 private:
  std::map<std::string, std::size_t> index_;
  std::vector<std::string> list_;
};

ViewJson triple(const core::Vec3& v) { return {v.x(), v.y(), v.z()}; }

template <typename Number>
std::string packed(const std::vector<Number>& numbers) {
  static_assert(std::endian::native == std::endian::little, "the page reads little-endian numbers");
  return base64(std::as_bytes(std::span(numbers)));
}

/// Integers in as few bytes each as the largest of them needs: 1, 2 or 4.
struct PackedIntegers {
  std::string text;
  int width = 1;
};

PackedIntegers packed_integers(const std::vector<std::uint32_t>& numbers) {
  const std::uint32_t most = numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end());
  if (most <= std::numeric_limits<std::uint8_t>::max())
    return {packed(std::vector<std::uint8_t>(numbers.begin(), numbers.end())), 1};
  if (most <= std::numeric_limits<std::uint16_t>::max())
    return {packed(std::vector<std::uint16_t>(numbers.begin(), numbers.end())), 2};
  return {packed(numbers), 4};
}

/// A number from `low` to `high` as a share of 65535.
std::uint16_t share_of(double number, double low, double high) {
  if (!(high > low)) return 0;
  return static_cast<std::uint16_t>(
      std::lround(65535.0 * std::clamp((number - low) / (high - low), 0.0, 1.0)));
}

/// Least and largest coordinates of points.
struct Box {
  core::Vec3 low = core::Vec3::Zero(), high = core::Vec3::Zero();
  bool is_empty = true;

  void extend(const core::Vec3& point) {
    low = is_empty ? point : core::Vec3(low.cwiseMin(point));
    high = is_empty ? point : core::Vec3(high.cwiseMax(point));
    is_empty = false;
  }
  void add_shares(const core::Vec3& point, std::vector<std::uint16_t>& shares) const {
    for (int axis = 0; axis < 3; ++axis) shares.push_back(share_of(point[axis], low[axis], high[axis]));
  }
  ViewJson json() const { return {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()}; }
};

/// Collects the distinct shapes of parts: equal up to a translation, at the precision in which they are
/// drawn.
class Shapes {
 public:
  /// Index of the part's shape; its first vertex is the origin of the shape.
  std::size_t of(const ViewPart& part) {
    std::vector<core::Vec3> places;
    Box box;
    const core::Vec3 origin = origin_of(part);
    for (const core::Vec3& v : part.mesh->vertices) {
      places.push_back(rounded(v - origin));
      box.extend(places.back());
    }
    std::vector<std::uint16_t> vertices;
    for (const core::Vec3& place : places) box.add_shares(place, vertices);
    std::vector<std::uint32_t> triangles;
    for (const auto& triangle : part.mesh->triangles)
      triangles.insert(triangles.end(), {triangle[0], triangle[1], triangle[2]});
    const PackedIntegers corners = packed_integers(triangles), faces = packed_integers(part.face_of);
    ViewJson shape{{"b", box.json()},     {"v", packed(vertices)}, {"t", corners.text},
                   {"tw", corners.width}, {"f", faces.text},       {"fw", faces.width}};
    const auto [at, is_new] = index_.try_emplace(shape.dump(), list_.size());
    if (is_new) list_.push_back(std::move(shape));
    return at->second;
  }
  static core::Vec3 origin_of(const ViewPart& part) {
    return part.mesh->vertices.empty() ? core::Vec3(core::Vec3::Zero()) : part.mesh->vertices.front();
  }
  const ViewJson& list() const { return list_; }

 private:
  /// To 2^-20 mm, so that translated copies have the same numbers.
  static core::Vec3 rounded(const core::Vec3& mm) {
    core::Vec3 result;
    for (int axis = 0; axis < 3; ++axis) result[axis] = std::round(mm[axis] * 0x1p20) * 0x1p-20 + 0.0;
    return result;
  }

  std::map<std::string, std::size_t> index_;
  ViewJson list_ = ViewJson::array();
};

std::string css_colour(std::size_t index) {
  const Colour c = picture_colour(index);
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", c.red, c.green, c.blue);
  return text.data();
}

ViewJson parts_json(const SceneView& view, ViewJson& data) {
  ViewNames media, surfaces, face_lists;
  Shapes shapes;
  ViewJson lists = ViewJson::array(), parts = ViewJson::array();
  for (const ViewPart& part : view.parts) {
    ViewJson faces = ViewJson::array();
    for (const ViewFace& face : part.faces)
      faces.push_back({{"n", face.name},
                       {"s", surfaces.of(face.surface.empty() ? "smooth" : face.surface)},
                       {"d", face.sensor},
                       {"w", face.stated_at}});
    const std::size_t known = face_lists.list().size(), list = face_lists.of(faces.dump());
    if (list == known) lists.push_back(std::move(faces));
    parts.push_back({{"n", part.name},
                     {"m", media.of(part.medium)},
                     {"s", shapes.of(part)},
                     {"o", triple(Shapes::origin_of(part))},
                     {"l", list}});
  }
  const auto coloured = [](const std::vector<std::string>& names) {
    ViewJson list = ViewJson::array();
    for (std::size_t i = 0; i < names.size(); ++i) list.push_back({{"n", names[i]}, {"c", css_colour(i)}});
    return list;
  };
  data["media"] = coloured(media.list());
  data["surfaces"] = coloured(surfaces.list());
  data["shapes"] = shapes.list();
  data["faces"] = std::move(lists);
  return parts;
}

/// Wavelengths of a path: step and wavelength wherever it changes.
ViewJson wavelength_changes(const tally::PhotonPath& path) {
  ViewJson changes = ViewJson::array();
  double before = -1.0;
  for (std::size_t i = 0; i < path.steps.size(); ++i) {
    const double nm = std::round(100.0 * path.steps[i].wavelength_nm) / 100.0;
    if (nm != before) changes.push_back({i, nm});
    before = nm;
  }
  return changes;
}

/// Number of paths, from the first, whose steps a page holds.
std::size_t paths_that_fit(const std::vector<tally::PhotonPath>& paths) {
  std::size_t steps = 0, count = 0;
  while (count < paths.size() && steps + paths[count].steps.size() <= kMostViewSteps)
    steps += paths[count++].steps.size();
  return count;
}

ViewJson paths_json(const SceneView& view, ViewJson& data) {
  ViewNames events, fates;
  ViewJson paths = ViewJson::array();
  const std::size_t count = paths_that_fit(view.paths);
  Box box;
  for (std::size_t i = 0; i < count; ++i)
    for (const tally::PathStep& step : view.paths[i].steps) box.extend(step.position);
  std::vector<std::uint16_t> places, times;
  std::vector<std::uint32_t> words;
  for (std::size_t i = 0; i < count; ++i) {
    const tally::PhotonPath& path = view.paths[i];
    const double first_ns = path.steps.front().time_ns, last_ns = path.steps.back().time_ns;
    for (const tally::PathStep& step : path.steps) {
      box.add_shares(step.position, places);
      times.push_back(share_of(step.time_ns, first_ns, last_ns));
      words.push_back(static_cast<std::uint32_t>(events.of(step.text)));
    }
    paths.push_back({{"n", "event " + std::to_string(path.event) + ", photon " + std::to_string(path.photon)},
                     {"f", fates.of(fate_text(path.fate))},
                     {"k", path.steps.size()},
                     {"t", {first_ns, last_ns}},
                     {"w", wavelength_changes(path)}});
  }
  const PackedIntegers happened = packed_integers(words);
  data["steps"] = {{"b", box.json()},
                   {"p", packed(places)},
                   {"t", packed(times)},
                   {"e", happened.text},
                   {"ew", happened.width}};
  data["left_out"] = view.paths.size() - count;
  data["fates"] = fates.list();
  data["events"] = events.list();
  return paths;
}

ViewJson tallies_json(const SceneView& view) {
  ViewJson list = ViewJson::array();
  for (const ViewTally& tally : view.tallies) {
    const std::vector<double>& values = tally.grid ? tally.grid->values : tally.of_faces;
    ViewJson entry{{"n", tally.name},
                   {"u", tally.unit},
                   {"v", packed(std::vector<float>(values.begin(), values.end()))}};
    if (tally.grid) {
      const ViewGrid& grid = *tally.grid;
      const PackedIntegers faces = packed_integers(tally.faces);
      entry["g"] = {{"a", grid.along},
                    {"b", {grid.low_mm[0], grid.high_mm[0], grid.low_mm[1], grid.high_mm[1]}},
                    {"n", grid.bins}};
      entry["f"] = faces.text;
      entry["fw"] = faces.width;
    }
    list.push_back(std::move(entry));
  }
  return list;
}

/// What the first point of a run counted at parts, faces, surfaces and in media.
ViewJson ledger_json(const tally::RunResult& run) {
  const tally::PointResult& point = run.points.front();
  const auto counts = [](const auto& names, const auto& values) {
    ViewJson object = ViewJson::object();
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) object[names[i]] = values[i];
    return object;
  };
  std::map<std::string, std::array<std::uint64_t, 2>> faces, parts;
  for (const tally::SensorFaceCount& count : point.sensor_faces) {
    if (!run.header.faces.contains(count.face) || !run.header.parts.contains(count.part)) continue;
    for (auto* sum : {&faces[run.header.faces[count.face]], &parts[run.header.parts[count.part]]}) {
      (*sum)[0] += count.detected;
      (*sum)[1] += count.not_detected;
    }
  }
  return {{"n", point.photons},
          {"media", counts(run.header.media.values(), point.absorbed_in_medium.values())},
          {"surfaces", counts(run.header.surfaces.values(), point.absorbed_at_surface.values())},
          {"faces", faces},
          {"parts", parts}};
}

/// JSON inside a script element: no "<" that could end it (HTML, section 4.12.1.3).
std::string script_safe(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

}  // namespace

std::string view_data(const SceneView& view, const tally::RunResult* run) {
  ViewJson data{{"title", view.title}};
  data["parts"] = parts_json(view, data);
  data["paths"] = paths_json(view, data);
  data["marks"] = ViewJson::array();
  for (const ViewMark& mark : view.marks) {
    ViewJson places = ViewJson::array();
    for (const core::Vec3& place : mark.places) places.push_back(triple(place));
    data["marks"].push_back({{"t", mark.text}, {"p", std::move(places)}});
  }
  data["tallies"] = tallies_json(view);
  if (run && !run->points.empty() && run->points.front().photons > 0) data["ledger"] = ledger_json(*run);
  return script_safe(data.dump(-1, ' ', false, ViewJson::error_handler_t::replace));
}

}  // namespace scintray::report
