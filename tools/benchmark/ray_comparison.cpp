#include "ray_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "all_triangles.hpp"
#include "clock.hpp"
#include "embree_rays.hpp"

namespace scintray::bench {

namespace {

/// Rays of a region: too many for a processor to predict their branches, few enough for its second cache.
constexpr std::size_t kRays = 8192;
/// Triangles of a region above which testing all of them takes a hundred times as long as Embree.
constexpr std::size_t kMostInLanes = 4096;
/// Position of Embree's single rays among the ways.
constexpr std::size_t kSingle = 1;
/// Difference of distances, relative to the region's size, that single precision explains.
constexpr double kSameDistance = 1e-5;

void trace_as_tracer(const scene::Accelerator& region, const RaySet& rays, RayHits& hits) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const scene::Exit exit = region.find_exit(rays.origin(i), rays.direction(i));
    hits.triangle[i] = exit.triangle;
    hits.distance_mm[i] = static_cast<float>(exit.distance_mm);
  }
}

void add_embree(const scene::Accelerator& region, const char* max_isa, std::vector<RayWay>& ways) {
  const auto embree = std::make_shared<const EmbreeRays>(region, max_isa);
  const std::string of = std::string(" ") + max_isa;
  ways.push_back(
      {"1" + of, [embree](const RaySet& rays, RayHits& hits) { embree->trace_single(rays, hits); }});
  for (const int size : {4, 8, 16})
    if (embree->has_packets(size))
      ways.push_back({fmt::format("{}", size) + of, [embree, size](const RaySet& rays, RayHits& hits) {
                        embree->trace_packets(size, rays, hits);
                      }});
}

/// Nanoseconds a ray of as many passes as take this time.
double ns_per_ray(const RayWay& way, const RaySet& rays, RayHits& hits, double seconds) {
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  double elapsed = 0.0;
  std::size_t passes = 0;
  do {
    way.trace(rays, hits);
    ++passes;
    elapsed = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
  } while (elapsed < seconds);
  return 1e9 * elapsed / static_cast<double>(passes * rays.size());
}

std::vector<std::string> names_of(const std::vector<RayRegionFigures>& regions) {
  std::vector<std::string> names;
  for (const RayRegionFigures& region : regions)
    for (const RayFigures& way : region.ways)
      if (std::find(names.begin(), names.end(), way.way) == names.end()) names.push_back(way.way);
  return names;
}

/// A table of one figure by region and way.
std::string table_of(const std::vector<RayRegionFigures>& regions, const std::string& title,
                     const std::function<std::string(const RayFigures&)>& figure) {
  const std::vector<std::string> names = names_of(regions);
  std::string text = fmt::format("{:<34}  {:>9}", title, "triangles");
  const auto width = [](const std::string& name) { return std::max<std::size_t>(name.size(), 6); };
  for (const std::string& name : names) text += fmt::format("  {:>{}}", name, width(name));
  for (const RayRegionFigures& region : regions) {
    text += fmt::format("\n{:<34}  {:>9}", region.region, region.triangles);
    for (const std::string& name : names) {
      const auto way = std::find_if(region.ways.begin(), region.ways.end(),
                                    [&](const RayFigures& one) { return one.way == name; });
      text += fmt::format("  {:>{}}", way == region.ways.end() ? "-" : figure(*way), width(name));
    }
  }
  return text + "\n";
}

}  // namespace

std::vector<RayWay> ray_ways(const RayRegion& region, std::size_t most_in_lanes) {
  const std::shared_ptr<const scene::Accelerator> tracer = region.accelerator;
  std::vector<RayWay> ways{
      {"tracer", [tracer](const RaySet& rays, RayHits& hits) { trace_as_tracer(*tracer, rays, hits); }}};
  add_embree(*tracer, "avx2", ways);
  add_embree(*tracer, "avx512", ways);
  if (tracer->size() > most_in_lanes) return ways;
  for (const LaneWays& lanes : lane_ways()) {
    const auto all = std::make_shared<const AllTriangles>(*tracer, lanes);
    ways.push_back({"T " + lanes.numbers, [all](const RaySet& rays, RayHits& hits) {
                      all->trace(LanesOf::triangles, rays, hits);
                    }});
    ways.push_back({"R " + lanes.numbers,
                    [all](const RaySet& rays, RayHits& hits) { all->trace(LanesOf::rays, rays, hits); }});
  }
  return ways;
}

std::size_t rays_elsewhere(const scene::Accelerator& region, const RayHits& tracer, const RayHits& other) {
  const double same_mm = kSameDistance * region.boundary().size_mm;
  std::size_t elsewhere = 0;
  for (std::size_t i = 0; i < tracer.triangle.size(); ++i) {
    if (tracer.triangle[i] == other.triangle[i]) continue;
    const bool both = tracer.triangle[i] != scene::kNoTriangle && other.triangle[i] != scene::kNoTriangle;
    const double apart_mm = std::abs(double{tracer.distance_mm[i]} - double{other.distance_mm[i]});
    if (!both || apart_mm > same_mm) ++elsewhere;
  }
  return elsewhere;
}

RayRegionFigures compare_rays(const RayRegion& region, double seconds, int rounds) {
  const std::vector<RayWay> ways = ray_ways(region, kMostInLanes);
  const RaySet rays = isotropic_rays(*region.accelerator, kRays);
  const double turn_s = seconds / (rounds * static_cast<double>(ways.size()));
  RayRegionFigures figures{region.name, region.accelerator->size(), rays.size(), {}};
  std::vector<RayHits> hits(ways.size(), RayHits(rays.size()));
  std::vector<std::vector<double>> ns(ways.size());
  for (std::size_t i = 0; i < ways.size(); ++i) ways[i].trace(rays, hits[i]);  // warms up
  for (int round = 0; round < rounds; ++round)
    for (std::size_t turn = 0; turn < ways.size(); ++turn) {
      const std::size_t i = round % 2 == 0 ? turn : ways.size() - 1 - turn;
      ns[i].push_back(ns_per_ray(ways[i], rays, hits[i], turn_s));
    }
  for (std::size_t i = 0; i < ways.size(); ++i)
    figures.ways.push_back({ways[i].name, spread_of(ns[i]), paired_ratio(ns[kSingle], ns[i]),
                            rays_elsewhere(*region.accelerator, hits.front(), hits[i])});
  return figures;
}

std::string text_of_rays(const std::vector<RayRegionFigures>& regions) {
  const std::string ns = table_of(regions, "ns a ray", [](const RayFigures& way) {
    return fmt::format("{:.{}f}", way.ns.median, way.ns.median < 100.0 ? 1 : 0);
  });
  const std::string ratios = table_of(regions, "single rays take times as long", [](const RayFigures& way) {
    return fmt::format("{:.2f}", way.of_single.median);
  });
  const std::string elsewhere = table_of(regions, "rays that end elsewhere", [](const RayFigures& way) {
    return fmt::format("{}", way.elsewhere);
  });
  return ns + "\n" + ratios + "\n" + elsewhere +
         "\ntracer: its own query. 1, 4, 8, 16 with an instruction set: Embree's single rays and packets. T, "
         "R: all "
         "triangles of the region,\nas many triangles or rays at once as there are lanes.\n";
}

}  // namespace scintray::bench
