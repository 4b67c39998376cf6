#include "prepared.hpp"

#include "scintray/source/photon_source.hpp"
#include "scintray/trace/run.hpp"
#include "scintray/trace/step.hpp"

namespace scintray::bench {

Prepared prepare(const std::string& scene_text, SceneBuilder& builder) {
  Prepared p;
  p.spec = SceneFile::from_text(scene_text, "bench.toml").spec(0);
  p.built = builder.build(p.spec);
  return p;
}

Speed measure(const Prepared& p, int threads) {
  const PhotonSource source(p.spec.source, p.built.scene);
  const TallyPlan plan(p.built.scene, p.spec);
  RunSettings settings;
  settings.threads = threads;
  settings.max_interactions = p.spec.run.max_interactions;
  const PointResult r = run_point(p.built.scene, source, plan, settings);
  return {static_cast<double>(r.segments) / r.wall_seconds, static_cast<double>(r.photons) / r.wall_seconds};
}

std::vector<RawRay> record_rays(const Prepared& p, std::size_t count) {
  const PhotonSource source(p.spec.source, p.built.scene);
  std::vector<RawRay> rays;
  const std::uint32_t crystal = source.regions().front();
  const Region& region = p.built.scene.regions[crystal];
  for (std::uint64_t i = 0; rays.size() < count; ++i) {
    Rng rng(9, StreamKind::photon, i);
    Photon photon = source.emit(p.built.scene, rng);
    for (Step taken{StepEvent::reflected}; !is_final(taken.event) && rays.size() < count;) {
      if (photon.region == crystal) {
        const Vec3 o = region.point_to_local(photon.position), d = photon.ray.direction;
        rays.push_back({{static_cast<float>(o.x()), static_cast<float>(o.y()), static_cast<float>(o.z())},
                        {static_cast<float>(d.x()), static_cast<float>(d.y()), static_cast<float>(d.z())}});
      }
      taken = step(p.built.scene, photon, rng);
      if (photon.interactions > 1000) break;
    }
  }
  return rays;
}

std::vector<BoundaryTriangle> triangles_of(const TriMesh& mesh) {
  std::vector<BoundaryTriangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  return triangles;
}

}  // namespace scintray::bench
