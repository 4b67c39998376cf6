#include <algorithm>
#include <string>
#include <vector>

#include "ray_comparison.hpp"
#include "scintray/mesh/shapes/polygon.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "workload.hpp"

namespace scintray::bench {

namespace {

/// Sizes of the bodies made in code, mm.
constexpr double kLength = 20.0, kDepth = 5.0, kBack = 4.0, kTooth = 6.0, kRadius = 5.0;

std::shared_ptr<const scene::Accelerator> by_embree(const std::vector<scene::BoundaryTriangle>& triangles) {
  const std::vector<std::uint32_t> labels(triangles.size(), 0);
  return std::make_shared<scene::Accelerator>(triangles, labels, true, scene_file::AcceleratorKind::embree);
}

/// Outline of a comb in the plane z = 0, counter-clockwise.
std::vector<core::Vec3> comb_outline(int teeth) {
  std::vector<core::Vec3> outline{{0.0, 0.0, 0.0}, {kLength, 0.0, 0.0}};
  const double step = kLength / (2 * teeth - 1);
  for (int tooth = teeth - 1; tooth >= 0; --tooth) {
    const double left = 2 * tooth * step;
    if (tooth < teeth - 1) outline.emplace_back(left + step, kBack, 0.0);
    outline.emplace_back(tooth == teeth - 1 ? kLength : left + step, kBack + kTooth, 0.0);
    outline.emplace_back(left, kBack + kTooth, 0.0);
    if (tooth > 0) outline.emplace_back(left, kBack, 0.0);
  }
  return outline;
}

/// Regions of a benchmark scene, by name.
void add_regions_of(const std::string& name, const std::vector<std::string>& regions,
                    std::vector<RayRegion>& all) {
  const Workload workload(scene_named(name));
  const scene::Scene& scene = workload.point().scene();
  for (const core::RegionId id : scene.regions.ids())
    if (std::find(regions.begin(), regions.end(), scene.region_names[id]) != regions.end())
      all.push_back(
          {name + ": " + scene.region_names[id], scene.accelerators[scene.regions[id].accelerator]});
}

}  // namespace

RayRegion comb(int teeth) {
  const std::vector<core::Vec3> outline = comb_outline(teeth);
  const core::Vec3 up(0.0, 0.0, kDepth), middle(kLength / 2, (kBack + kTooth) / 2, kDepth / 2);
  bool simple = true;
  std::vector<scene::BoundaryTriangle> triangles;
  for (const auto& corners : mesh::triangulate_polygon(outline, simple)) {
    const core::Vec3 &a = outline[corners[0]], &b = outline[corners[1]], &c = outline[corners[2]];
    triangles.push_back({a, c, b});
    triangles.push_back({a + up, b + up, c + up});
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const core::Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    triangles.push_back({a, b, b + up});
    triangles.push_back({a, b + up, a + up});
  }
  for (scene::BoundaryTriangle& triangle : triangles)
    for (core::Vec3& corner : triangle) corner -= middle;
  return {"comb of " + std::to_string(teeth), by_embree(triangles)};
}

RayRegion ball(int subdivisions) {
  const mesh::TriMesh mesh = mesh::make_sphere(kRadius, subdivisions);
  std::vector<scene::BoundaryTriangle> triangles;
  for (const auto& corners : mesh.triangles)
    triangles.push_back({mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]});
  return {"ball of " + std::to_string(subdivisions), by_embree(triangles)};
}

std::vector<RayRegion> ray_regions() {
  std::vector<RayRegion> regions;
  for (const int teeth : {1, 2, 3, 4, 6, 8, 13, 25, 50}) regions.push_back(comb(teeth));
  for (const int subdivisions : {1, 2, 3, 4, 6}) regions.push_back(ball(subdivisions));
  add_regions_of("polished", {"ambient"}, regions);
  add_regions_of("tape", {"ambient"}, regions);
  add_regions_of("block", {"sipm_fill", "crystal_septum_y[0]", "ambient", "guide_fill", "crystal_filler"},
                 regions);
  add_regions_of("polished_3072", {"crystal"}, regions);
  add_regions_of("array_40_bare", {"ambient"}, regions);
  return regions;
}

}  // namespace scintray::bench
