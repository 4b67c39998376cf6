#include "scintray/report/plots/scene_picture.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

constexpr double kView = 420.0;   ///< side of a view's square
constexpr double kMargin = 34.0;  ///< around and between views
constexpr double kLine = 19.0;    ///< of text
constexpr std::size_t kTextLength = 150;

/// Axes of space that point right and up in a view; the viewer looks against `toward`.
struct View {
  const char* title;
  const char* right_name;
  const char* up_name;
  core::Vec3 right, up, toward;
};

std::array<View, 3> views() {
  return {View{"front", "x", "z", core::Vec3::UnitX(), core::Vec3::UnitZ(), -core::Vec3::UnitY()},
          View{"side", "y", "z", core::Vec3::UnitY(), core::Vec3::UnitZ(), core::Vec3::UnitX()},
          View{"top", "x", "y", core::Vec3::UnitX(), core::Vec3::UnitY(), core::Vec3::UnitZ()}};
}

std::string css(const Colour& c) { return fmt::format("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue); }

std::string text_at(double x, double y, const std::string& words, const std::string& more = {}) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", x, y, more, escape_html(words));
}

/// The largest of 1, 2, 5 times a power of ten that is at most `length`.
double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double step : {5.0, 2.0})
    if (step * power <= length) return step * power;
  return power;
}

/// Draws one view of all parts.
class ViewPainter {
 public:
  ViewPainter(const View& view, const Eigen::AlignedBox3d& box, double per_mm, double left, double top)
      : view_(view), centre_(box.center()), per_mm_(per_mm), left_(left), top_(top) {}

  double x(const core::Vec3& p) const { return left_ + 0.5 * kView + per_mm_ * view_.right.dot(p - centre_); }
  double y(const core::Vec3& p) const { return top_ + 0.5 * kView - per_mm_ * view_.up.dot(p - centre_); }

  /// Coordinate of the part's nearest point towards the viewer, mm.
  double nearest(const mesh::TriMesh& mesh) const {
    double most = -HUGE_VAL;
    for (const core::Vec3& v : mesh.vertices) most = std::max(most, view_.toward.dot(v));
    return most;
  }

  std::string part(const mesh::TriMesh& mesh, const std::string& colour) const {
    std::string faces;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!seen(mesh, t)) continue;
      const auto& [a, b, c] = mesh.triangles[t];
      faces +=
          fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f} {:.1f} {:.1f}Z", x(mesh.vertices[a]), y(mesh.vertices[a]),
                      x(mesh.vertices[b]), y(mesh.vertices[b]), x(mesh.vertices[c]), y(mesh.vertices[c]));
    }
    return fmt::format(
        "<path d=\"{}\" fill=\"{}\" fill-opacity=\"0.3\"/><path d=\"{}\" fill=\"none\" stroke=\"{}\" "
        "stroke-width=\"0.8\"/>\n",
        faces, colour, edges(mesh), colour);
  }

 private:
  bool seen(const mesh::TriMesh& mesh, std::size_t t) const {
    return mesh.area_vector(t).dot(view_.toward) > 0.0;
  }

  /// Edges on the outline, open edges, and those where the surface bends.
  std::string edges(const mesh::TriMesh& mesh) const {
    constexpr double kFlat = 0.94;  // cosine of 20 deg
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> beside;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        beside[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(t);
    std::string path;
    for (const auto& [ends, triangles] : beside) {
      const bool front =
          std::any_of(triangles.begin(), triangles.end(), [&](std::size_t t) { return seen(mesh, t); });
      bool drawn = triangles.size() != 2;
      if (!drawn) {
        const core::Vec3 a = mesh.area_vector(triangles[0]), b = mesh.area_vector(triangles[1]);
        drawn =
            seen(mesh, triangles[0]) != seen(mesh, triangles[1]) || a.dot(b) < kFlat * a.norm() * b.norm();
      }
      if (!drawn || !(front || triangles.size() == 1)) continue;
      const core::Vec3 &p = mesh.vertices[ends.first], &q = mesh.vertices[ends.second];
      path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x(p), y(p), x(q), y(q));
    }
    return path;
  }

  View view_;
  core::Vec3 centre_;
  double per_mm_, left_, top_;
};

std::string frame_of(const View& view, double left, double top) {
  const double bottom = top + kView;
  return fmt::format(
             "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
             "stroke=\"#c8ced4\"/>\n",
             left, top, kView, kView) +
         text_at(left, top - 8,
                 fmt::format("{}: {} to the right, {} up", view.title, view.right_name, view.up_name),
                 " font-weight=\"600\"") +
         fmt::format(
             "<path d=\"M{0:.1f} {1:.1f}v-22m-3 5l3 -5 3 5M{0:.1f} {1:.1f}h22m-5 -3l5 3 -5 3\" fill=\"none\" "
             "stroke=\"#5c6670\"/>\n",
             left + 8, bottom - 8);
}

std::string scale_bar(double per_mm, double left, double top) {
  const double length = round_length(0.3 * kView / per_mm);
  return fmt::format("<path d=\"M{:.1f} {:.1f}v-5v10v-5h{:.1f}v-5v10\" fill=\"none\" stroke=\"#1b1f24\"/>\n",
                     left, top, length * per_mm) +
         text_at(left + length * per_mm + 8, top + 4, compact(length) + " mm");
}

std::string ring(double x, double y) {
  return fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\" fill=\"#d00000\" fill-opacity=\"0.35\" stroke=\"#d00000\" "
      "stroke-width=\"1.6\"/>",
      x, y);
}

std::string label(double x, double y, const std::string& words) {
  return text_at(x, y, words,
                 " fill=\"#b00000\" font-weight=\"700\" stroke=\"#fff\" stroke-width=\"3\" "
                 "paint-order=\"stroke\"");
}

/// Rings of one view; coincident marks share a ring and its label.
std::string rings(const ViewPainter& painter, const std::vector<PictureMark>& marks) {
  constexpr double kSpot = 10.0;
  struct Spot {
    double x, y;
    std::vector<std::size_t> numbers;
  };
  std::vector<Spot> spots;
  for (std::size_t m = 0; m < marks.size(); ++m)
    for (const core::Vec3& place : marks[m].places) {
      const double x = painter.x(place), y = painter.y(place);
      const auto same = std::find_if(spots.begin(), spots.end(),
                                     [&](const Spot& s) { return std::hypot(s.x - x, s.y - y) < kSpot; });
      Spot& spot = same != spots.end() ? *same : spots.emplace_back(Spot{x, y, {}});
      if (spot.numbers.empty() || spot.numbers.back() != m + 1) spot.numbers.push_back(m + 1);
    }
  // A number is drawn where it covers no other: to the right, left, above or below its ring. A mark of many
  // places has its number at one of them at least.
  constexpr double kDigit = 8.0, kHeight = 14.0;
  struct Box {
    double x, y, width;
  };
  std::vector<Box> taken;
  std::vector<bool> numbered(marks.size(), false);
  const auto free = [&](const Box& box) {
    return std::none_of(taken.begin(), taken.end(), [&](const Box& other) {
      return box.x < other.x + other.width && other.x < box.x + box.width &&
             std::abs(box.y - other.y) < kHeight;
    });
  };
  std::string svg, labels;
  for (const Spot& spot : spots) {
    svg += ring(spot.x, spot.y);
    const std::string text = fmt::format("{}", fmt::join(spot.numbers, ","));
    const double width = kDigit * static_cast<double>(text.size());
    const std::array<Box, 4> places{
        Box{spot.x + 8, spot.y - 5, width}, Box{spot.x - 8 - width, spot.y - 5, width},
        Box{spot.x - 0.5 * width, spot.y - 11, width}, Box{spot.x - 0.5 * width, spot.y + 21, width}};
    const auto* place = std::find_if(places.begin(), places.end(), free);
    const bool known = std::all_of(spot.numbers.begin(), spot.numbers.end(),
                                   [&](std::size_t number) { return numbered[number - 1]; });
    Box box = place != places.end() ? *place : places.front();
    if (place == places.end()) {
      if (known) continue;
      while (!free(box)) box.y += kHeight;
      labels +=
          fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#b00000\" stroke-width=\"0.8\"/>\n",
                      spot.x, spot.y, box.x, box.y);
    }
    for (const std::size_t number : spot.numbers) numbered[number - 1] = true;
    taken.push_back(box);
    labels += label(box.x, box.y, text);
  }
  svg += labels;
  return svg;
}

/// At most `most` bytes of a text, cut between characters of UTF-8.
std::string shortened(const std::string& text) {
  if (text.size() <= kTextLength) return text;
  std::size_t end = kTextLength - 3;
  while ((static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

Eigen::AlignedBox3d bounds_of(const std::vector<PicturePart>& parts, const std::vector<PictureMark>& marks) {
  Eigen::AlignedBox3d box;
  for (const PicturePart& part : parts)
    for (const core::Vec3& v : part.mesh->vertices) box.extend(v);
  for (const PictureMark& mark : marks)
    for (const core::Vec3& place : mark.places) box.extend(place);
  return box.isEmpty() ? Eigen::AlignedBox3d(core::Vec3::Constant(-1.0), core::Vec3::Constant(1.0)) : box;
}

}  // namespace

Colour picture_colour(std::size_t index) {
  constexpr std::array<Colour, 6> kColours{Colour{0, 114, 178}, {0, 158, 115},   {230, 159, 0},
                                           {86, 180, 233},      {204, 121, 167}, {120, 120, 120}};
  return kColours[index % kColours.size()];
}

std::string scene_svg(const std::vector<PicturePart>& parts, const std::vector<PictureMark>& marks) {
  const Eigen::AlignedBox3d box = bounds_of(parts, marks);
  const double per_mm = 0.9 * kView / std::max(box.sizes().maxCoeff(), 1e-9);
  std::map<std::string, std::size_t> number;
  std::vector<std::string> media;
  for (const PicturePart& part : parts)
    if (number.try_emplace(part.medium, media.size()).second) media.push_back(part.medium);

  std::string body;
  double left = kMargin;
  const double top = kMargin + kLine;
  for (const View& view : views()) {
    const ViewPainter painter(view, box, per_mm, left, top);
    body += frame_of(view, left, top);
    std::vector<std::pair<double, const PicturePart*>> order;
    for (const PicturePart& part : parts) order.emplace_back(painter.nearest(*part.mesh), &part);
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& entry : order)
      body += painter.part(*entry.second->mesh, css(picture_colour(number.at(entry.second->medium))));
    body += rings(painter, marks);
    left += kView + kMargin;
  }
  double y = top + kView + kMargin;
  body += scale_bar(per_mm, kMargin, y);
  double x = kMargin + 0.5 * kView;
  for (std::size_t m = 0; m < media.size(); ++m) {
    body += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"12\" fill=\"{}\" fill-opacity=\"0.5\"/>\n", x,
        y - 8, css(picture_colour(m)));
    body += text_at(x + 18, y + 3, media[m]);
    x += 34 + 7.5 * static_cast<double>(media[m].size());
  }
  y += kLine;
  for (std::size_t m = 0; m < marks.size(); ++m) {
    y += kLine;
    body += ring(kMargin + 6, y - 4) + label(kMargin + 18, y, std::to_string(m + 1)) +
            text_at(kMargin + 44, y, shortened(marks[m].text));
  }
  const double width = left, height = y + kMargin;
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
             "{0:.0f} "
             "{1:.0f}\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#1b1f24\">\n"
             "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"white\"/>\n",
             width, height) +
         body + "</svg>\n";
}

}  // namespace scintray::report
