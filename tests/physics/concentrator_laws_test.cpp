// Tapers and concentrators: what comes out of them, in closed form.
#include <cmath>

#include "physics/traced.hpp"
#include "scintray/mesh/shapes/shapes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::scene;
using namespace scintray::test;

namespace {

const std::string kMirror = R"(
[surfaces.mirror]
model = "painted"
reflectance = 1.0
specular_share = 1.0
)";

/// A hollow concentrator or taper with mirrors for walls, and a sensor of index 1 at its narrow end, lit from
/// a thin slab under its wide end.
std::string hollow_taper(const std::string& shape, double wide_z, const std::string& direction,
                         std::uint64_t photons) {
  return R"(
ambient = "vacuum_n1"
[[part]]
name = "taper"
)" + shape +
         R"(
medium = "vacuum_n1"
surface = "mirror"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "flat"
[[part.face]]
name = "entrance"
select = { normal = [0, 0, 1] }
surface = "flat"
[[part]]
name = "sensor"
box = ["50 mm", "50 mm", "1 mm"]
place = { touch = "taper", side = "-z" }
sensor = "perfect_n1"
[source]
type = "photons"
wavelength = "420 nm"
)" +
         fmt::format("region = {{ part = \"taper\", slab_z = [\"{0:.9f} mm\", \"{1:.9f} mm\"] }}\n",
                     wide_z - 1e-6, wide_z) +
         "direction = " + direction + fmt::format("\nphotons = {}\n", photons) + kMirror;
}

/// A beam in the xz plane, going down at an angle to the axis.
std::string beam(double angle_deg) {
  return fmt::format("[{:.12f}, 0, {:.12f}]", std::sin(angle_deg * kDegree), -std::cos(angle_deg * kDegree));
}

}  // namespace

TEST_CASE("Law: a Winston trough accepts all light up to its acceptance angle, and none beyond") {
  const double length = winston_length(2.0, 30.0 * kDegree);
  const std::string shape =
      R"(winston = { exit_radius = "2 mm", acceptance = "30 deg", trough = "5 mm", rings = 400 })";
  for (const auto& row : {std::pair{0.0, 1.0}, std::pair{15.0, 1.0}, std::pair{29.5, 1.0},
                          std::pair{30.5, 0.0}, std::pair{45.0, 0.0}}) {
    const auto& angle = row.first;
    const auto& expected = row.second;
    CAPTURE(angle);
    const int photons = law_photons(20'000);
    const Traced traced = trace(hollow_taper(shape, length, beam(angle), photons));
    CHECK(traced.result.count(expected > 0.0 ? Fate::escaped : Fate::detected) == 0);
    CHECK(traced.result.count(expected > 0.0 ? Fate::detected : Fate::escaped) ==
          static_cast<std::uint64_t>(photons));
  }
}

TEST_CASE("Law: a Winston cone accepts all light along its axis and none well beyond its acceptance angle") {
  const double length = winston_length(2.0, 30.0 * kDegree);
  const std::string shape =
      R"(winston = { exit_radius = "2 mm", entrance_radius = "4 mm", segments = 128, rings = 200 })";
  CHECK(trace(hollow_taper(shape, length, beam(0.0), law_photons(20'000))).result.count(Fate::escaped) == 0);
  CHECK(trace(hollow_taper(shape, length, beam(36.0), law_photons(20'000))).result.count(Fate::detected) ==
        0);
}

TEST_CASE("Law: etendue: of Lambertian light into a taper the ratio of the areas leaves it, A_out / A_in") {
  // Light sent back from the narrow end always gets out of the wide one, for every wall turns it outwards; so
  // by reversal what gets through has the etendue of the narrow end, pi A_out (Liouville's theorem).
  const double length = winston_length(2.0, 30.0 * kDegree);
  for (
      const auto& row :
      {std::pair<std::string, double>{
           R"(tapered = { bottom = ["2 mm", "3 mm"], top = ["6 mm", "4 mm"], height = "9 mm" })", 9.0},
       std::pair<std::string, double>{
           R"(winston = { exit_radius = "2 mm", acceptance = "30 deg", segments = 24, rings = 16 })", length},
       std::pair<std::string, double>{
           R"(winston = { exit_radius = "2 mm", acceptance = "30 deg", length = "6 mm", segments = 24, rings = 16 })",
           6.0}}) {
    const auto& shape = row.first;
    const auto& height = row.second;
    CAPTURE(shape);
    const int photons = law_photons(100'000);
    const Traced traced = trace(hollow_taper(shape, height, "{ lambertian = [0, 0, -1] }", photons));
    const Scene& scene = traced.built.scene;
    check_fraction(traced.result, Fate::detected,
                   face_area(scene, "taper:exit") / face_area(scene, "taper:entrance"));
    CHECK(traced.result.count(Fate::detected) + traced.result.count(Fate::escaped) ==
          static_cast<std::uint64_t>(photons));
  }
}
