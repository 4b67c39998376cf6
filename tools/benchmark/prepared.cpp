#include "prepared.hpp"

#include "scintray/scene_file/read_scene.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::bench {

Prepared prepare(const std::string& scene_text, scene::SceneBuilder& builder) {
  return std::make_shared<const simulation::SimulationPoint>(
      scene_file::SceneFile::from_text(scene_text, "bench.toml").spec(0), builder);
}

Speed measure(const Prepared& prepared, int threads) {
  scene_file::SceneSpec spec = prepared->spec();
  spec.run.threads = threads;
  const tally::PointResult r = simulation::SimulationPoint(std::move(spec), prepared->built()).trace();
  return {static_cast<double>(r.segments) / r.wall_seconds, static_cast<double>(r.photons) / r.wall_seconds};
}

std::vector<RawRay> record_rays(const Prepared& prepared, std::size_t count) {
  const scene::Scene& scene = prepared->scene();
  const source::LightSource& source = prepared->source();
  std::vector<RawRay> rays;
  const core::RegionId crystal = source.regions().front();
  const scene::Region& region = scene.regions[crystal];
  for (std::uint64_t i = 0; rays.size() < count; ++i) {
    core::Rng rng(9, core::StreamKind::photon, i);
    source::Photon photon = source.emit(scene, {}, i, rng);
    for (transport::Step taken{core::StepEvent::reflected};
         !core::is_final(taken.event) && rays.size() < count;) {
      if (photon.region == crystal) {
        const core::Vec3 o = region.point_to_local(photon.position), d = photon.ray.direction;
        rays.push_back({{static_cast<float>(o.x()), static_cast<float>(o.y()), static_cast<float>(o.z())},
                        {static_cast<float>(d.x()), static_cast<float>(d.y()), static_cast<float>(d.z())}});
      }
      taken = transport::step(scene, photon, rng);
      if (photon.interactions > 1000) break;
    }
  }
  return rays;
}

std::vector<scene::BoundaryTriangle> triangles_of(const mesh::TriMesh& mesh) {
  std::vector<scene::BoundaryTriangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  return triangles;
}

}  // namespace scintray::bench
