#pragma once
/// Running small scenes written inside a test.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "scintray/scene/build_scene.hpp"
#include "scintray/scene/read_scene.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/trace/run.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"
#include "support/laws.hpp"

namespace scintray::test {

/// Media, surfaces and sensors that the scenes of the tests share: indices without dispersion.
inline const std::string kLibrary = R"(
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
  BuiltScene built;
  PointResult result;
  std::vector<EventRecord> events;  ///< of a source of energy
};

/// Scene text plus the library above, with `photons` from `[source]`.
inline SceneSpec scene_spec(const std::string& text) {
  return SceneFile::from_text(text + kLibrary,
                              (std::filesystem::path(SCINTRAY_SOURCE_DIR) / "test.toml").string())
      .spec(0);
}

inline Traced trace(const std::string& text, int threads = 0) {
  const SceneSpec spec = scene_spec(text);
  SurfaceMaker::Hooks hooks;
  hooks.cache.clear();
  SceneBuilder builder(hooks);
  Traced traced{builder.build(spec), {}, {}};
  const auto source = make_light_source(spec, traced.built.scene);
  const TallyPlan plan(traced.built.scene, spec);
  RunSettings settings;
  settings.seed = spec.run.seed;
  settings.max_interactions = spec.run.max_interactions;
  settings.threads = threads;
  RunHooks hooks_of_run;
  hooks_of_run.events = [&](const std::vector<EventRecord>& events) {
    traced.events.insert(traced.events.end(), events.begin(), events.end());
  };
  traced.result = run_point(traced.built.scene, *source, plan, settings, hooks_of_run);
  CHECK(traced.result.lost == 0);
  CHECK(traced.result.complete);
  return traced;
}

/// Area of the triangles of a face ("part:face"), mm2.
inline double face_area(const Scene& scene, const std::string& name) {
  double area = 0.0;
  for (const FaceInfo& face : scene.faces)
    if (face.name == name) area += face.area_mm2;
  return area;
}

/// Checks a fraction against an exact value.
inline void check_fraction(const PointResult& result, Fate fate, double expected) {
  check_law(std::string(fate_name(fate)), result.fraction(fate), {expected, 0.0});
}

}  // namespace scintray::test
