#include "physics/traced.hpp"
#include "scintray/simulation/run_point.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::test;

namespace {

/// What a scene of two_bodies() is made with: by planes where they apply or by Embree, the angle by which the
/// crystal is turned, and its surface.
struct Made {
  std::string accelerator = "auto", turned = "40 deg", surface = "flat", medium = "lso";
};

/// A crystal and a cylinder beside it, of a medium that scatters and absorbs, or another.
std::string two_bodies(const Made& made) {
  return R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "3 mm", "20 mm"]
rotate = { axis = [1, 2, 3], angle = ")" +
         made.turned + R"(" }
medium = ")" +
         made.medium + R"("
surface = ")" +
         made.surface + R"("
[[part]]
name = "rod"
cylinder = { radius = "2 mm", height = "12 mm", segments = 12 }
translate = ["30 mm", "0 mm", "0 mm"]
medium = ")" +
         made.medium + R"("
surface = "flat"
[source]
type = "photons"
region = { part = "*" }
wavelength = "420 nm"
time = "0 ns"
photons = 4_000
[run]
curved = "facets"
accelerator = ")" +
         made.accelerator + R"("
[media.clear]
index = { n = 1.82 }
absorption = { none = true }
scattering = { none = true }
[surfaces.wrapped]
base = "flat"
gap = "air"
reflector = "ESR"
)";
}

struct Journey {
  Photon photon;
  Step last;
  std::uint64_t segments = 0;
};

Journey travel(const Scene& scene, const PhotonSource& source, std::uint64_t number,
               const PropagationLimits& limits) {
  Rng rng(3, StreamKind::photon, number);
  Journey followed;
  followed.photon = source.emit(scene, rng);
  do {
    followed.last = step(scene, followed.photon, rng, limits);
    followed.segments += followed.last.segments;
  } while (!is_final(followed.last.event) && followed.photon.interactions < 2'000);
  return followed;
}

struct TwoBodies {
  explicit TwoBodies(const Made& made)
      : spec(scene_spec(two_bodies(made))), built(builder.build(spec)), source(spec.source, built.scene) {}
  SceneSpec spec;
  SceneBuilder builder;
  BuiltScene built;
  PhotonSource source;
};

/// By Embree, by planes, and in boxes in which total reflections are passed many at once.
const Made kEveryWay[] = {
    {"embree"}, {"auto"}, {"auto", "0 deg"}, {"auto", "0 deg", "wrapped"}, {"auto", "40 deg", "wrapped"}};

}  // namespace

TEST_CASE("Propagation through total reflections has the path of one that stops at each") {
  for (const Made& made : kEveryWay) {
    CAPTURE(made.accelerator);
    CAPTURE(made.turned);
    CAPTURE(made.surface);
    const TwoBodies scene(made);
    PropagationLimits far;
    far.interactions = 2'000;
    std::uint64_t passed = 0;
    for (std::uint64_t i = 0; i < scene.spec.source.photons; ++i) {
      CAPTURE(i);
      const Journey stopping = travel(scene.built.scene, scene.source, i, {});
      const Journey passing = travel(scene.built.scene, scene.source, i, far);
      REQUIRE(passing.last.event == stopping.last.event);
      CHECK(passing.segments == stopping.segments);
      CHECK(passing.photon.interactions == stopping.photon.interactions);
      CHECK(passing.photon.scatterings == stopping.photon.scatterings);
      // Rays start from numbers that differ in single precision; what is exact stays so.
      const double path = stopping.photon.path_mm;
      CHECK((passing.photon.position - stopping.photon.position).norm() < 1e-9 * (1.0 + path));
      CHECK((passing.photon.ray.direction - stopping.photon.ray.direction).norm() < 1e-10);
      CHECK((passing.photon.ray.polarisation - stopping.photon.ray.polarisation).norm() < 1e-10);
      CHECK(std::abs(passing.photon.ray.polarisation.dot(passing.photon.ray.direction)) < 1e-10);
      CHECK(passing.photon.path_mm == doctest::Approx(path).epsilon(1e-10));
      CHECK(passing.photon.time_ns == doctest::Approx(stopping.photon.time_ns).epsilon(1e-10));
      passed += passing.segments;
    }
    CHECK(passed > 10 * scene.spec.source.photons);
  }
}

TEST_CASE("Recording the reflections passed records all of them, and changes nothing") {
  for (const Made& made : kEveryWay) {
    CAPTURE(made.accelerator);
    CAPTURE(made.turned);
    CAPTURE(made.surface);
    const TwoBodies scene(made);
    PropagationLimits alone;
    alone.interactions = 2'000;
    for (std::uint64_t i = 0; i < scene.spec.source.photons / 4; ++i) {
      CAPTURE(i);
      const Journey unwatched = travel(scene.built.scene, scene.source, i, alone);
      std::uint64_t reported = 0, segments = 0;
      double path_mm = 0.0;
      const auto visit = [&](const Photon& photon, const Step& passed) {
        ++reported;
        CHECK(passed.event == StepEvent::reflected);
        CHECK(passed.region == photon.region);
        CHECK(passed.segments == 1);
        CHECK(photon.path_mm >= path_mm);
        path_mm = photon.path_mm;
        // It is at the boundary that was recorded, moving away from it.
        const Region& region = scene.built.scene.regions[photon.region];
        const Vec3 normal = scene.built.scene.normal(region, passed.triangle);
        CHECK(photon.ray.direction.dot(normal) == doctest::Approx(-passed.cos_after).epsilon(1e-9));
        const Vec3 corner = scene.built.scene.triangle(region, passed.triangle)[0];
        CHECK(std::abs((photon.position - corner).dot(normal)) < 1e-9);
      };
      PropagationLimits watched = alone;
      watched.passed = visit;
      Rng rng(3, StreamKind::photon, i);
      Photon photon = scene.source.emit(scene.built.scene, rng);
      std::uint64_t steps = 0;
      for (Step taken{StepEvent::reflected}; !is_final(taken.event) && photon.interactions < 2'000;) {
        taken = step(scene.built.scene, photon, rng, watched);
        segments += taken.segments;
        ++steps;
      }
      CHECK(segments == unwatched.segments);
      CHECK(segments == steps + reported);
      CHECK(photon.position == unwatched.photon.position);
      CHECK(photon.ray.direction == unwatched.photon.ray.direction);
      CHECK(photon.ray.polarisation == unwatched.photon.ray.polarisation);
      CHECK(photon.path_mm == unwatched.photon.path_mm);
      CHECK(photon.time_ns == unwatched.photon.time_ns);
      CHECK(photon.interactions == unwatched.photon.interactions);
    }
  }
}

TEST_CASE("Propagation ends at the reflection that reaches a limit, and no sooner") {
  Made made{"embree"};
  SUBCASE("by Embree") {}
  SUBCASE("many at once") { made = {"auto", "0 deg"}; }
  const TwoBodies scene(made);
  std::uint64_t by_count = 0, by_time = 0;
  for (std::uint64_t i = 0; i < 1'000; ++i) {
    for (const bool count : {true, false}) {
      PropagationLimits limits;
      limits.interactions = count ? 5 : 2'000;
      if (!count) limits.time_ns = 0.1;
      Rng rng(3, StreamKind::photon, i);
      Photon photon = scene.source.emit(scene.built.scene, rng);
      double before_ns = photon.time_ns;
      const auto visit = [&](const Photon& on_way, const Step&) { before_ns = on_way.time_ns; };
      limits.passed = visit;
      const Step taken = step(scene.built.scene, photon, rng, limits);
      if (taken.event != StepEvent::reflected || taken.cos_before != taken.cos_after) continue;
      if (count) CHECK(photon.interactions <= 5);
      if (count && photon.interactions == 5) ++by_count;
      if (!count && photon.time_ns > 0.1) {
        ++by_time;
        CHECK(before_ns <= 0.1);
      }
    }
  }
  CHECK(by_count > 100);
  CHECK(by_time > 100);
}

TEST_CASE("Boxes that mostly reflect totally unfold, others do not") {
  const auto crystal_unfolds = [](const Made& made) {
    const TwoBodies scene(made);
    for (const PartInfo& part : scene.built.scene.parts)
      if (part.name == "crystal") return scene.built.scene.regions[part.region].unfolds;
    return false;
  };
  CHECK(crystal_unfolds({"auto", "0 deg"}));
  CHECK(crystal_unfolds({"auto", "40 deg"}));
  CHECK(crystal_unfolds({"auto", "0 deg", "wrapped"}));
  CHECK_FALSE(crystal_unfolds({"embree", "0 deg"}));
  CHECK_FALSE(crystal_unfolds({"auto", "0 deg", "roncali2013_unified_rough"}));
}

TEST_CASE(
    "Light along the faces, edges and axes of a box, and light without an end, is passed as one by one") {
  const TwoBodies scene({"auto", "0 deg", "flat", "clear"});
  const Scene& built = scene.built.scene;
  const double across = 1.0 / std::sqrt(2.0);
  const Vec3 centre = built.regions[RegionId(1)].centre;
  REQUIRE(built.regions[RegionId(1)].unfolds);
  const Vec3 directions[] = {{across, 0.0, across}, {0.0, across, -across}, {across, across, 0.0},
                             {0.6, 0.0, -0.8},      {0.0, -0.0, 1.0},       {-1.0, 0.0, 0.0},
                             {0.48, 0.64, 0.6},     {-0.36, 0.48, 0.8},     {0.57735, -0.57735, 0.57735}};
  const Vec3 starts[] = {
      {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.5, 0.0}, {-1.0, -1.5, -10.0}, {0.3, -1.5, 10.0}};
  PropagationLimits far;
  far.interactions = 5'000;
  std::uint64_t trapped = 0;
  for (const Vec3& direction : directions)
    for (const Vec3& start : starts) {
      CAPTURE(direction.transpose());
      CAPTURE(start.transpose());
      const auto travelled = [&](const PropagationLimits& limits) {
        Rng rng(3, StreamKind::photon, 1);
        Photon photon = scene.source.emit(built, rng);
        photon.region = RegionId(1);
        photon.optics = built.optics.at(built.regions[photon.region].medium, photon.wavelength_nm);
        photon.position = centre + start;
        photon.ray.direction = direction.normalized();
        photon.ray.polarisation = direction.unitOrthogonal();
        std::uint64_t segments = 0;
        do {
          const Step taken = step(built, photon, rng, limits);
          segments += taken.segments;
          if (is_final(taken.event) || taken.event == StepEvent::transmitted) break;
        } while (photon.interactions < far.interactions);
        return std::pair(photon, segments);
      };
      const auto [one, segments] = travelled({});
      const auto [many, in_all] = travelled(far);
      CHECK(in_all == segments);
      CHECK(many.interactions == one.interactions);
      CHECK(many.path_mm == doctest::Approx(one.path_mm).epsilon(1e-10));
      CHECK((many.position - one.position).norm() < 1e-9 * (1.0 + one.path_mm));
      CHECK((many.ray.direction - one.ray.direction).norm() < 1e-10);
      CHECK((many.ray.polarisation - one.ray.polarisation).norm() < 1e-10);
      if (one.interactions == far.interactions) ++trapped;
    }
  CHECK(trapped > 10);
  CHECK(trapped < 40);
}

TEST_CASE("A box is inside a region, or reaches into what bounds it") {
  const TwoBodies straight({"auto", "0 deg"});
  const BuiltScene& built = straight.built;
  const auto region_of = [&](const std::string& name) {
    for (const PartInfo& part : built.scene.parts)
      if (part.name == name) return part;
    throw std::runtime_error("no part");
  };
  const PartInfo crystal = region_of("crystal"), rod = region_of("rod");
  const auto contains = [&](const PartInfo& part, const Vec3& low, const Vec3& high) {
    return built.scene.region_contains(part.region, Eigen::AlignedBox3d(low, high));
  };
  const Vec3 low = crystal.bounds.min(), high = crystal.bounds.max();
  CHECK(contains(crystal, low, high));
  CHECK(contains(crystal, low + Vec3(0, 0, 3), high - Vec3(0, 0, 16)));
  CHECK_FALSE(contains(crystal, low, high + Vec3(0.001, 0, 0)));
  CHECK_FALSE(contains(crystal, high + Vec3(1, 1, 1), high + Vec3(2, 2, 2)));
  CHECK_FALSE(contains(rod, rod.bounds.min(), rod.bounds.max()));
  const Vec3 middle = rod.bounds.center();
  CHECK(contains(rod, middle - Vec3(1, 1, 5), middle + Vec3(1, 1, 5)));
  CHECK_FALSE(
      built.scene.region_contains(kAmbientRegion, Eigen::AlignedBox3d(Vec3(50, 50, 50), Vec3(51, 51, 51))));
  // From there no ray along the direction of the search hits anything.
  CHECK(built.scene.region_contains(kAmbientRegion, Vec3(50, 50, 50)));
  CHECK_FALSE(built.scene.region_contains(kAmbientRegion, Vec3(0.5 * (low + high))));
  CHECK_FALSE(built.scene.region_contains(crystal.region, Vec3(50, 50, 50)));
}
