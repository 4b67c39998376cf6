#include "scintray/mesh/shapes/polygon.hpp"

#include <Eigen/Core>
#include <numeric>

namespace scintray::mesh {
namespace {

using Vec2 = Eigen::Vector2d;

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The corners seen against the Newell normal, so that they run counter-clockwise.
std::vector<Vec2> flattened(const std::vector<core::Vec3>& corners) {
  core::Vec3 normal = core::Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
  }
  const core::Frame frame = core::Frame::about(normal.norm() > 0.0 ? core::Vec3(normal.normalized())
                                                                   : core::Vec3(core::Vec3::UnitZ()));
  std::vector<Vec2> flat;
  flat.reserve(corners.size());
  for (const core::Vec3& corner : corners) {
    const core::Vec3 relative = corner - corners[0];
    flat.emplace_back(relative.dot(frame.x), relative.dot(frame.y));
  }
  return flat;
}

class EarClipper {
 public:
  explicit EarClipper(const std::vector<core::Vec3>& corners)
      : flat_(flattened(corners)), left_(corners.size()) {
    std::iota(left_.begin(), left_.end(), 0U);
  }

  std::vector<std::array<std::uint32_t, 3>> clip(bool& simple) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    while (left_.size() > 3) {
      std::size_t ear = find_ear();
      if (ear == left_.size()) {
        ear = find_flat_corner();
        if (ear == left_.size()) {
          simple = false;
          ear = 1;
        }
      }
      triangles.push_back({before(ear), left_[ear], after(ear)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({left_[0], left_[1], left_[2]});
    return triangles;
  }

 private:
  std::uint32_t before(std::size_t i) const { return left_[(i + left_.size() - 1) % left_.size()]; }
  std::uint32_t after(std::size_t i) const { return left_[(i + 1) % left_.size()]; }
  double turn_at(std::size_t i) const { return turn(flat_[before(i)], flat_[left_[i]], flat_[after(i)]); }

  /// A convex corner whose triangle holds no corner that is not convex; from the second corner on, so
  /// that convex polygons become fans.
  std::size_t find_ear() const {
    std::vector<std::uint32_t> reflex;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (turn_at(i) <= 0.0) reflex.push_back(left_[i]);
    }
    for (std::size_t k = 1; k <= left_.size(); ++k) {
      const std::size_t i = k % left_.size();
      if (turn_at(i) > 0.0 && holds_none(i, reflex)) return i;
    }
    return left_.size();
  }

  bool holds_none(std::size_t i, const std::vector<std::uint32_t>& candidates) const {
    const Vec2 &a = flat_[before(i)], &b = flat_[left_[i]], &c = flat_[after(i)];
    for (const std::uint32_t candidate : candidates) {
      const Vec2& p = flat_[candidate];
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  std::size_t find_flat_corner() const {
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (turn_at(i) == 0.0) return i;
    }
    return left_.size();
  }

  std::vector<Vec2> flat_;
  std::vector<std::uint32_t> left_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(const std::vector<core::Vec3>& corners,
                                                              bool& simple) {
  if (corners.size() < 3) return {};
  return EarClipper(corners).clip(simple);
}

}  // namespace scintray::mesh
