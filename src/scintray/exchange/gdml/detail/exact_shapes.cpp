#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scintray/exchange/gdml/detail/solid_reader.hpp"

namespace scintray::exchange::gdml {

namespace {

/// Most flat sides of a shape of a scene file.
constexpr int kMostSegments = 10'000;

/// A profile about the z axis with smooth ranges.
struct SmoothProfile {
  std::vector<std::array<double, 2>> corners;      ///< (r, z), mm
  std::vector<std::array<std::size_t, 2>> ranges;  ///< first and last corners

  void add_range(const std::vector<std::array<double, 2>>& points) {
    ranges.push_back({corners.size(), corners.size() + points.size() - 1});
    corners.insert(corners.end(), points.begin(), points.end());
  }
};

/// A solid of revolution whose squared radius is a quadratic function of z, or a torus.
class ExactShape : public SolidReader {
 public:
  using SolidReader::SolidReader;

  std::optional<std::string> write() const {
    const std::string_view kind = solid_.name();
    if (kind == "torus") return torus();
    if (kind == "ellipsoid") return ellipsoid();
    if (kind == "paraboloid") return paraboloid();
    if (kind == "hype") return hyperboloid();
    return std::nullopt;
  }

 private:
  int around(double radius_mm) const {
    return std::min(kMostSegments, segments_about(radius_mm, core::kTwoPi, 3));
  }

  bool is_full_turn() const {
    constexpr double kRounding = 1e-9;
    return angle("deltaphi", core::kTwoPi) >= core::kTwoPi - kRounding;
  }

  std::string text(const SmoothProfile& profile) const {
    std::string r, z, smooth;
    double widest = 0.0;
    for (const auto& corner : profile.corners) {
      const char* comma = r.empty() ? "" : ", ";
      r += fmt::format("{}\"{:.17g} mm\"", comma, corner[0]);
      z += fmt::format("{}\"{:.17g} mm\"", comma, corner[1]);
      widest = std::max(widest, corner[0]);
    }
    for (const auto& range : profile.ranges)
      smooth += fmt::format("{}{}, {}", smooth.empty() ? "" : ", ", range[0], range[1]);
    if (!smooth.empty()) smooth = "smooth = [" + smooth + "], ";
    return fmt::format("revolved = {{ r = [{}], z = [{}], {}segments = {} }}\n", r, z, smooth,
                       around(widest));
  }

  std::optional<std::string> torus() const {
    const double tube = size("rmax"), swept = size("rtor");
    if (length("rmin") > 0.0 || !is_full_turn()) return std::nullopt;
    return fmt::format(
        "torus = {{ radius = \"{:.17g} mm\", tube_radius = \"{:.17g} mm\", segments = {}, tube_segments = {} "
        "}}\n",
        swept, tube, around(swept + tube), around(tube));
  }

  std::optional<std::string> ellipsoid() const {
    const double across = size("ax"), along = size("cz");
    if (size("by") != across || across == along) return std::nullopt;  // a sphere is recognized
    double low = length("zcut1"), high = length("zcut2");
    if (low == 0.0 && high == 0.0) low = -along, high = along;  // both left out: no cuts
    low = std::max(low, -along);
    high = high == 0.0 ? along : std::min(high, along);
    const double from = std::asin(low / along), to = std::asin(high / along);
    const int steps = std::max(4, around(std::max(across, along)) / 4);
    std::vector<std::array<double, 2>> wall;
    for (int i = 0; i <= steps; ++i) {
      const double z = i == 0 ? low : i == steps ? high : along * std::sin(from + (to - from) * i / steps);
      wall.push_back({across * std::sqrt(std::max(0.0, 1.0 - z * z / (along * along))), z});
    }
    return text(between_axis_and(wall));
  }

  std::optional<std::string> paraboloid() const {
    const double low = length("rlo"), high = size("rhi"), half = size("dz");
    const int steps = std::max(4, around(high) / 8);
    std::vector<std::array<double, 2>> wall;
    for (int i = 0; i <= steps; ++i) {
      const double r = i == steps ? high : low + (high - low) * i / steps;
      const double z = half * (2.0 * (r * r - low * low) / (high * high - low * low) - 1.0);
      wall.push_back({r, i == steps ? half : z});
    }
    return text(between_axis_and(wall));
  }

  std::optional<std::string> hyperboloid() const {
    const double half = 0.5 * size("z"), inner = length("rmin"), outer = size("rmax");
    const double inner_slope = std::tan(angle("inst")), outer_slope = std::tan(angle("outst"));
    if (!is_full_turn() || (inner <= 0.0 && inner_slope != 0.0)) return std::nullopt;
    const auto wall = [&](double waist, double slope) {
      const int steps =
          slope == 0.0 ? 1 : std::max(8, around(std::max(std::hypot(waist, slope * half), half)) / 4);
      std::vector<std::array<double, 2>> points;
      for (int i = 0; i <= steps; ++i) {
        const double z = half * (2.0 * i / steps - 1.0);
        points.push_back({std::hypot(waist, slope * z), z});
      }
      return points;
    };
    const std::vector<std::array<double, 2>> outside = wall(outer, outer_slope);
    if (inner <= 0.0) return text(between_axis_and(outside));
    SmoothProfile profile;
    const auto add = [&](const std::vector<std::array<double, 2>>& points) {
      if (points.size() > 2) return profile.add_range(points);
      profile.corners.insert(profile.corners.end(), points.begin(), points.end());  // a cylinder
    };
    std::vector<std::array<double, 2>> bore = wall(inner, inner_slope);
    std::reverse(bore.begin(), bore.end());
    add(outside);
    add(bore);
    return text(profile);
  }

  /// The body inside a wall, which is given upwards; flat ends where it does not begin or end on the axis.
  static SmoothProfile between_axis_and(const std::vector<std::array<double, 2>>& wall) {
    SmoothProfile profile;
    if (wall.front()[0] > 0.0) profile.corners.push_back({0.0, wall.front()[1]});
    if (wall.size() > 2)
      profile.add_range(wall);
    else
      profile.corners.insert(profile.corners.end(), wall.begin(), wall.end());
    if (wall.back()[0] > 0.0) profile.corners.push_back({0.0, wall.back()[1]});
    return profile;
  }
};

}  // namespace

std::optional<std::string> exact_shape(Node solid, const Definitions& definitions,
                                       const mesh::Tessellation& tessellation) {
  return ExactShape(solid, definitions, tessellation).write();
}

}  // namespace scintray::exchange::gdml
