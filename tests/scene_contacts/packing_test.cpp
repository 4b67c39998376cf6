#include <doctest/doctest.h>

#include <algorithm>

#include "scintray/core/rng.hpp"
#include "shapes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::contact;
using namespace scintray::test;

namespace {

struct Cuboid {
  Vec3 low, high;
};

/// Cuts a cuboid into `count` by splitting, each time, a random one at a random place.
std::vector<Cuboid> cut(const Cuboid& whole, int count, Rng& rng) {
  std::vector<Cuboid> pieces{whole};
  while (static_cast<int>(pieces.size()) < count) {
    const auto which = static_cast<std::size_t>(rng.uniform() * static_cast<double>(pieces.size()));
    int axis = 0;
    (pieces[which].high - pieces[which].low).maxCoeff(&axis);
    const double at = pieces[which].low[axis] +
                      (pieces[which].high[axis] - pieces[which].low[axis]) * (0.3 + 0.4 * rng.uniform());
    Cuboid upper = pieces[which];
    upper.low[axis] = at;
    pieces[which].high[axis] = at;
    pieces.push_back(upper);
  }
  return pieces;
}

/// Area of contact of two cuboids.
double area_of_contact(const Cuboid& a, const Cuboid& b) {
  const Vec3 common = a.high.cwiseMin(b.high) - a.low.cwiseMax(b.low);
  for (int axis = 0; axis < 3; ++axis)
    if (a.high[axis] == b.low[axis] || b.high[axis] == a.low[axis]) {
      const double u = common[(axis + 1) % 3], v = common[(axis + 2) % 3];
      return u > 0.0 && v > 0.0 ? u * v : 0.0;
    }
  return 0.0;
}

}  // namespace

TEST_CASE("In random packings of a cube every contact has its exact area") {
  for (std::uint64_t trial = 0; trial < 24; ++trial) {
    CAPTURE(trial);
    Rng rng(20260, StreamKind::photon, trial, 0);
    const Cuboid cube{Vec3::Zero(), Vec3::Constant(10.0)};
    const auto pieces = cut(cube, 5 + static_cast<int>(trial), rng);
    std::vector<PlacedPart> parts;
    std::vector<double> volumes;
    for (const Cuboid& piece : pieces) {
      const int cuts = 1 + static_cast<int>(4.0 * rng.uniform());
      parts.push_back(box("piece" + std::to_string(parts.size()), piece.low, piece.high,
                          static_cast<std::uint32_t>(6 * parts.size()), cuts, rng.uniform() < 0.5));
      volumes.push_back((piece.high - piece.low).prod());
    }
    const bool in_a_case = trial % 3 == 0;
    if (in_a_case) {
      parts.push_back(box("case", cube.low - Vec3(1, 0, 2), cube.high + Vec3(0, 1, 0), 100000, 2));
      volumes.push_back(11.0 * 11.0 * 12.0 - 1000.0);
    }
    if (trial % 2 == 1) {
      const Vec3 axis(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
      move(parts, Eigen::AngleAxisd(kTwoPi * rng.uniform(), axis.normalized()).toRotationMatrix(),
           Vec3(10.0 * rng.uniform(), -7.0, 3.0));
    }
    const auto interfaces = resolve_contacts(parts, 1e-4);
    check_laws(parts, interfaces, volumes);
    double worst = 0.0, total = 0.0, expected_total = 0.0;
    for (std::size_t i = 0; i < pieces.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double expected = area_of_contact(pieces[i], pieces[j]);
        const double found = area_between(interfaces, PartId(i), PartId(j));
        worst = std::max(worst, std::abs(found - expected));
        expected_total += expected;
      }
    for (const InterfaceTriangle& t : interfaces) total += area(t);
    CHECK(worst < 1e-10);
    // The case is flush with three faces of the cube (+x, -y, +z), which are then part of its outside.
    const double outside = in_a_case ? 2.0 * (11 * 11 + 11 * 12 + 11 * 12) + 3.0 * 100.0 : 600.0;
    CHECK(total == doctest::Approx(expected_total + outside).epsilon(1e-12));
  }
}
