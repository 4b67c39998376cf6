#pragma once
/// Ways to find where a ray leaves a region, compared on incoherent rays.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ray_set.hpp"
#include "spread.hpp"

namespace scintray::bench {

/// A region whose rays are compared. Its accelerator queries Embree.
struct RayRegion {
  std::string name;
  std::shared_ptr<const scene::Accelerator> accelerator;
};

/// Regions of the benchmark's scenes, and combs and balls of 12 to 1000 triangles made in code.
std::vector<RayRegion> ray_regions();
/// A comb: a block with equal notches, not convex beyond one tooth, of 16 teeth - 4 triangles.
RayRegion comb(int teeth);
/// A geodesic ball of 20 subdivisions^2 triangles.
RayRegion ball(int subdivisions);

/// A way to trace all rays of a set.
struct RayWay {
  std::string name;
  std::function<void(const RaySet&, RayHits&)> trace;
};

/// All ways of this build and processor on a region: that of the tracer first, then Embree's single rays.
/// @param most_in_lanes  triangles of a region up to which all of them are tested in lanes
std::vector<RayWay> ray_ways(const RayRegion& region, std::size_t most_in_lanes);

/// Number of rays that end elsewhere than those of the tracer: at another triangle and at another distance,
/// so that an edge that both share does not count.
std::size_t rays_elsewhere(const scene::Accelerator& region, const RayHits& tracer, const RayHits& other);

/// A way on a region.
struct RayFigures {
  std::string way;
  Spread ns;                  ///< of processor time a ray
  Spread of_single;           ///< Embree's single rays take this many times as long, in the same round
  std::size_t elsewhere = 0;  ///< rays that end elsewhere than the tracer's
};

struct RayRegionFigures {
  std::string region;
  std::size_t triangles = 0, rays = 0;
  std::vector<RayFigures> ways;
};

/// Compares all ways on a region: one thread, in every round each has its turn, in an order that alternates.
/// @param seconds  of processor time, about
RayRegionFigures compare_rays(const RayRegion& region, double seconds, int rounds);

/// ns a ray of each way by region, and what that is to Embree's single rays.
std::string text_of_rays(const std::vector<RayRegionFigures>& regions);

}  // namespace scintray::bench
