#include "scintray/contact/detail/nesting.hpp"

#include <algorithm>

namespace scintray::contact {

namespace {

using Tetrahedron = std::array<core::Vec3, 4>;

double signed_volume(const Tetrahedron& t) { return (t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0]) / 6.0; }

/// The tetrahedra of the prism between the triangles a and b.
void add_prism(const std::array<core::Vec3, 3>& a, const std::array<core::Vec3, 3>& b,
               std::vector<Tetrahedron>& out) {
  out.push_back({a[0], a[1], a[2], b[0]});
  out.push_back({a[1], a[2], b[0], b[1]});
  out.push_back({a[2], b[0], b[1], b[2]});
}

/// Adds what of `t` lies where normal . (p - origin) <= 0.
void clip(const Tetrahedron& t, const core::Vec3& origin, const core::Vec3& normal,
          std::vector<Tetrahedron>& out) {
  std::array<double, 4> height{};
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  for (std::size_t k = 0; k < 4; ++k) height[k] = normal.dot(t[k] - origin);
  std::sort(order.begin(), order.end(), [&](auto i, auto j) { return height[i] < height[j]; });
  const auto below = std::count_if(height.begin(), height.end(), [](double h) { return h <= 0.0; });
  const auto v = [&](std::size_t i) { return t[order[i]]; };
  const auto cut = [&](std::size_t i, std::size_t j) -> core::Vec3 {
    const double hi = height[order[i]], hj = height[order[j]];
    return v(i) + hi / (hi - hj) * (v(j) - v(i));
  };
  switch (below) {
    case 0:
      break;
    case 1:
      out.push_back({v(0), cut(0, 1), cut(0, 2), cut(0, 3)});
      break;
    case 2:
      add_prism({v(0), cut(0, 2), cut(0, 3)}, {v(1), cut(1, 2), cut(1, 3)}, out);
      break;
    case 3:
      add_prism({v(0), v(1), v(2)}, {cut(0, 3), cut(1, 3), cut(2, 3)}, out);
      break;
    default:
      out.push_back(t);
      break;
  }
}

/// Tetrahedra that together are the common part of two.
std::vector<Tetrahedron> common_part(const Tetrahedron& a, const Tetrahedron& b) {
  std::vector<Tetrahedron> pieces{a}, next;
  for (std::size_t k = 0; k < 4 && !pieces.empty(); ++k) {
    const core::Vec3 &p = b[(k + 1) % 4], &q = b[(k + 2) % 4], &r = b[(k + 3) % 4];
    core::Vec3 normal = (q - p).cross(r - p);
    if (normal.dot(b[k] - p) > 0.0) normal = -normal;
    next.clear();
    for (const Tetrahedron& piece : pieces) clip(piece, p, normal, next);
    std::swap(pieces, next);
  }
  return pieces;
}

Box bounds(const Tetrahedron& t) {
  Box box;
  for (const core::Vec3& v : t) box.add(v);
  return box;
}

struct Cone {
  Tetrahedron tetrahedron;
  Box box;
  double sign;
};

/// The cones from one point to all triangles; with their signs they count 1 inside the body and 0
/// outside (but for points on their faces).
std::vector<Cone> cones(const Body& body) {
  const core::Vec3 apex = 0.5 * (body.box.low + body.box.high);
  std::vector<Cone> result;
  for (std::uint32_t t = 0; t < body.triangles.size(); ++t) {
    const Tetrahedron tetrahedron{apex, body.corner(t, 0), body.corner(t, 1), body.corner(t, 2)};
    const double volume = signed_volume(tetrahedron);
    if (volume != 0.0) result.push_back({tetrahedron, bounds(tetrahedron), volume > 0.0 ? 1.0 : -1.0});
  }
  return result;
}

bool inside_both(const core::Vec3& point, const Body& a, const Body& b) {
  return a.side_of(point, 0.0) == Side::inside && b.side_of(point, 0.0) == Side::inside;
}

core::Vec3 middle(const Body& a, const Body& b) {
  return 0.5 * (a.box.low.cwiseMax(b.box.low) + a.box.high.cwiseMin(b.box.high));
}

/// Sums the common parts of all pairs of cones, each with the product of their signs.
OverlapVolume exact_overlap(const Body& a, const Body& b) {
  OverlapVolume result{0.0, middle(a, b), true};
  double largest = 0.0;
  const auto cones_b = cones(b);
  for (const Cone& cone_a : cones(a))
    for (const Cone& cone_b : cones_b) {
      if (!cone_a.box.overlaps(cone_b.box)) continue;
      for (const Tetrahedron& piece : common_part(cone_a.tetrahedron, cone_b.tetrahedron)) {
        const double volume = std::abs(signed_volume(piece));
        result.volume_mm3 += cone_a.sign * cone_b.sign * volume;
        const core::Vec3 center = 0.25 * (piece[0] + piece[1] + piece[2] + piece[3]);
        if (volume <= largest || !inside_both(center, a, b)) continue;
        largest = volume;
        result.inside = center;
      }
    }
  return result;
}

OverlapVolume grid_overlap(const Body& a, const Body& b) {
  constexpr int kPerSide = 32;
  static_assert(kPerSide * kPerSide * kPerSide == kOverlapGridPoints);
  const core::Vec3 low = a.box.low.cwiseMax(b.box.low);
  const core::Vec3 size = a.box.high.cwiseMin(b.box.high) - low;
  OverlapVolume result{0.0, middle(a, b), false};
  int count = 0;
  for (int i = 0; i < kPerSide; ++i)
    for (int j = 0; j < kPerSide; ++j)
      for (int k = 0; k < kPerSide; ++k) {
        const core::Vec3 p =
            low + core::Vec3((i + 0.5) * size.x(), (j + 0.5) * size.y(), (k + 0.5) * size.z()) / kPerSide;
        if (inside_both(p, a, b) && count++ == 0) result.inside = p;
      }
  result.volume_mm3 = size.prod() * count / kOverlapGridPoints;
  return result;
}

}  // namespace

OverlapVolume overlap_volume(const PlacedPart& a, const PlacedPart& b) {
  constexpr std::size_t kMostPairs = 200'000;
  const Body body_a(a, Eigen::Matrix3d::Identity()), body_b(b, Eigen::Matrix3d::Identity());
  const bool small = body_a.triangles.size() * body_b.triangles.size() <= kMostPairs;
  return small ? exact_overlap(body_a, body_b) : grid_overlap(body_a, body_b);
}

}  // namespace scintray::contact
