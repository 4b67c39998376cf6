// Round walls that two parts have in common: one surface, whatever facets the two have.
#include <algorithm>
#include <cmath>

#include "scintray/core/sampling.hpp"
#include "support/curved_scenes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::scene_file;
using namespace scintray::test;

namespace {

std::string cylinder(int segments, double height = 5.0) {
  return fmt::format("cylinder = {{ radius = \"1 mm\", height = \"{} mm\", segments = {} }}", height,
                     segments);
}
std::string bore(int segments, double outer = 2.0) {
  return fmt::format(
      "tube = {{ outer_radius = \"{} mm\", inner_radius = \"1 mm\", height = \"5 mm\", segments = {} }}",
      outer, segments);
}
std::string lens(const char* diameter, double thickness, const char* faces, int segments) {
  return fmt::format("lens = {{ diameter = \"{} mm\", thickness = \"{} mm\", {}, segments = {} }}", diameter,
                     thickness, faces, segments);
}
std::string placed(double z, double turn_deg = 0.0) {
  return fmt::format(
      "surface = \"flat\"\ntranslate = [\"0 mm\", \"0 mm\", \"{} mm\"]\nrotate = {{ axis = [0, 0, 1], angle "
      "= "
      "\"{} deg\" }}\n",
      z, turn_deg);
}

/// Two parts, the first inside of the common wall.
std::string pair_of(const std::string& inner, const std::string& outer, const std::string& inner_placed,
                    const std::string& outer_placed = placed(0.0)) {
  return part("inner", inner, "absorbing", inner_placed) + part("outer", outer, "n15", outer_placed);
}

/// A scene of absorbing media in vacuum, with photons from the inner part.
std::string scene_of(const std::string& parts, int photons) {
  return "ambient = \"vacuum_n1\"\n" + parts +
         fmt::format(R"([media.absorbing]
index = {{ n = 1.6 }}
absorption = {{ length = "20 mm" }}
scattering = {{ none = true }}
[source]
type = "photons"
region = {{ part = "inner" }}
wavelength = "420 nm"
photons = {}
[run]
seed = 1
)",
                     photons);
}

}  // namespace

TEST_CASE("Parts with a round wall in common have the same fates whatever their facets") {
  const std::string convex = R"(bottom_radius = "8 mm", top_radius = "8 mm")",
                    concave = R"(bottom_radius = "-8 mm", top_radius = "20 mm")";
  const auto conical = [](int segments) {
    return fmt::format(
        "cone = {{ bottom_radius = \"0.5 mm\", top_radius = \"1.5 mm\", height = \"5 mm\", "
        "segments = {} }}",
        segments);
  };
  const auto conical_bore = [](int segments) {
    return fmt::format(
        "revolved = {{ r = [\"0.5 mm\", \"3 mm\", \"3 mm\", \"1.5 mm\"], z = [\"0 mm\", "
        "\"0 mm\", \"5 mm\", \"5 mm\"], segments = {} }}",
        segments);
  };
  const std::vector<std::vector<std::string>> alike{
      // A rod in a bore: of the same facets, turned, of other ones.
      {pair_of(cylinder(12), bore(12), placed(0.0)), pair_of(cylinder(12), bore(12), placed(0.0, 15.0)),
       pair_of(cylinder(10), bore(12), placed(0.0)), pair_of(cylinder(72), bore(12), placed(0.0)),
       pair_of(cylinder(6), bore(128), placed(0.0))},
      // One that extends beyond both ends, one that ends inside, and one that does both.
      {pair_of(cylinder(24, 9.0), bore(24), placed(-2.0)),
       pair_of(cylinder(24, 9.0), bore(36), placed(-2.0))},
      {pair_of(cylinder(24, 3.0), bore(24), placed(1.0)), pair_of(cylinder(24, 3.0), bore(36), placed(1.0))},
      {pair_of(cylinder(24), bore(24), placed(2.5)), pair_of(cylinder(24), bore(36), placed(2.5))},
      // Cones, and a lens in the hollow face of a larger one.
      {pair_of(conical(24), conical_bore(24), placed(0.0)),
       pair_of(conical(24), conical_bore(36), placed(0.0)),
       pair_of(conical(72), conical_bore(20), placed(0.0))},
      {pair_of(lens("6", 3.0, convex.c_str(), 24), lens("8", 1.0, concave.c_str(), 36), placed(0.0),
               placed(3.0)),
       pair_of(lens("6", 3.0, convex.c_str(), 36), lens("8", 1.0, concave.c_str(), 24), placed(0.0),
               placed(3.0)),
       pair_of(lens("6", 3.0, convex.c_str(), 64), lens("8", 1.0, concave.c_str(), 16), placed(0.0),
               placed(3.0))},
  };
  constexpr int kPhotons = 10'000;
  for (const std::vector<std::string>& scenes : alike) {
    std::vector<double> absorbed;
    for (const std::string& parts : scenes) {
      CAPTURE(parts);
      const Traced traced = trace(scene_of(parts, kPhotons));
      for (const PartInfo& body : traced.built.scene.parts) CHECK(body.curved);
      CHECK(traced.result.lost == 0);
      absorbed.push_back(static_cast<double>(traced.result.count(Fate::absorbed_in_medium)));
    }
    CHECK(absorbed.front() > 500.0);
    // The same photons: starts in boxes that differ in the last digits let a few of them differ.
    for (const double count : absorbed) CHECK(std::abs(count - absorbed.front()) <= 4e-4 * kPhotons);
  }
}

TEST_CASE("Sizes of parts with a round wall in common are those of the exact bodies") {
  for (const int segments : {10, 12, 37}) {
    CAPTURE(segments);
    const BuiltScene built =
        build(spec_of(pair_of(cylinder(12), bore(segments), placed(0.0, 4.0)) +
                          "[media.absorbing]\nindex = { n = 1.6 }\nabsorption = { none = "
                          "true }\nscattering = { none = true }\n",
                      "inner"));
    const auto parts = built.scene.parts.begin();
    CHECK(parts[0].volume_mm3 == doctest::Approx(5.0 * kPi).epsilon(1e-9));
    CHECK(parts[1].volume_mm3 == doctest::Approx(15.0 * kPi).epsilon(1e-9));
    CHECK(built.scene.faces.begin()[0].area_mm2 == doctest::Approx(12.0 * kPi).epsilon(1e-9));
    CHECK(built.scene.faces.begin()[1].area_mm2 == doctest::Approx(36.0 * kPi).epsilon(1e-9));
  }
}

TEST_CASE("A contact on a round wall ends where the face of the smaller part does, not at its polygon") {
  // A lens of 6 mm in the hollow face of one of 8 mm, both of 12 facets: sphere of 8 mm below z = 3 mm.
  const BuiltScene built =
      build(spec_of(part("small", lens("6", 3.0, R"(bottom_radius = "8 mm", top_radius = "8 mm")", 12)) +
                        part("large", lens("8", 1.0, R"(bottom_radius = "-8 mm", top_radius = "20 mm")", 12),
                             "lso_clear", placed(3.0)),
                    "small"));
  const Region& large = region_of(built, "large");
  REQUIRE(large.curved);
  int inside = 0, outside = 0;
  for (std::uint64_t i = 0; i < 2'000; ++i) {
    Rng rng(5, StreamKind::other, i);
    const double phi = kTwoPi * rng.uniform(), rho = 2.85 + 0.3 * rng.uniform();  // the polygon: 2.9 to 3 mm
    const double z = -5.0 + std::sqrt(64.0 - rho * rho);
    const Vec3 at(rho * std::cos(phi), rho * std::sin(phi), z);
    const Exit exit = built.scene.find_exit(large, at + Vec3(0.0, 0.0, 0.5), Vec3(0.0, 0.0, -1.0));
    CHECK(exit.distance_mm == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(name_at(built, large, exit.triangle) == (rho < 3.0 ? "small" : "ambient"));
    ++(rho < 3.0 ? inside : outside);
  }
  CHECK(inside > 500);
  CHECK(outside > 500);
}

TEST_CASE("A part that takes the facets of another on a common wall states it") {
  const BuiltScene built =
      build(spec_of(part("rod", cylinder(10), "lso_clear") + part("tile", bore(12)), "tile"));
  const auto is_noted = [](const PartReport& part) {
    return std::any_of(part.notes.begin(), part.notes.end(), [](const std::string& note) {
      return note.find("on their common round wall") != std::string::npos;
    });
  };
  CHECK(std::count_if(built.parts.begin(), built.parts.end(), is_noted) == 1);
}
