// Law of refraction at the exact faces of lenses: where rays that arrive parallel to the axis cross it.
#include <cmath>

#include "physics/traced.hpp"
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

constexpr double kLensIndex = 1.6;

/// A ray in the plane through the axis: height (mm), position along the axis (mm) and angle to it (rad).
struct AxialRay {
  double r, z, angle;
};

/// The ray after a spherical face about the axis at `centre` (mm), by Snell's law on its normal; the first
/// intersection for a centre beyond the face (bottom), the second for one before it (top).
AxialRay refracted(const AxialRay& ray, double centre, double radius, bool bottom, double n1, double n2) {
  // Distance along the ray to the sphere, by the quadratic equation.
  const double dr = std::sin(ray.angle), dz = std::cos(ray.angle);
  const double b = ray.r * dr + (ray.z - centre) * dz;
  const double c = ray.r * ray.r + (ray.z - centre) * (ray.z - centre) - radius * radius;
  const double t = bottom ? -b - std::sqrt(b * b - c) : -b + std::sqrt(b * b - c);
  const double r = ray.r + t * dr, z = ray.z + t * dz;
  // The normal's angle to the axis, along the light; the angle of incidence changes by Snell's law.
  const double normal = bottom ? std::atan2(-r, centre - z) : std::atan2(r, z - centre);
  const double incidence = ray.angle - normal;
  return {r, z, normal + std::asin(n1 / n2 * std::sin(incidence))};
}

/// Where the ray crosses the axis.
double crossing(const AxialRay& ray) { return ray.z - ray.r / std::tan(ray.angle); }

/// Where photons that arrive at a height along +z cross the axis behind the body, mm, and with what error by
/// rounding; photons that are reflected on the way are left out.
double traced_crossing(const BuiltScene& built, const SceneSpec& spec, double height) {
  const PhotonSource source(spec.source, built.scene);
  for (std::uint64_t i = 0; i < 200; ++i) {
    Rng rng(5, StreamKind::photon, i);
    Photon photon = source.emit(built.scene, rng);
    photon.position = Vec3(height, 0.0, -10.0);
    photon.ray.direction = Vec3::UnitZ();
    photon.ray.polarisation = Vec3::UnitY();
    photon.region = kAmbientRegion;
    photon.optics = built.scene.optics.at(built.scene.regions[kAmbientRegion].medium, photon.wavelength_nm);
    photon.on_triangle = kNoTriangle;
    bool through = true;
    for (int crossings = 0; crossings < 2 && through; ++crossings) {
      const Step taken = step(built.scene, photon, rng);
      through = !is_final(taken.event) && photon.ray.direction.z() > 0.0;
    }
    if (!through || photon.region != kAmbientRegion) continue;
    const double slope = photon.ray.direction.x() / photon.ray.direction.z();
    return photon.position.z() - photon.position.x() / slope;
  }
  return NAN;
}

void check_focus(const std::string& shape, double bottom_radius, double top_radius, double thickness) {
  CAPTURE(shape);
  for (const int segments : {12, 64}) {
    const SceneSpec spec = scene_spec("ambient = \"vacuum_n1\"\n[[part]]\nname = \"lens\"\n" +
                                      fmt::format(fmt::runtime(shape), segments) +
                                      "\nmedium = \"glass\"\nsurface = \"flat\"\n[media.glass]\nindex = { n "
                                      "= 1.6 }\nabsorption = { none = true }\n"
                                      "scattering = { none = true }\n[source]\ntype = "
                                      "\"photons\"\nwavelength = \"420 nm\"\nregion = { part = "
                                      "\"lens\" }\nphotons = 1\n");
    SceneBuilder builder;
    const BuiltScene built = builder.build(spec);
    REQUIRE(built.scene.parts.front().curved);
    for (const double height : {0.01, 0.5, 1.3}) {
      AxialRay ray{height, -10.0, 0.0};
      if (bottom_radius > 0.0) ray = refracted(ray, bottom_radius, bottom_radius, true, 1.0, kLensIndex);
      if (top_radius > 0.0) {
        ray = refracted(ray, thickness - top_radius, top_radius, false, kLensIndex, 1.0);
      } else {
        ray.r += (thickness - ray.z) * std::tan(ray.angle);
        ray.z = thickness;
        ray.angle = std::asin(kLensIndex * std::sin(ray.angle));
      }
      CAPTURE(height);
      CHECK(traced_crossing(built, spec, height) == doctest::Approx(crossing(ray)).epsilon(1e-9));
    }
  }
}

}  // namespace

TEST_CASE("Law: lenses and a ball focus where rays through their spheres by Snell's law cross the axis") {
  check_focus(R"(lens = {{ diameter = "4 mm", thickness = "2 mm", bottom_radius = "5 mm", segments = {} }})",
              5.0, 0.0, 2.0);
  check_focus(R"(lens = {{ diameter = "4 mm", thickness = "2 mm", top_radius = "5 mm", segments = {} }})",
              0.0, 5.0, 2.0);
  check_focus(
      R"(lens = {{ diameter = "4 mm", thickness = "2 mm", bottom_radius = "5 mm", top_radius = "8 mm", segments = {} }})",
      5.0, 8.0, 2.0);
  // Paraxial rays: a ball is a thick lens of two faces of power (n - 1) / R at the distance 2 R, whose focus
  // is n D / (4 (n - 1)) from its centre.
  check_focus(R"(sphere = {{ radius = "2 mm", subdivisions = {} }})"
              "\ntranslate = [\"0 mm\", \"0 mm\", \"2 mm\"]",
              2.0, 2.0, 4.0);
  AxialRay near = refracted({1e-5, -10.0, 0.0}, 2.0, 2.0, true, 1.0, kLensIndex);
  near = refracted(near, 2.0, 2.0, false, kLensIndex, 1.0);
  CHECK(crossing(near) - 2.0 == doctest::Approx(kLensIndex * 4.0 / (4.0 * (kLensIndex - 1.0))).epsilon(1e-6));
}

TEST_CASE(
    "Law: volume of bodies of revolution, exact; of lenses, to the fourth power of their facets' angle") {
  const auto cap = [](double radius, double height) {  // of a ball, by the height of the cap
    return kPi * height * height * (3.0 * radius - height) / 3.0;
  };
  const double sag = 5.0 - std::sqrt(25.0 - 4.0);
  for (const int segments : {12, 100}) {
    for (const auto& [shape, volume] :
         {std::pair{
              fmt::format("lens = {{ diameter = \"4 mm\", thickness = \"2 mm\", bottom_radius = \"5 mm\", "
                          "top_radius = \"5 mm\", segments = {} }}",
                          segments),
              2.0 * cap(5.0, sag) + kPi * 4.0 * (2.0 - 2.0 * sag)},
          std::pair{fmt::format("lens = {{ diameter = \"4 mm\", thickness = \"2 mm\", top_radius = \"2 mm\", "
                                "segments = {} }}",  // a half ball without an edge
                                segments),
                    2.0 / 3.0 * kPi * 8.0},
          std::pair{
              fmt::format(
                  "revolved = {{ r = [\"0 mm\", \"1 mm\", \"2 mm\", \"2 mm\", \"0 mm\"], z = [\"0 mm\", "
                  "\"0 mm\", \"1 mm\", \"4 mm\", \"5 mm\"], segments = {} }}",
                  segments),
              kPi / 3.0 * (1.0 + 2.0 + 4.0) + kPi * 4.0 * 3.0 + kPi / 3.0 * 4.0}}) {
      const std::string& text = shape;  // clang 14 captures no structured binding
      CAPTURE(text);
      SceneBuilder builder;
      const BuiltScene built = builder.build(scene_spec(
          "ambient = \"vacuum_n1\"\n[[part]]\nname = \"body\"\n" + shape +
          "\nmedium = \"n15\"\nsurface = \"flat\"\n[source]\ntype = \"photons\"\nwavelength = \"420 nm\"\n"
          "region = { part = \"body\" }\nphotons = 1\n"));
      CHECK(built.scene.parts.front().curved);
      // Parts of a ball end on a circle that no projection of a chord is (docs/curved_faces.md).
      const double angle = kTwoPi / segments;
      const double error = shape.starts_with("lens") ? 1e-4 * std::pow(angle, 4) : 1e-9;
      CHECK(built.scene.parts.front().volume_mm3 == doctest::Approx(volume).epsilon(error));
    }
  }
}
