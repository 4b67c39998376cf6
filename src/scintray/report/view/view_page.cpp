#include "scintray/report/view/view_page.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "scintray/core/error.hpp"
#include "scintray/report/detail/embedded_file.hpp"
#include "scintray/report/plots/png_image.hpp"
#include "scintray/report/plots/scene_picture.hpp"
#include "scintray/report/text/format.hpp"

SCINTRAY_EMBED(scintray_view_page, SCINTRAY_VIEW_FOLDER "/view_page.html");
SCINTRAY_EMBED(scintray_view_style, SCINTRAY_VIEW_FOLDER "/view_page.css");
SCINTRAY_EMBED(scintray_view_script, SCINTRAY_VIEW_FOLDER "/view_page.js");
#ifdef SCINTRAY_THREE_JS
SCINTRAY_EMBED(scintray_three, SCINTRAY_THREE_JS);
SCINTRAY_EMBED(scintray_three_controls, SCINTRAY_ORBIT_CONTROLS_JS);
#endif

namespace scintray::report {

namespace {

using Json = nlohmann::json;

/// Positions of names in a list without repetitions.
class Names {
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

Json triple(const core::Vec3& v) { return {v.x(), v.y(), v.z()}; }

template <typename Number>
std::string packed(const std::vector<Number>& numbers) {
  static_assert(std::endian::native == std::endian::little, "the page reads little-endian numbers");
  return base64(std::as_bytes(std::span(numbers)));
}

/// Collects the distinct shapes of parts: equal up to a translation, at the precision in which they are
/// drawn.
class Shapes {
 public:
  /// Index of the part's shape; its first vertex is the origin of the shape.
  std::size_t of(const ViewPart& part) {
    std::vector<float> vertices;
    std::vector<std::uint32_t> triangles;
    const core::Vec3 origin = origin_of(part);
    for (const core::Vec3& v : part.mesh->vertices)
      for (int axis = 0; axis < 3; ++axis) vertices.push_back(rounded(v[axis] - origin[axis]));
    for (const auto& triangle : part.mesh->triangles)
      triangles.insert(triangles.end(), {triangle[0], triangle[1], triangle[2]});
    Json shape{{"v", packed(vertices)}, {"t", packed(triangles)}, {"f", packed(part.face_of)}};
    const auto [at, is_new] = index_.try_emplace(shape.dump(), list_.size());
    if (is_new) list_.push_back(std::move(shape));
    return at->second;
  }
  static core::Vec3 origin_of(const ViewPart& part) {
    return part.mesh->vertices.empty() ? core::Vec3(core::Vec3::Zero()) : part.mesh->vertices.front();
  }
  const Json& list() const { return list_; }

 private:
  /// To 2^-20 mm, so that translated copies have the same numbers.
  static float rounded(double mm) { return static_cast<float>(std::round(mm * 0x1p20) * 0x1p-20); }

  std::map<std::string, std::size_t> index_;
  Json list_ = Json::array();
};

std::string css_colour(std::size_t index) {
  const Colour c = picture_colour(index);
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", c.red, c.green, c.blue);
  return text.data();
}

Json parts_json(const SceneView& view, Json& data) {
  Names media, surfaces, face_lists;
  Shapes shapes;
  Json lists = Json::array(), parts = Json::array();
  for (const ViewPart& part : view.parts) {
    Json faces = Json::array();
    for (const ViewFace& face : part.faces)
      faces.push_back({{"n", face.name},
                       {"s", surfaces.of(face.surface.empty() ? "smooth" : face.surface)},
                       {"d", face.sensor}});
    const std::size_t known = face_lists.list().size(), list = face_lists.of(faces.dump());
    if (list == known) lists.push_back(std::move(faces));
    parts.push_back({{"n", part.name},
                     {"m", media.of(part.medium)},
                     {"s", shapes.of(part)},
                     {"o", triple(Shapes::origin_of(part))},
                     {"l", list}});
  }
  const auto coloured = [](const std::vector<std::string>& names) {
    Json list = Json::array();
    for (std::size_t i = 0; i < names.size(); ++i) list.push_back({{"n", names[i]}, {"c", css_colour(i)}});
    return list;
  };
  data["media"] = coloured(media.list());
  data["surfaces"] = coloured(surfaces.list());
  data["shapes"] = shapes.list();
  data["faces"] = std::move(lists);
  return parts;
}

Json paths_json(const SceneView& view, Json& data) {
  Names events, fates;
  Json paths = Json::array();
  for (const ViewPath& path : view.paths) {
    std::vector<float> numbers;  // time and wavelength of each vertex
    std::vector<double> places;
    std::vector<std::uint32_t> words;
    for (const ViewVertex& vertex : path.vertices) {
      for (int axis = 0; axis < 3; ++axis) places.push_back(vertex.position[axis]);
      numbers.push_back(static_cast<float>(vertex.time_ns));
      numbers.push_back(static_cast<float>(vertex.wavelength_nm));
      words.push_back(static_cast<std::uint32_t>(events.of(vertex.event)));
    }
    paths.push_back({{"n", path.name},
                     {"f", fates.of(fate_text(path.fate))},
                     {"p", packed(places)},
                     {"v", packed(numbers)},
                     {"e", packed(words)}});
  }
  data["fates"] = fates.list();
  data["events"] = events.list();
  return paths;
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

std::string replaced(std::string_view page, const std::map<std::string, std::string_view>& texts) {
  std::string result;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t mark = page.find("@@", at), end = mark == page.npos ? mark : page.find("@@", mark + 2);
    if (end == page.npos) return result.append(page.substr(at));
    result.append(page.substr(at, mark - at))
        .append(texts.at(std::string(page.substr(mark + 2, end - mark - 2))));
    at = end + 2;
  }
  return result;
}

}  // namespace

bool can_view() {
#ifdef SCINTRAY_THREE_JS
  return true;
#else
  return false;
#endif
}

std::string view_page(const SceneView& view) {
  if (!can_view())
    throw core::SystemError(
        "this ScintRay was built without three.js, which draws scenes in three dimensions; on Debian install "
        "libjs-three and build again");
  Json data{{"title", view.title}};
  data["parts"] = parts_json(view, data);
  data["paths"] = paths_json(view, data);
  data["marks"] = Json::array();
  for (const ViewMark& mark : view.marks) {
    Json places = Json::array();
    for (const core::Vec3& place : mark.places) places.push_back(triple(place));
    data["marks"].push_back({{"t", mark.text}, {"p", std::move(places)}});
  }
  const std::string title = escape_html(view.title), json = script_safe(data.dump());
  std::map<std::string, std::string_view> texts{{"TITLE", title}, {"DATA", json}};
  texts["STYLE"] = {scintray_view_style, scintray_view_style_end};
  texts["SCRIPT"] = {scintray_view_script, scintray_view_script_end};
#ifdef SCINTRAY_THREE_JS
  texts["THREE"] = {scintray_three, scintray_three_end};
  texts["CONTROLS"] = {scintray_three_controls, scintray_three_controls_end};
#endif
  return replaced({scintray_view_page, scintray_view_page_end}, texts);
}

}  // namespace scintray::report
