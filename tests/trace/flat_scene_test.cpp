#include <cstddef>
#include <cstring>
#include <string>

#include "physics/traced.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::test;

namespace {

/// A turned crystal, a rough ball, a slab with a reflector on grease and a sensor, and two crystals beside it
/// across thin gaps: planes, exact round faces and Embree, smooth and rough interfaces, dispersion.
std::string mixed_scene(const std::string& accelerator, const std::string& curved) {
  return R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["3 mm", "3 mm", "10 mm"]
rotate = { axis = [0, 1, 0], angle = "30 deg" }
medium = "LSO_roncali2013"
surface = "polished"
[[part]]
name = "ball"
sphere = { radius = "3 mm", subdivisions = 4 }
translate = ["12 mm", "0 mm", "0 mm"]
medium = "LSO_roncali2013"
surface = "roncali2013_unified_rough"
[[part]]
name = "slab"
box = ["3 mm", "3 mm", "1 mm"]
translate = ["0 mm", "20 mm", "0 mm"]
medium = "LSO_roncali2013"
surface = "polished_lambertian_097"
[[part]]
name = "plate"
box = ["3 mm", "3 mm", "1 mm"]
translate = ["0 mm", "23.1 mm", "0 mm"]
medium = "LSO_roncali2013"
surface = "polished"
[[part]]
name = "plate_beside"
box = ["3 mm", "3 mm", "1 mm"]
translate = ["3.1 mm", "23.1 mm", "0 mm"]
medium = "LSO_roncali2013"
surface = "polished"
[[part]]
name = "pad"
box = ["3 mm", "3 mm", "0.5 mm"]
place = { touch = "slab", side = "-z" }
medium = "optical_grease_roncali2013"
surface = "polished_lambertian_097"
sensor = "ideal"
[[contact]]
between = ["slab", "pad"]
kind = "bonded"
surface = "polished"
[source]
type = "photons"
region = { part = "*l*" }
wavelength = "emission"
time = "0 ns"
photons = 2_000
[run]
accelerator = ")" +
         accelerator + "\"\ncurved = \"" + curved + "\"\n";
}

/// Records that went through bytes.
template <typename Record>
std::vector<Record> through_bytes(const std::vector<Record>& records) {
  static_assert(std::is_trivially_copyable_v<Record>);
  std::vector<std::byte> bytes(records.size() * sizeof(Record));
  if (!bytes.empty()) std::memcpy(bytes.data(), records.data(), bytes.size());
  std::vector<Record> copy(records.size());
  if (!bytes.empty()) std::memcpy(static_cast<void*>(copy.data()), bytes.data(), bytes.size());
  return copy;
}

template <typename IdType, typename Record>
IdVector<IdType, Record> through_bytes(const IdVector<IdType, Record>& records) {
  return IdVector<IdType, Record>(through_bytes(records.values()));
}

ExactBodies through_bytes(const ExactBodies& exact) {
  ExactBodies copy;
  copy.bodies = through_bytes(exact.bodies);
  copy.planes = through_bytes(exact.planes);
  copy.quadrics = through_bytes(exact.quadrics);
  copy.triangles = through_bytes(exact.triangles);
  copy.outlines = through_bytes(exact.outlines);
  copy.outline_of = through_bytes(exact.outline_of);
  copy.quadric_of = through_bytes(exact.quadric_of);
  copy.nodes = through_bytes(exact.nodes);
  copy.in_leaves = through_bytes(exact.in_leaves);
  copy.faces = through_bytes(exact.faces);
  copy.trims = through_bytes(exact.trims);
  copy.trim_surfaces = through_bytes(exact.trim_surfaces);
  copy.cells = through_bytes(exact.cells);
  copy.face_nodes = through_bytes(exact.face_nodes);
  copy.faces_in_leaves = through_bytes(exact.faces_in_leaves);
  copy.meshed = exact.meshed;
  copy.held = exact.held;
  return copy;
}

Boundary through_bytes(const Boundary& boundary) {
  Boundary copy;
  copy.vertices = through_bytes(boundary.vertices);
  copy.corners = through_bytes(boundary.corners);
  copy.triangle_planes = through_bytes(boundary.triangle_planes);
  copy.planes = through_bytes(boundary.planes);
  copy.opposite_planes = boundary.opposite_planes;
  copy.is_box = boundary.is_box;
  copy.plane_triangles = through_bytes(boundary.plane_triangles);
  copy.merged = {through_bytes(boundary.merged.corners), through_bytes(boundary.merged.stands_for)};
  copy.thin_gaps = {through_bytes(boundary.thin_gaps.gaps), through_bytes(boundary.thin_gaps.of_triangle)};
  copy.exact = through_bytes(boundary.exact);
  copy.size_mm = boundary.size_mm;
  copy.closed = boundary.closed;
  return copy;
}

/// A scene without a name in it, whose records went through bytes.
Scene through_bytes(const Scene& scene) {
  Scene copy;
  copy.regions = through_bytes(scene.regions);
  copy.links = through_bytes(scene.links);
  copy.twins = through_bytes(scene.twins);
  copy.interfaces = through_bytes(scene.interfaces);
  copy.total_reflections = through_bytes(scene.total_reflections);
  copy.optics.media = through_bytes(scene.optics.media);
  copy.optics.table = through_bytes(scene.optics.table);
  copy.optics.shifting_per_mm = through_bytes(scene.optics.shifting_per_mm);
  for (const auto& accelerator : scene.accelerators)
    copy.accelerators.push_back(std::make_shared<Accelerator>(through_bytes(accelerator->boundary())));
  copy.media = scene.media;
  copy.surfaces = scene.surfaces;
  copy.sensors = scene.sensors;
  return copy;
}

void check_same(const Photon& a, const Photon& b) {
  CHECK(a.position == b.position);
  CHECK(a.ray.direction == b.ray.direction);
  CHECK(a.ray.polarisation == b.ray.polarisation);
  CHECK(a.wavelength_nm == b.wavelength_nm);
  CHECK(a.time_ns == b.time_ns);
  CHECK(a.path_mm == b.path_mm);
  CHECK(a.optical_depth == b.optical_depth);
  CHECK(a.region == b.region);
  CHECK(a.interactions == b.interactions);
  CHECK(a.scatterings == b.scatterings);
}

}  // namespace

TEST_CASE("A scene and a photon that were copied as bytes continue to the same bits") {
  struct Run {
    std::string accelerator, curved;
  };
  for (const Run& run : {Run{"auto", "exact"}, Run{"auto", "facets"}, Run{"embree", "exact"}}) {
    CAPTURE(run.accelerator);
    CAPTURE(run.curved);
    const SceneSpec spec = scene_spec(mixed_scene(run.accelerator, run.curved));
    const BuiltScene built = SceneBuilder().build(spec);
    const Scene copy = through_bytes(built.scene);
    CHECK(built.scene.regions[kAmbientRegion].thin_gaps == (run.curved == "facets"));
    const PhotonSource source(spec.source, built.scene);
    PropagationLimits limits;
    limits.interactions = 500;
    std::uint64_t steps = 0, detected = 0;
    for (std::uint64_t i = 0; i < spec.source.photons; ++i) {
      CAPTURE(i);
      Rng rng(5, StreamKind::photon, i), other_rng(5, StreamKind::photon, i);
      Photon photon = source.emit(built.scene, rng);
      Photon other = source.emit(built.scene, other_rng);
      for (;;) {
        const Step one = step(built.scene, photon, rng, limits);
        const Step two = step(copy, other, other_rng, limits);
        other = through_bytes(std::vector<Photon>{other}).front();
        REQUIRE(one.event == two.event);
        REQUIRE(one.interface == two.interface);
        check_same(photon, other);
        ++steps;
        detected += one.event == StepEvent::detected;
        if (is_final(one.event) || limits.reached(photon)) break;
      }
    }
    CHECK(steps > 2 * spec.source.photons);
    CHECK(detected > 0);
  }
}

TEST_CASE("A photon reaches its limits once, by count or by time") {
  Photon photon;
  photon.interactions = 7;
  photon.time_ns = 2.0;
  PropagationLimits limits;
  limits.interactions = 8;
  CHECK_FALSE(limits.reached(photon));
  limits.time_ns = 2.0;
  CHECK_FALSE(limits.reached(photon));  // a photon at the limit is within it
  limits.time_ns = 1.5;
  CHECK(limits.reached(photon) == Fate::cut_time);
  limits.interactions = 7;
  CHECK(limits.reached(photon) == Fate::cut_interactions);
}
