#include "scintray/mesh/detail/surface_refinement.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace scintray;
using namespace scintray::mesh;

namespace {

/// A cone's mantle about z, from its tip at the parameters (any, 0), by azimuth and height.
core::Vec3 cone(const Eigen::Vector2d& at) {
  return {at.y() * std::cos(at.x()), at.y() * std::sin(at.x()), at.y()};
}

SurfacePatch patch_of(const std::vector<Eigen::Vector2d>& parameters,
                      const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  SurfacePatch patch;
  patch.parameters = parameters;
  for (const Eigen::Vector2d& at : parameters) patch.vertices.push_back(cone(at));
  patch.triangles = triangles;
  return patch;
}

}  // namespace

TEST_CASE("A patch is refined inside until it keeps the deviation, and its border stays") {
  // Both long sides are rulings of the cone, straight; the diagonal is far from the surface.
  SurfacePatch patch = patch_of({{0.0, 1.0}, {0.05, 1.0}, {0.05, 40.0}, {0.0, 40.0}}, {{0, 1, 2}, {0, 2, 3}});
  SurfacePatch coarse = patch;
  const double before = refine(coarse, cone, 1.0);
  CHECK(coarse.triangles.size() == 2);
  CHECK(before > 2.0 * 40.0 * (1.0 - std::cos(0.025)));
  const double border = 40.0 * (1.0 - std::cos(0.025));  // the chord of the wide end, which is not halved
  const double after = refine(patch, cone, 1.5 * border);
  CHECK(after <= 1.5 * border);
  CHECK(patch.triangles.size() > 2);
  for (std::size_t v = 4; v < patch.vertices.size(); ++v) {
    CHECK(patch.parameters[v].x() > 0.0);
    CHECK(patch.parameters[v].x() < 0.05);
  }
}

TEST_CASE("A patch is refined straight towards a pole, whatever the azimuth stated there") {
  SurfacePatch patch = patch_of({{2.0, 0.0}, {0.0, 3.0}, {0.2, 3.0}, {0.4, 3.0}}, {{0, 1, 2}, {0, 2, 3}});
  CHECK(refine(patch, cone, 0.05) <= 0.05);
  CHECK(patch.triangles.size() == 2);  // rulings are straight; the chords of 0.2 are within 0.015 mm
}
