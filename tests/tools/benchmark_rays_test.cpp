// Ways to find where a ray leaves a region: all find the same.

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "ray_comparison.hpp"

using namespace scintray;
using namespace scintray::bench;

namespace {

constexpr std::size_t kRays = 2048;
constexpr std::size_t kAnyNumber = 1'000'000;

}  // namespace

TEST_CASE("Combs are closed, of 16 teeth - 4 triangles, and have the volume of their teeth and back") {
  for (const int teeth : {1, 2, 5}) {
    CAPTURE(teeth);
    const RayRegion region = comb(teeth);
    const scene::Accelerator& accelerator = *region.accelerator;
    CHECK(accelerator.size() == 16 * static_cast<std::size_t>(teeth) - 4);
    double volume = 0.0;
    for (std::uint32_t i = 0; i < accelerator.size(); ++i) {
      const scene::BoundaryTriangle t = accelerator.triangle(i);
      volume += t[0].dot(t[1].cross(t[2])) / 6.0;
    }
    CHECK(volume == doctest::Approx(5.0 * 20.0 * (4.0 + 6.0 * teeth / (2 * teeth - 1))));
  }
}

TEST_CASE("Rays of isotropic light start on or in their region, and all leave it") {
  const RayRegion region = comb(3);
  const RaySet rays = isotropic_rays(*region.accelerator, kRays);
  REQUIRE(rays.size() == kRays);
  core::Vec3 sum = core::Vec3::Zero();
  for (std::size_t i = 0; i < kRays; ++i) {
    CHECK(rays.direction(i).norm() == doctest::Approx(1.0));
    const scene::Exit exit = region.accelerator->find_exit(rays.origin(i), rays.direction(i));
    CHECK(exit.triangle != scene::kNoTriangle);
    CHECK(region.accelerator->contains(rays.origin(i) + 0.5 * exit.distance_mm * rays.direction(i)));
    sum += rays.direction(i);
  }
  // Each component has a variance of about 1/3: six standard deviations.
  CHECK(sum.cwiseAbs().maxCoeff() < 6.0 * std::sqrt(kRays / 3.0));
}

TEST_CASE("Single rays, packets and all triangles in lanes end where the tracer's rays do") {
  for (const RayRegion& region : {comb(1), comb(2), comb(8), ball(1), ball(3)}) {
    CAPTURE(region.name);
    const RaySet rays = isotropic_rays(*region.accelerator, kRays);
    const std::vector<RayWay> ways = ray_ways(region, kAnyNumber);
    CHECK(ways.size() >= 2);
    RayHits tracer(kRays);
    ways.front().trace(rays, tracer);
    for (const RayWay& way : ways) {
      CAPTURE(way.name);
      RayHits hits(kRays);
      way.trace(rays, hits);
      // In single precision a ray that starts within a micrometre of an edge may take the other side.
      CHECK(rays_elsewhere(*region.accelerator, tracer, hits) <= 1);
      const auto same =
          std::inner_product(hits.triangle.begin(), hits.triangle.end(), tracer.triangle.begin(),
                             std::size_t{0}, std::plus<>(), std::equal_to<>());
      CHECK(same >= kRays - 2);
    }
  }
}

TEST_CASE("Rays elsewhere are those of another triangle and another distance") {
  const RayRegion region = comb(1);
  RayHits tracer(3);
  tracer.triangle = {1, 2, 3};
  tracer.distance_mm = {1.0f, 2.0f, 3.0f};
  RayHits other = tracer;
  CHECK(rays_elsewhere(*region.accelerator, tracer, other) == 0);
  other.triangle = {1, 3, 4};
  CHECK(rays_elsewhere(*region.accelerator, tracer, other) == 0);  // at a common edge
  other.distance_mm[1] = 2.1f;
  CHECK(rays_elsewhere(*region.accelerator, tracer, other) == 1);
  other.triangle[0] = scene::kNoTriangle;
  CHECK(rays_elsewhere(*region.accelerator, tracer, other) == 2);
}

TEST_CASE("Rays are compared in rounds, with Embree's single rays as 1") {
  const RayRegionFigures figures = compare_rays(comb(2), 0.01, 3);
  CHECK(figures.triangles == 28);
  REQUIRE(figures.ways.size() >= 2);
  CHECK(figures.ways[0].way == "tracer");
  CHECK(figures.ways[1].of_single.median == 1.0);
  for (const RayFigures& way : figures.ways) {
    CHECK(way.ns.values.size() == 3);
    CHECK(way.ns.low > 0.0);
    CHECK(way.elsewhere == 0);
  }
  const std::string text = text_of_rays({figures});
  CHECK(text.find("comb of 2") != std::string::npos);
  CHECK(text.find("tracer") != std::string::npos);
}
