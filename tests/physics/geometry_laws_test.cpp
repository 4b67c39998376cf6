// Laws that hold for every shape: what comes out of bodies, tapers and whole arrays, in closed form.
#include <algorithm>
#include <cmath>

#include "physics/traced.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/mesh/shapes/shapes.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/scene/place_parts.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::test;

namespace {

/// Points on a closed mesh, uniform in area, with the inward normal.
class BoundaryPoints {
 public:
  explicit BoundaryPoints(const TriMesh& mesh) : mesh_(mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      area_ += mesh.area_vector(t).norm();
      cumulated_.push_back(area_);
    }
  }
  std::pair<Vec3, Vec3> draw(Rng& rng) const {
    const double at = rng.uniform() * area_;
    const auto t = static_cast<std::size_t>(std::upper_bound(cumulated_.begin(), cumulated_.end() - 1, at) -
                                            cumulated_.begin());
    const Vec3 &a = mesh_.vertices[mesh_.triangles[t][0]], &b = mesh_.vertices[mesh_.triangles[t][1]],
               &c = mesh_.vertices[mesh_.triangles[t][2]];
    double u = rng.uniform(), v = rng.uniform();
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    return {a + u * (b - a) + v * (c - a), -mesh_.area_vector(t).normalized()};
  }
  double area() const { return area_; }

 private:
  const TriMesh& mesh_;
  double area_ = 0.0;
  std::vector<double> cumulated_;
};

}  // namespace

TEST_CASE("Law: integrating sphere f / (1 - rho (1 - f)), f by the exact area of the port") {
  for (const auto& row : {std::pair{24, 0.99}, std::pair{32, 0.9}}) {
    const auto& subdivisions = row.first;
    const auto& reflectance = row.second;
    const Traced traced = trace(fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "sphere"
sphere = {{ radius = "10 mm", subdivisions = {} }}
medium = "vacuum_n1"
surface = "wall"
[[part.face]]
name = "port"
select = {{ box = {{ low = ["-7 mm", "-7 mm", "6 mm"], high = ["7 mm", "7 mm", "11 mm"] }} }}
surface = "flat"
[source]
type = "photons"
position = ["0 mm", "0 mm", "0 mm"]
wavelength = "420 nm"
photons = 150_000
[surfaces.wall]
model = "painted"
reflectance = {}
specular_share = 0.0
)",
                                            subdivisions, reflectance));
    const double port = face_area(traced.built.scene, "sphere:port");
    const double f = port / (port + face_area(traced.built.scene, "sphere:other"));
    CAPTURE(subdivisions);
    CHECK(f > 0.03);
    // From the middle light hits the port with probability f, and so it does from everywhere on the wall.
    check_fraction(traced.result, Fate::escaped, f / (1.0 - reflectance * (1.0 - f)));
  }
}

TEST_CASE(
    "Law: mean chord 4V/S of convex bodies: prism, cylinder, sphere, taper, Winston cone, chamfered box") {
  for (
      const std::string shape :
      {R"(prism = { sides = 6, flat_to_flat = "3 mm", height = "10 mm" })",
       R"(cylinder = { radius = "2 mm", height = "5 mm", segments = 24 })",
       R"(sphere = { radius = "3 mm", subdivisions = 4 })",
       R"(tapered = { bottom = ["2 mm", "3 mm"], top = ["5 mm", "4 mm"], top_offset = ["1 mm", "0 mm"], height = "6 mm" })",
       R"(winston = { exit_radius = "1 mm", acceptance = "30 deg", segments = 24, rings = 12 })",
       "box = [\"2 mm\", \"2 mm\", \"10 mm\"]\nchamfer = \"0.3 mm\""}) {
    const SceneSpec spec = scene_spec(R"(
ambient = "vacuum_n1"
[[part]]
name = "body"
)" + shape + R"(
medium = "cloudy_n1"
surface = "white"
[source]
type = "photons"
region = { part = "body" }
wavelength = "420 nm"
photons = 1
[run]
curved = "facets"
)");
    SceneBuilder builder;
    const BuiltScene built = builder.build(spec);
    const PhotonSource source(spec.source, built.scene);
    Problems problems;
    const TriMesh mesh = place_parts(spec, problems).at(0).mesh;
    const BoundaryPoints boundary(mesh);
    Moments chord;
    for (std::uint64_t i = 0; i < 60'000; ++i) {
      Rng rng(12, StreamKind::photon, i);
      Photon photon = source.emit(built.scene, rng);
      const auto [position, inward] = boundary.draw(rng);
      photon.position = position;
      photon.ray.direction = sample_lambertian(inward, rng);
      while (photon.interactions < 1) step(built.scene, photon, rng);
      chord.add(photon.path_mm);
    }
    CAPTURE(shape);
    check_law("mean chord, mm", chord.mean(),
              {4.0 * built.scene.parts.front().volume_mm3 / boundary.area(), 0.0});
  }
}

TEST_CASE("Law: a square light pipe keeps 2 cos(tc) - 1 of the light made in it") {
  // Light is guided when it is incident on both walls beyond the critical angle: |dx|, |dy| < c = cos(tc).
  // Each excludes 1 - c of all directions; they exclude none twice while 2 c^2 > 1 (n > sqrt 2 ... tc < 45
  // deg).
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "pipe"
box = ["3 mm", "3 mm", "400 mm"]
medium = "n15"
surface = "flat"
[[array]]
name = "end"
count = [1, 1]
place = { touch = "pipe", side = "-z" }
[array.element]
box = ["3 mm", "3 mm", "1 mm"]
sensor = "perfect"
[[part]]
name = "far_end"
box = ["3 mm", "3 mm", "1 mm"]
place = { touch = "pipe", side = "+z" }
sensor = "perfect"
[source]
type = "photons"
region = { part = "pipe", slab_z = ["199 mm", "201 mm"] }
wavelength = "420 nm"
photons = 150_000
)");
  // Unguided light is incident on the walls some 50 times before the end and is lost.
  const double c = std::sqrt(1.0 - 1.0 / (1.5 * 1.5));
  CHECK(2.0 * c * c > 1.0);
  check_fraction(traced.result, Fate::detected, 2.0 * c - 1.0);
}

TEST_CASE("Law: a light pipe of index n accepts light of incidence below sin(t) = sqrt(n^2 - 1)") {
  constexpr double kIndex = 1.3;
  const double acceptance = std::asin(std::sqrt(kIndex * kIndex - 1.0)) / kDegree;
  CHECK(acceptance == doctest::Approx(56.17).epsilon(1e-4));
  for (const double angle : {acceptance - 0.5, acceptance + 0.5}) {
    const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "pipe"
box = ["3 mm", "3 mm", "1000 mm"]
medium = "n13"
surface = "flat"
[[part]]
name = "far_end"
box = ["3 mm", "3 mm", "1 mm"]
place = { touch = "pipe", side = "+z" }
sensor = "perfect_n13"
[source]
type = "photons"
position = ["0 mm", "0 mm", "-0.5 mm"]
polarisation = "unpolarised"
wavelength = "420 nm"
photons = 50_000
direction = )" + fmt::format("[{:.12f}, 0, {:.12f}]", std::sin(angle * kDegree), std::cos(angle * kDegree)) +
                                R"(
[media.n13]
index = { n = 1.3 }
absorption = { none = true }
scattering = { none = true }
[sensors.perfect_n13]
efficiency = { definition = "internal", value = 1.0 }
window = { index = 1.3 }
)");
    CAPTURE(angle);
    if (angle < acceptance)
      check_fraction(traced.result, Fate::detected,
                     1.0 - fresnel(std::cos(angle * kDegree), 1.0, kIndex).unpolarised());
    else
      CHECK(traced.result.count(Fate::detected) == 0);
  }
}

TEST_CASE("Law: a cube of eight bonded cubes traps as much light as one, 3 cos(tc) - 2") {
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[array]]
name = "crystal"
pitch = "2 mm"
count = [2, 2]
[array.element]
box = ["2 mm", "2 mm", "2 mm"]
medium = "lso_clear"
surface = "flat"
[[array.layer]]
[[array.layer]]
[source]
type = "photons"
region = { part = "crystal[0,1,0]" }
wavelength = "420 nm"
photons = 100_000
[run]
max_interactions = 400
)");
  CHECK(traced.built.scene.parts.size() == 8);
  check_fraction(traced.result, Fate::cut_interactions, 3.0 * std::sqrt(1.0 - 1.0 / (1.82 * 1.82)) - 2.0);
}

TEST_CASE(
    "Law: white furnace: light in equilibrium in a lossless array stays spread as n^2 V over all its parts") {
  // Two staggered layers of crystals, dry and glued, with septa of partial height, in a white box. Radiance
  // in equilibrium is n^2, so of the light's way, n^2 V is in each part; light that starts so, stays so.
  const SceneSpec spec = scene_spec(R"(
ambient = "vacuum_n1"
[[part]]
name = "box"
box = { low = ["-5 mm", "-5 mm", "-1 mm"], high = ["5 mm", "5 mm", "12 mm"] }
medium = "vacuum_n1"
surface = "white"
[[array]]
name = "crystal"
pitch = "2.2 mm"
count = [3, 3]
glue = { medium = "n15", thickness = "0.2 mm" }
[array.element]
box = ["2 mm", "2 mm", "5 mm"]
medium = "lso_clear"
surface = "flat"
[array.septa]
surface = "white"
thickness = "0.1 mm"
height = ["1 mm", "5 mm"]
[[array.layer]]
filler = "n15"
[[array.layer]]
count = [2, 2]
pitch = "2 mm"
septa = { surface = "white", thickness = "0.1 mm", x = false, y = false }
[[contact]]
between = ["crystal[1,*]", "crystal[1,*]"]
kind = "dry"
[source]
type = "photons"
region = { part = "box" }
wavelength = "420 nm"
photons = 1
)");
  SceneBuilder builder;
  const BuiltScene built = builder.build(spec);
  const Scene& scene = built.scene;
  const PhotonSource source(spec.source, scene);
  // Volume of the regions: what is nested in a part is not its own.
  IdVector<RegionId, double> weight(scene.regions.size(), 0.0);
  for (const PartInfo& part : scene.parts) {
    const MediumId medium = scene.regions[part.region].medium;
    if (scene.optics.is_opaque(medium)) continue;
    double volume = part.volume_mm3;
    for (const PartInfo& other : scene.parts) {
      const bool in_filler =
          matches_pattern("crystal[0,*", other.name) || matches_pattern("crystal_septum*", other.name);
      const bool in_box = other.name != "box" && !in_filler;
      if ((part.name == "box" && in_box) || (part.name == "crystal_filler[0]" && in_filler))
        volume -= other.volume_mm3;
    }
    weight[part.region] = volume * std::pow(scene.optics.index(medium, 420.0), 2);
  }
  double sum = 0.0;
  for (const double w : weight) sum += w;

  constexpr std::uint64_t kPhotons = 20'000;
  constexpr double kPath_mm = 150.0;
  IdVector<RegionId, std::uint64_t> found(scene.regions.size(), 0);
  std::uint64_t ended = 0;  // nothing absorbs
  const Eigen::AlignedBox3d bounds = scene.parts.front().bounds;
  for (std::uint64_t i = 0; i < kPhotons; ++i) {
    Rng rng(13, StreamKind::photon, i);
    Photon photon = source.emit(scene, rng);
    // A place with density n^2: drawn in the box, kept with probability n^2 / n_crystal^2.
    for (;;) {
      for (int axis = 0; axis < 3; ++axis)
        photon.position[axis] = bounds.min()[axis] + rng.uniform() * bounds.sizes()[axis];
      photon.region = scene.locate(photon.position);
      const MediumId medium = scene.regions[photon.region].medium;
      if (scene.optics.is_opaque(medium)) continue;
      photon.optics = scene.optics.at(medium, photon.wavelength_nm);
      if (rng.uniform() < std::pow(photon.optics.index / 1.82, 2)) break;
    }
    RegionId region = photon.region;
    while (photon.path_mm < kPath_mm && ended == 0) {
      region = photon.region;
      const StepEvent event = step(scene, photon, rng).event;
      ended += event != StepEvent::transmitted && event != StepEvent::reflected;
    }
    ++found[region];
  }
  CHECK(ended == 0);
  for (const RegionId r : scene.regions.ids()) {
    if (weight[r] == 0.0) {
      CHECK(found[r] == 0);
      continue;
    }
    CAPTURE(scene.region_names[r]);
    check_law(scene.region_names[r], binomial_estimate(found[r], kPhotons), {weight[r] / sum, 0.0});
  }
}
