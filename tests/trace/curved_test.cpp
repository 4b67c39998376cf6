// Regions with exact round faces: ray queries, reflections round walls, nested and touching bodies.
#include <algorithm>
#include <cmath>

#include "scintray/core/sampling.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/curved_scenes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::scene_file;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::test;

namespace {

const std::string kRod = R"(cylinder = { radius = "1.5 mm", height = "20 mm", segments = 12 })";
const std::string kBall = R"(sphere = { radius = "2 mm", subdivisions = 2 })";

}  // namespace

TEST_CASE("A rod and a ball are left where their surface is, whatever their facets") {
  for (const std::string& shape : {kRod, kBall}) {
    const bool rod = shape == kRod;
    const SceneSpec spec = spec_of(part("body", shape), "body");
    const BuiltScene built = build(spec);
    const Region& region = region_of(built, "body");
    CHECK(region.curved);
    CHECK(built.scene.parts.front().curved);
    for (std::uint64_t i = 0; i < 20'000; ++i) {
      Rng rng(7, StreamKind::other, i);
      const double u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
      const Vec3 p = rod ? Vec3(1.5 * std::sqrt(u) * std::cos(kTwoPi * v),
                                1.5 * std::sqrt(u) * std::sin(kTwoPi * v), 20.0 * w)
                         : Vec3(2.0 * std::cbrt(u) * sample_isotropic(rng));
      const Vec3 d = sample_isotropic(rng);
      const Exit exit = built.scene.find_exit(region, p, d);
      REQUIRE(exit.triangle != kNoTriangle);
      const Vec3 end = p + exit.distance_mm * d;
      const Vec3 normal = built.scene.normal_at(region, exit.triangle, end);
      CHECK(normal.dot(d) > -1e-9);
      CHECK(std::abs(normal.norm() - 1.0) < 1e-14);
      if (!rod) {
        CHECK(std::abs(end.norm() - 2.0) < 1e-13);
        CHECK((normal - end.normalized()).norm() < 1e-13);
      } else {
        const double rho = std::hypot(end.x(), end.y());
        const bool side = normal.z() == 0.0;
        CHECK(std::abs(side ? rho - 1.5 : normal.z() > 0.0 ? end.z() - 20.0 : end.z()) < 1e-12);
        CHECK(rho < 1.5 + 1e-12);
        CHECK(end.z() > -1e-12);
        CHECK(end.z() < 20.0 + 1e-12);
      }
      // And back in from the ambient region: at the same point, through the same face.
      const Region& ambient = built.scene.regions[kAmbientRegion];
      const Vec3 beyond = end + 5.0 * d;
      const Exit back = built.scene.find_exit(ambient, beyond, Vec3(-d));
      REQUIRE(back.triangle != kNoTriangle);
      CHECK((beyond - back.distance_mm * d - end).norm() < 1e-9);
      // Nothing ahead on the way out.
      CHECK(built.scene.find_exit(ambient, end, d).triangle == kNoTriangle);
    }
  }
}

TEST_CASE("Total reflections round a wall keep their angle and the wall over 1e6 of them") {
  struct Case {
    std::string shape;
    Vec3 position, direction;
  };
  for (const Case& c :
       {Case{kBall, {1.7, 0.2, 0.1}, {0.3, 1.0, 0.4}}, Case{kBall, {0, 1.9999999, 0}, {1.0, 0, 0.2}},
        Case{kRod, {1.2, 0.0, 3.0}, {0.0, 1.0, 0.1}},
        Case{kRod, {1.4999999999, 0.0, 3.0}, {0.0, 1.0, 0.3}}}) {
    const bool ball = c.shape == kBall;
    const SceneSpec spec = spec_of(part("body", c.shape), "body");
    const BuiltScene built = build(spec);
    Photon photon = photon_in(built, spec, c.position, c.direction);
    const Vec3 turn = photon.position.vec().cross(photon.ray.direction.vec());
    const double along = photon.ray.direction.z();
    PropagationLimits limits;
    limits.interactions = 1'000'000;
    Rng rng(1, StreamKind::photon, 1);
    const Step taken = step(built.scene, photon, rng, limits);
    CHECK(taken.event == StepEvent::reflected);
    CHECK(photon.interactions == 1'000'000);
    CHECK(std::abs(photon.ray.direction.norm() - 1.0) < 1e-9);
    const Vec3 turned = photon.position.vec().cross(photon.ray.direction.vec());
    if (ball) {
      CHECK(std::abs(photon.position.norm() - 2.0) < 1e-14);
      CHECK((turned - turn).norm() < 1e-8);
    } else {
      const double rho = std::hypot(photon.position.x(), photon.position.y());
      const bool at_end =
          std::min(std::abs(photon.position.z()), std::abs(photon.position.z() - 20.0)) < 1e-9;
      if (!at_end) CHECK(std::abs(rho - 1.5) < 1e-14);
      CHECK(std::abs(turned.z() - turn.z()) < 1e-8);
      CHECK(std::abs(std::abs(photon.ray.direction.z()) - std::abs(along)) < 1e-8);
    }
  }
}

TEST_CASE("Fates do not depend on the facets of a rod or a ball") {
  const auto count = [](const std::string& shape) {
    const Traced traced = trace("ambient = \"vacuum_n1\"\n" + part("body", shape, "lso") + R"(
[[part]]
name = "sensor"
box = ["3 mm", "3 mm", "1 mm"]
place = { touch = "body", side = "-z" }
sensor = "perfect"
[source]
type = "photons"
region = { part = "body" }
wavelength = "420 nm"
photons = 20_000
)");
    return std::array<std::uint64_t, 3>{traced.result.count(Fate::detected),
                                        traced.result.count(Fate::escaped), traced.result.photons};
  };
  const auto rod = [](int sides) {
    return "cylinder = { radius = \"1.5 mm\", height = \"20 mm\", segments = " + std::to_string(sides) + " }";
  };
  const auto coarse = count(rod(12));
  CHECK(coarse[0] > 2'000);
  for (const int sides : {72, 512}) {
    const auto fine = count(rod(sides));
    // The bodies are the same to rounding, and so are the photons, but for the few that rounding turns.
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(std::abs(static_cast<double>(fine[i]) - static_cast<double>(coarse[i])) < 20.0);
  }
}

TEST_CASE("A core in a cladding, flush at the ends, on a window: each end leads where its circle is") {
  const std::string parts =
      part("cladding", R"(cylinder = { radius = "1 mm", height = "10 mm", segments = 12 })", "n15") +
      part("core", R"(cylinder = { radius = "0.6 mm", height = "10 mm", segments = 7 })", "lso_clear") +
      part("window", R"(box = { low = ["-3 mm", "-3 mm", "-2 mm"], high = ["3 mm", "3 mm", "0 mm"] })",
           "n15");
  const SceneSpec spec = spec_of(parts, "core");
  const BuiltScene built = build(spec);
  for (const char* name : {"ambient", "cladding", "core", "window"}) CHECK(region_of(built, name).curved);
  const Region& window = region_of(built, "window");
  const Region& ambient = region_of(built, "ambient");
  for (std::uint64_t i = 0; i < 5'000; ++i) {
    Rng rng(3, StreamKind::other, i);
    const double x = 2.4 * rng.uniform() - 1.2, y = 2.4 * rng.uniform() - 1.2, rho = std::hypot(x, y);
    const Exit up = built.scene.find_exit(window, Vec3(x, y, -1.0), Vec3(0, 0, 1));
    CHECK(up.distance_mm == doctest::Approx(1.0).epsilon(1e-12));
    const std::string expected = rho < 0.6 ? "core" : rho < 1.0 ? "cladding" : "ambient";
    CHECK(name_at(built, window, up.triangle) == expected);
    const Exit down = built.scene.find_exit(ambient, Vec3(x, y, 15.0), Vec3(0, 0, -1));
    CHECK(down.distance_mm == doctest::Approx(rho < 1.0 ? 5.0 : 15.0).epsilon(1e-12));
    CHECK(name_at(built, ambient, down.triangle) == (expected == "ambient" ? "window" : expected));
  }
  const Exit inwards = built.scene.find_exit(region_of(built, "cladding"), Vec3(0.8, 0, 5), Vec3(-1, 0, 0));
  CHECK(name_at(built, region_of(built, "cladding"), inwards.triangle) == "core");
  CHECK(inwards.distance_mm == doctest::Approx(0.2).epsilon(1e-12));
}

TEST_CASE("Parts that are cut, hollow or touched by facets keep theirs, with the reason") {
  const SceneSpec facets = spec_of(part("body", kRod), "body", "[run]\ncurved = \"facets\"\n");
  const BuiltScene flat = build(facets);
  CHECK_FALSE(region_of(flat, "body").curved);
  CHECK(flat.scene.parts.front().facets_because.find("run.curved") != std::string::npos);
  CHECK(flat.scene.faces.front().curve == "cylinder");
  CHECK_FALSE(flat.scene.faces.front().exact);
  // Twelve sides, of which one lies flat on the box beside it.
  const SceneSpec touched = spec_of(
      part("body", kRod, "n15", "surface = \"flat\"\nrotate = { axis = [0, 0, 1], angle = \"15 deg\" }\n") +
          part(
              "block",
              R"(box = { low = ["1.448888739433602 mm", "-2 mm", "0 mm"], high = ["4 mm", "2 mm", "20 mm"] })"),
      "body");
  const BuiltScene both = build(touched);
  CHECK_FALSE(region_of(both, "body").curved);
  CHECK(both.scene.parts.front().facets_because.find("block") != std::string::npos);
}

TEST_CASE("Volumes, areas and bounds are those of the exact bodies") {
  const BuiltScene built = build(spec_of(
      part("rod", kRod) +
          part("ball", kBall, "n15", "surface = \"flat\"\ntranslate = [\"10 mm\", \"0 mm\", \"0 mm\"]\n"),
      "rod"));
  CHECK(built.scene.parts.front().volume_mm3 == doctest::Approx(kPi * 2.25 * 20.0).epsilon(1e-12));
  const PartInfo& ball = *(built.scene.parts.begin() + 1);
  CHECK(ball.volume_mm3 == doctest::Approx(4.0 / 3.0 * kPi * 8.0).epsilon(1e-12));
  CHECK(ball.bounds.min().isApprox(Vec3(8, -2, -2), 1e-12));
  CHECK(ball.bounds.max().isApprox(Vec3(12, 2, 2), 1e-12));
  double area = 0.0;
  for (const FaceInfo& face : built.scene.faces) area += face.area_mm2;
  CHECK(area == doctest::Approx(2.0 * kPi * 1.5 * 21.5 + 16.0 * kPi).epsilon(1e-12));
}

TEST_CASE("Among many balls and rods the ambient region finds the one that is met first") {
  // Balls of different sizes on a turned grid, and a mesh among them, against a search of all.
  std::string parts =
      part("block", R"(box = { low = ["-40 mm", "-40 mm", "-3 mm"], high = ["40 mm", "40 mm", "-2 mm"] })");
  std::vector<std::pair<Vec3, double>> balls;
  for (int i = 0; i < 40; ++i) {
    const Vec3 at(5.0 * (i % 8) - 17.0 + 0.1 * i, 5.0 * (i / 8) - 9.0, 2.0 + 0.07 * i);
    const double radius = 0.5 + 0.03 * i;
    balls.emplace_back(at, radius);
    parts += part("ball" + std::to_string(i),
                  fmt::format("sphere = {{ radius = \"{} mm\", subdivisions = 2 }}", radius), "n15",
                  fmt::format("surface = \"flat\"\ntranslate = [\"{} mm\", \"{} mm\", \"{} mm\"]\n", at.x(),
                              at.y(), at.z()));
  }
  const BuiltScene built = build(spec_of(parts, "block"));
  const Region& ambient = built.scene.regions[kAmbientRegion];
  std::uint64_t met = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    Rng rng(13, StreamKind::other, i);
    const Vec3 p(60.0 * rng.uniform() - 30.0, 60.0 * rng.uniform() - 30.0, 20.0);
    Vec3 d = sample_isotropic(rng);
    d.z() = -std::abs(d.z());
    if (i % 50 == 0) d = Vec3(0, 0, -1);
    double first = (p.z() + 2.0) / -d.z();
    const Vec3 on_block = p + first * d;
    if (std::max(std::abs(on_block.x()), std::abs(on_block.y())) > 40.0) first = HUGE_VAL;
    bool ball = false;
    for (const auto& [centre, radius] : balls) {
      const Vec3 w = p - centre;
      const double b = w.dot(d), c = w.squaredNorm() - radius * radius;
      if (b * b - c <= 0.0 || -b - std::sqrt(b * b - c) >= first) continue;
      first = -b - std::sqrt(b * b - c);
      ball = true;
    }
    const Exit exit = built.scene.find_exit(ambient, p, d);
    if (first > 40.0 / -d.z()) continue;  // along the block's rim
    REQUIRE(exit.triangle != kNoTriangle);
    CHECK(exit.distance_mm == doctest::Approx(first).epsilon(1e-6));
    met += ball;
  }
  CHECK(met > 500);
}

TEST_CASE("Nothing is lost among bodies that touch in a point, share a radius, are tiny, huge or far away") {
  struct Case {
    std::string parts, first;
  };
  const auto at = [](const std::string& x, const std::string& y, const std::string& z) {
    return "surface = \"flat\"\ntranslate = [\"" + x + "\", \"" + y + "\", \"" + z + "\"]\n";
  };
  const std::vector<Case> cases{
      // Tangent rods, and a ball on the end of one.
      {part("a", R"(cylinder = { radius = "1 mm", height = "5 mm", segments = 12 })") +
           part("b", R"(cylinder = { radius = "1 mm", height = "5 mm", segments = 12 })", "lso_clear",
                at("2 mm", "0 mm", "0 mm")) +
           part("c", R"(sphere = { radius = "1 mm", subdivisions = 3 })", "n15", at("0 mm", "0 mm", "6 mm")),
       "a"},
      // A ball of the radius of the rod around it, and of the bore around it, by other facets.
      {part("a", R"(cylinder = { radius = "1 mm", height = "5 mm", segments = 12 })") +
           part("b", R"(sphere = { radius = "1 mm", subdivisions = 3 })", "lso_clear",
                at("0 mm", "0 mm", "2.5 mm")),
       "a"},
      {part("a",
            R"(tube = { outer_radius = "2 mm", inner_radius = "1 mm", height = "5 mm", segments = 12 })") +
           part("b", R"(sphere = { radius = "1 mm", subdivisions = 3 })", "lso_clear",
                at("0 mm", "0 mm", "2.5 mm")),
       "b"},
      // A rod in a bore of 1 um more, turned, whose facets overlap; a torus around a rod, and in a tube.
      {part(
           "a",
           R"(tube = { outer_radius = "2 mm", inner_radius = "1.001 mm", height = "5 mm", segments = 12 })") +
           part("b", R"(cylinder = { radius = "1 mm", height = "6 mm", segments = 10 })", "lso_clear",
                at("0 mm", "0 mm", "-0.5 mm")),
       "b"},
      {part("a", R"(cylinder = { radius = "1 mm", height = "5 mm", segments = 7 })") +
           part("b",
                R"(torus = { radius = "1.5 mm", tube_radius = "0.5 mm", segments = 16, tube_segments = 12 })",
                "lso_clear", at("0 mm", "0 mm", "2.5 mm")) +
           part("c",
                R"(tube = { outer_radius = "3 mm", inner_radius = "2 mm", height = "5 mm", segments = 9 })"),
       "b"},
      // A box with its edges on the wall of a bore.
      {part("a",
            R"(tube = { outer_radius = "2 mm", inner_radius = "1 mm", height = "5 mm", segments = 12 })") +
           part("b", R"(box = { low = ["-0.6 mm", "-0.8 mm", "1 mm"], high = ["0.6 mm", "0.8 mm", "4 mm"] })",
                "lso_clear"),
       "a"},
      // A ball of almost the radius of the rod around it.
      {part("a", R"(cylinder = { radius = "1 mm", height = "5 mm", segments = 64 })") +
           part("b", R"(sphere = { radius = "0.99 mm", subdivisions = 4 })", "lso_clear",
                at("0 mm", "0 mm", "2.5 mm")),
       "a"},
      // Cones tip to tip, and a rod flush in another on a window.
      {part("a",
            R"(cone = { bottom_radius = "2 mm", top_radius = "0 mm", height = "3 mm", segments = 12 })") +
           part("b",
                R"(cone = { bottom_radius = "0 mm", top_radius = "2 mm", height = "3 mm", segments = 12 })",
                "lso_clear", at("0 mm", "0 mm", "3.01 mm")),
       "a"},
      {part("window", R"(box = { low = ["-3 mm", "-3 mm", "-1 mm"], high = ["3 mm", "3 mm", "0 mm"] })",
            "n15") +
           part("a", R"(cylinder = { radius = "1 mm", height = "5 mm", segments = 12 })") +
           part("b", R"(cylinder = { radius = "0.7 mm", height = "5 mm", segments = 9 })", "lso_clear"),
       "a"},
      // Ten metres away and turned; a micrometre and ten metres wide.
      {part("a", kRod, "n15",
            "rotate = { axis = [1, 2, 3], angle = \"77 deg\" }\n" + at("10 m", "-10 m", "3 m")),
       "a"},
      {part("a", R"(cylinder = { radius = "1 um", height = "1 mm", segments = 12 })"), "a"},
      {part("a", R"(sphere = { radius = "10 m", subdivisions = 3 })") +
           part("b", R"(sphere = { radius = "0.01 mm", subdivisions = 3 })", "lso_clear"),
       "a"}};
  for (const Case& c : cases) {
    CAPTURE(c.parts);
    const SceneSpec spec = spec_of(c.parts, c.first, "[run]\ncontact_tolerance = \"0.001 um\"\n");
    const BuiltScene built = build(spec);
    CHECK(region_of(built, c.first).curved);
    const PhotonSource source(spec.source, built.scene);
    PropagationLimits limits;
    limits.interactions = 3'000;
    for (std::uint64_t i = 0; i < 2'000; ++i) {
      Rng rng(17, StreamKind::photon, i);
      Photon photon = source.emit(built.scene, rng);
      const double size = built.scene.accelerator(region_of(built, c.first)).boundary().size_mm;
      for (bool on_way = true; on_way && photon.interactions < limits.interactions;) {
        const RegionId before = photon.region;
        const Step taken = step(built.scene, photon, rng, limits);
        on_way = !is_final(taken.event);
        // A photon escapes from nowhere but the ambient region, and is where its region is, but for rounding.
        if (taken.event == StepEvent::escaped) REQUIRE(before == kAmbientRegion);
        if (!on_way || photon.region == kAmbientRegion) continue;
        const Region& region = built.scene.regions[photon.region];
        const Vec3 local = region.point_to_local(photon.position);
        const ExactBodies& exact = built.scene.accelerator(region).boundary().exact;
        if (exact.empty()) continue;  // a box
        const ExactBody& body = exact.bodies.front();
        const double rounding = 1e-9 * std::max(1.0, size);
        if (!body.is_convex())
          REQUIRE((exact.contains(body, local) || exact.distance_to_faces(body, local) < rounding));
        for (std::uint32_t q = body.quadrics_begin; body.is_convex() && q < body.quadrics_end; ++q)
          REQUIRE(exact.quadrics[q].surface.distance(local) < rounding);
      }
    }
  }
}

TEST_CASE("Parts overlap where exact bodies do") {
  const auto bore = [](const std::string& radius, const std::string& inner) {
    return part("tile", "tube = { outer_radius = \"3 mm\", inner_radius = \"" + radius +
                            "\", height = \"5 mm\", segments = 12 }") +
           inner;
  };
  const auto ball = [](const std::string& radius) {
    return part("ball", "sphere = { radius = \"" + radius + "\", subdivisions = 4 }", "lso_clear",
                "surface = \"flat\"\ntranslate = [\"0 mm\", \"0 mm\", \"2.5 mm\"]\n");
  };
  const auto rod = [](int segments, const std::string& turn) {
    return part(
        "rod",
        "cylinder = { radius = \"1 mm\", height = \"5 mm\", segments = " + std::to_string(segments) + " }",
        "lso_clear", "surface = \"flat\"\nrotate = { axis = [0, 0, 1], angle = \"" + turn + "\" }\n");
  };
  for (const std::string& apart : {bore("1 mm", ball("1 mm")), bore("1 mm", rod(12, "0 deg")),
                                   bore("1 mm", rod(10, "0 deg")), bore("1 mm", rod(12, "15 deg")),
                                   bore("1.001 mm", rod(10, "0 deg")), bore("1.001 mm", rod(12, "15 deg"))}) {
    CAPTURE(apart);
    const BuiltScene built = build(spec_of(apart, "tile"));
    for (const PartInfo& body : built.scene.parts) CHECK(body.curved);
  }
  for (const std::string& overlapping : {bore("1 mm", ball("1.02 mm")), bore("0.99 mm", rod(12, "15 deg"))}) {
    CAPTURE(overlapping);
    std::string message;
    try {
      build(spec_of(overlapping, "tile"));
    } catch (const InputError& error) {
      message = error.what();
    }
    CHECK(message.find("overlap by") != std::string::npos);
    CHECK(message.find("the same number of segments") != std::string::npos);
  }
  // Facets are as far as they reach where they are traced.
  CHECK_THROWS_AS(build(spec_of(bore("1 mm", ball("1 mm")), "tile", "[run]\ncurved = \"facets\"\n")),
                  InputError);
}

TEST_CASE("A body that would extend into the facets beside it, or into another body, keeps its own") {
  // Facets of a mesh, 0.5 cos(15 deg) = 0.483 mm from the axis, around a core of 0.485 mm.
  const auto folder = scratch_folder("curved_core");
  mesh::write_stl(folder / "tube.stl", [] {
    mesh::TriMesh tube = mesh::make_cylinder(0.5, 4.0, 12);
    return tube;
  }());
  const std::string around = "[[part]]\nname = \"around\"\nmesh = \"" + (folder / "tube.stl").string() +
                             "\"\nunit = \"mm\"\nmedium = \"n15\"\nsurface = \"flat\"\n";
  for (const auto& [radius, exact] : {std::pair{"0.485 mm", false}, std::pair{"0.45 mm", true}}) {
    const BuiltScene built = build(spec_of(around + part("core",
                                                         std::string("cylinder = { radius = \"") + radius +
                                                             "\", height = \"4 mm\", segments = 12 }",
                                                         "lso"),
                                           "core"));
    CHECK((built.scene.parts.begin() + 1)->curved == exact);
    if (!exact) CHECK((built.scene.parts.begin() + 1)->facets_because.find("around") != std::string::npos);
  }
  // A rod that would bulge through the middle of the side of a box, and one that only touches it.
  for (const auto& [at, exact] : {std::pair{"0.95 mm", false}, std::pair{"1 mm", true}}) {
    const BuiltScene built =
        build(spec_of(part("a", R"(cylinder = { radius = "1 mm", height = "3 mm", segments = 6 })", "n15",
                           "surface = \"flat\"\nrotate = { axis = [0, 0, 1], angle = \"30 deg\" }\n") +
                          part("b", std::string(R"(box = { low = [")") + at +
                                        R"(", "-9 mm", "-9 mm"], high = ["3 mm", "9 mm", "9 mm"] })"),
                      "a"));
    CHECK(built.scene.parts.front().curved == exact);
    if (!exact) CHECK(built.scene.parts.front().facets_because.find("\"b\"") != std::string::npos);
  }
  // Two rods whose polygons, turned against each other, are apart, and whose circles are not.
  const std::string rod = R"(cylinder = { radius = "1 mm", height = "3 mm", segments = 6 })";
  for (const auto& [apart, exact] : {std::pair{"1.8 mm", false}, std::pair{"2.001 mm", true}}) {
    const std::string turned = "surface = \"flat\"\nrotate = { axis = [0, 0, 1], angle = \"30 deg\" }\n";
    const BuiltScene built = build(
        spec_of(part("a", rod, "n15", turned) +
                    part("b", rod, "n15", turned + "translate = [\"" + apart + "\", \"0 mm\", \"0 mm\"]\n"),
                "a"));
    CHECK(built.scene.parts.front().curved == exact);
  }
}
