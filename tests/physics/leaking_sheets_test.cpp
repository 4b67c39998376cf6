// Sheets that let light through, in scenes: between rooms, as septa, and as the wall of a sphere.
#include "physics/traced.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::test;

namespace {

/// Two rooms, one beside the other along x; light starts in the left one towards the right one. `between` is
/// what the rooms are, and what separates them.
std::string rooms(const std::string& between) {
  return R"(
ambient = "vacuum_n1"
)" + between +
         R"(
[[part]]
name = "mirror"
box = { low = ["-3 mm", "-1 mm", "0 mm"], high = ["-2.05 mm", "1 mm", "2 mm"] }
medium = "opaque"
surface = "mirror"
[[part]]
name = "eye"
box = { low = ["2.05 mm", "-1 mm", "0 mm"], high = ["3 mm", "1 mm", "2 mm"] }
sensor = "perfect_n1"
[source]
type = "photons"
position = ["-1 mm", "0.1 mm", "1 mm"]
direction = [1, 0, 0]
wavelength = "420 nm"
photons = 200_000
[surfaces.mirror]
model = "painted"
reflectance = 0.9
specular_share = 1.0
[surfaces.film]
model = "painted"
reflectance = 0.7
transmittance = 0.2
specular_share = 1.0
[reflectors.film]
reflectance = { value = 0.7 }
transmittance = { value = 0.2 }
direction = { specular_share = 1.0 }
)";
}

/// How the outer ends of two rooms touch what is there.
std::string ends(const std::string& left, const std::string& right) {
  const auto contact = [](const std::string& room, const char* end, const char* surface) {
    return fmt::format("[[contact]]\nbetween = [\"{}\", \"{}\"]\nkind = \"bonded\"\nsurface = \"{}\"\n", room,
                       end, surface);
  };
  return contact(left, "mirror", "mirror") + contact(right, "eye", "flat");
}

/// Light to and fro before a mirror of 0.9 and a film of 0.7 that lets 0.2 through.
constexpr double kDetected = 0.2 / (1.0 - 0.7 * 0.9);

}  // namespace

TEST_CASE("Law: light through a film between two boxes, t / (1 - r R)") {
  const Traced traced = trace(rooms(R"(
[[part]]
name = "left"
box = { low = ["-2.05 mm", "-1 mm", "0 mm"], high = ["0 mm", "1 mm", "2 mm"] }
medium = "vacuum_n1"
surface = "flat"
[[part]]
name = "right"
box = { low = ["0 mm", "-1 mm", "0 mm"], high = ["2.05 mm", "1 mm", "2 mm"] }
medium = "vacuum_n1"
surface = "flat"
[[contact]]
between = ["left", "right"]
kind = "bonded"
surface = "film"
)" + ends("left", "right")));
  check_fraction(traced.result, Fate::detected, kDetected);
  check_fraction(traced.result, Fate::absorbed_at_surface, 1.0 - kDetected);
}

TEST_CASE("Law: septa of an array transmit the share of their reflector, both faces together") {
  const Traced traced = trace(rooms(R"(
[[array]]
name = "room"
count = [2, 1]
pitch = "2.1 mm"
[array.element]
box = ["2 mm", "2 mm", "2 mm"]
medium = "vacuum_n1"
surface = "flat"
[array.septa]
reflector = "film"
medium = "vacuum_n1"
thickness = "0.1 mm"
)" + ends("room[0,0]", "room[1,0]")));
  check_fraction(traced.result, Fate::detected, kDetected);
  check_fraction(traced.result, Fate::absorbed_at_surface, 1.0 - kDetected);
}

TEST_CASE("Law: a sphere whose wall leaks, with a port") {
  // Lambertian walls illuminate the whole sphere uniformly: light is incident on the port with probability f,
  // else on the wall, which transmits t, reflects r, and absorbs the rest.
  constexpr double kReflectance = 0.9, kTransmittance = 0.04;
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "sphere"
sphere = { radius = "10 mm", subdivisions = 24 }
medium = "vacuum_n1"
surface = "wall"
[[part.face]]
name = "port"
select = { box = { low = ["-6 mm", "-6 mm", "8.5 mm"], high = ["6 mm", "6 mm", "11 mm"] } }
surface = "flat"
[source]
type = "photons"
position = ["0 mm", "0 mm", "0 mm"]
wavelength = "420 nm"
photons = 200_000
[[tally]]
type = "count"
name = "wall"
at = "crossed"
face = "sphere:other"
[[tally]]
type = "count"
name = "port"
at = "crossed"
face = "sphere:port"
[surfaces.wall]
model = "painted"
reflectance = 0.9
transmittance = 0.04
specular_share = 0.0
)");
  const Scene& scene = traced.built.scene;
  const double port = face_area(scene, "sphere:port");
  const double f = port / (port + face_area(scene, "sphere:other"));
  CHECK(f > 0.05);
  const double interactions = 1.0 / (1.0 - kReflectance * (1.0 - f));
  check_fraction(traced.result, Fate::absorbed_at_surface,
                 (1.0 - f) * (1.0 - kReflectance - kTransmittance) * interactions);
  check_fraction(traced.result, Fate::escaped, (f + (1.0 - f) * kTransmittance) * interactions);
  REQUIRE(traced.result.tallies.size() == 2);
  check_law("through the wall", traced.result.tallies[0].per_photon(0, traced.result.photons),
            {(1.0 - f) * kTransmittance * interactions, 0.0});
  check_law("through the port", traced.result.tallies[1].per_photon(0, traced.result.photons),
            {f * interactions, 0.0});
}

TEST_CASE("A photon that passes a sheet into an opaque part ends in it") {
  const Traced traced = trace(rooms(R"(
[[part]]
name = "wall"
box = { low = ["0 mm", "-1 mm", "0 mm"], high = ["1 mm", "1 mm", "2 mm"] }
medium = "opaque"
surface = "film"
)"));
  check_fraction(traced.result, Fate::absorbed_in_medium, kDetected);
  CHECK(traced.result.count(Fate::detected) == 0);
}
