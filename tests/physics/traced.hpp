#pragma once
/// Running small scenes written inside a test.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "physics/lane_widths.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_point.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"
#include "support/laws.hpp"
#include "support/shared.hpp"

namespace scintray::test {

/// Media, surfaces and sensors that the scenes of the tests share: indices without dispersion.
inline const std::string kDatabase = R"(
[media.vacuum_n1]
index = { n = 1.0 }
absorption = { none = true }
scattering = { none = true }
[media.lso]
index = { n = 1.82 }
absorption = { length = "300 mm" }
scattering = { length = "256 mm", kind = "rayleigh" }
[media.lso_isotropic]
index = { n = 1.82 }
absorption = { length = "300 mm" }
scattering = { length = "256 mm", kind = "isotropic" }
[media.lso_absorbing]
index = { n = 1.82 }
absorption = { length = "30 mm" }
scattering = { none = true }
[media.lso_clear]
index = { n = 1.82 }
absorption = { none = true }
scattering = { none = true }
[media.n15]
index = { n = 1.5 }
absorption = { none = true }
scattering = { none = true }
[media.cloudy_n1]
index = { n = 1.0 }
absorption = { none = true }
scattering = { length = "3 mm", kind = "isotropic" }
[sensors.perfect]
efficiency = { definition = "internal", value = 1.0 }
window = { index = 1.5 }
[sensors.perfect_n1]
efficiency = { definition = "internal", value = 1.0 }
window = { index = 1.0 }
[surfaces.flat]
model = "smooth"
[surfaces.white]
model = "painted"
reflectance = 1.0
specular_share = 0.0
)";

struct Traced {
  std::shared_ptr<const simulation::SimulationPoint> point;
  const scene::BuiltScene& built = *point->built();
  tally::PointResult result;
  std::vector<tally::EventRecord> events;  ///< of a source of energy
};

/// Scene text plus the definitions above, with `photons` from `[source]`.
inline scene_file::SceneSpec scene_spec(const std::string& text, const scene_file::TallyVariables& variables =
                                                                     scene_file::TallyVariables::built_in()) {
  return scene_file::SceneFile::from_text(text + kDatabase, source_file("test.toml").string(),
                                          {.variables = variables})
      .spec(0);
}

/// Surface tables are made by this build, once for all tests of a run, and not taken from the user's cache.
inline materials::SurfaceFactory::Hooks tables_of_this_build() {
  materials::SurfaceFactory::Hooks hooks;
  hooks.cache = tables_of_this_run();
  hooks.cache_bytes = materials::kDefaultCacheBytes;
  return hooks;
}

/// A scene ready to be traced, with surface tables of this build.
inline std::shared_ptr<const simulation::SimulationPoint> ready(scene_file::SceneSpec spec) {
  scene::SceneBuilder builder(tables_of_this_build());
  return std::make_shared<const simulation::SimulationPoint>(std::move(spec), builder);
}

/// The result of a scene. Its first photons are also traced by every width of the lanes, and compared.
inline Traced trace(const std::string& text, int threads = 0,
                    const scene_file::TallyVariables& variables = scene_file::TallyVariables::built_in()) {
  scene_file::SceneSpec spec = scene_spec(text, variables);
  if (threads > 0) spec.run.threads = threads;
  Traced traced{.point = ready(std::move(spec)), .result = {}, .events = {}};
  simulation::RunHooks hooks;
  hooks.events = [&](const std::vector<tally::EventRecord>& events) {
    traced.events.insert(traced.events.end(), events.begin(), events.end());
  };
  traced.result = traced.point->trace(hooks);
  CHECK(traced.result.lost == 0);
  CHECK(traced.result.complete);
  check_same_in_all_widths(*traced.point);
  return traced;
}

/// All photons of a scene that sensors detect, traced with a width of the lanes.
/// @param builder  of the surface tables, which are made once for all widths
inline TracedPhotons trace_with(scene_file::SceneSpec spec, int lane_width, scene::SceneBuilder& builder) {
  spec.run.lane_width = lane_width;
  spec.run.photon_list = true;
  TracedPhotons traced;
  simulation::RunHooks hooks;
  hooks.detected = [&](const std::vector<tally::DetectedPhoton>& photons) {
    traced.list.insert(traced.list.end(), photons.begin(), photons.end());
  };
  traced.result = simulation::SimulationPoint(std::move(spec), builder).trace(hooks);
  return traced;
}

inline TracedPhotons trace_with(const std::string& scene, int lane_width) {
  scene::SceneBuilder builder(tables_of_this_build());
  return trace_with(scene_spec(scene), lane_width, builder);
}

/// Area of the triangles of a face ("part:face"), mm2.
inline double face_area(const scene::Scene& scene, const std::string& name) {
  double area = 0.0;
  for (const scene::FaceInfo& face : scene.faces)
    if (face.name == name) area += face.area_mm2;
  return area;
}

/// Checks a fraction against an exact value.
inline void check_fraction(const tally::PointResult& result, core::Fate fate, double expected) {
  check_law(std::string(core::fate_name(fate)), result.fraction(fate), {expected, 0.0});
}

}  // namespace scintray::test
