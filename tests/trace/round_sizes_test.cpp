// Volumes, areas and boxes of parts with exact round faces, and areas of their contacts.
#include <algorithm>
#include <cmath>

#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "support/curved_scenes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::test;

TEST_CASE("Volumes and areas of hollow and concave parts are those of the exact bodies") {
  const BuiltScene built = build(spec_of(
      part("tube", R"(revolved = { r = ["1 mm", "2 mm", "2 mm", "1 mm"], z = ["0 mm", "0 mm", "5 mm", "5 mm"],
segments = 12 })") +
          part("lens",
               R"(lens = { diameter = "4 mm", thickness = "1 mm", top_radius = "-5 mm", segments = 24 })",
               "n15", "surface = \"flat\"\ntranslate = [\"10 mm\", \"0 mm\", \"0 mm\"]\n"),
      "tube"));
  CHECK(built.scene.parts.front().volume_mm3 == doctest::Approx(kPi * 3.0 * 5.0).epsilon(1e-12));
  double area = 0.0;
  for (const FaceInfo& face : built.scene.faces)
    if (face.name.starts_with("tube:")) area += face.area_mm2;
  CHECK(area == doctest::Approx(2.0 * kPi * 3.0 * 5.0 + 2.0 * kPi * 3.0).epsilon(1e-12));
  const PartInfo& lens = *(built.scene.parts.begin() + 1);
  // A cylinder of the edge's height less the cap of the sphere.
  const double depth = 5.0 - std::sqrt(21.0);
  CHECK(lens.volume_mm3 ==
        doctest::Approx(kPi * 4.0 * (1.0 + depth) - kPi * depth * depth * (5.0 - depth / 3.0)).epsilon(1e-6));
}

TEST_CASE("The box around a part is that of the exact body, cut, hollow or turned") {
  const std::string turn = "surface = \"flat\"\nrotate = { axis = [1, 0, 0], angle = \"30 deg\" }\n";
  struct Case {
    std::string shape, rest;
    Vec3 low, high;
  };
  const double s30 = 0.5, c30 = std::sqrt(0.75), depth = 5.0 - std::sqrt(21.0);
  const std::string flat = "surface = \"flat\"\n";
  for (
      const Case& c :
      {Case{R"(tube = { outer_radius = "2 mm", inner_radius = "1.5 mm", height = "3 mm", segments = 10 })",
            flat,
            {-2, -2, 0},
            {2, 2, 3}},
       Case{R"(cylinder = { radius = "2 mm", height = "3 mm", segments = 10 })",
            turn,
            {-2, -2.0 * c30 - 3.0 * s30, -2.0 * s30},
            {2, 2.0 * c30, 3.0 * c30 + 2.0 * s30}},
       Case{R"(torus = { radius = "3 mm", tube_radius = "1 mm", segments = 16, tube_segments = 12 })",
            turn,
            {-4, -3.0 * c30 - 1.0, -3.0 * s30 - 1.0},
            {4, 3.0 * c30 + 1.0, 3.0 * s30 + 1.0}},
       Case{R"(spheroid = { radius = "1 mm", half_height = "2 mm", subdivisions = 3 })",
            turn,
            {-1, -std::hypot(c30, 2.0 * s30), -std::hypot(s30, 2.0 * c30)},
            {1, std::hypot(c30, 2.0 * s30), std::hypot(s30, 2.0 * c30)}},
       // Concave above, with a bulge below.
       Case{
           R"(lens = { diameter = "4 mm", thickness = "1 mm", bottom_radius = "5 mm", top_radius = "-5 mm", segments = 14 })",
           flat,
           {-2, -2, 0},
           {2, 2, 1.0 + depth}},
       Case{"box = [\"2 mm\", \"4 mm\", \"3 mm\"]\nrounding = \"0.3 mm\"",
            turn,
            {-1.0, -1.7 * c30 - 1.2 * s30 - 0.3, -1.7 * s30 - 1.2 * c30 - 0.3},
            {1.0, 1.7 * c30 + 1.2 * s30 + 0.3, 1.7 * s30 + 1.2 * c30 + 0.3}}}) {
    CAPTURE(c.shape);
    const BuiltScene built = build(spec_of(part("body", c.shape, "n15", c.rest), "body"));
    const PartInfo& body = built.scene.parts.front();
    CHECK(body.curved);
    // A rounded box stands about its middle or on the origin: sizes are compared.
    const Vec3 size = c.high - c.low;
    for (int axis = 0; axis < 3; ++axis)
      CHECK(body.bounds.sizes()[axis] == doctest::Approx(size[axis]).epsilon(1e-9));
  }
}

TEST_CASE("Areas of contacts end on the circles of exact bodies, and faces beside them, too") {
  const BuiltScene built = build(spec_of(
      part("window", R"(box = { low = ["-3 mm", "-3 mm", "-1 mm"], high = ["3 mm", "3 mm", "0 mm"] })") +
          part("cladding", R"(cylinder = { radius = "2 mm", height = "5 mm", segments = 12 })") +
          part("core", R"(cylinder = { radius = "1 mm", height = "5 mm", segments = 9 })", "lso_clear"),
      "core"));
  const auto area = [&](const std::string& back, const std::string& front) {
    double sum = 0.0;
    for (const core::InterfaceId id : built.scene.interfaces.ids()) {
      const Interface& interface = built.scene.interfaces[id];
      const std::string names[] = {built.scene.region_names[interface.back],
                                   built.scene.region_names[interface.front]};
      if ((names[0] == back && names[1] == front) || (names[0] == front && names[1] == back))
        sum += built.scene.interface_area_mm2[id];
    }
    return sum;
  };
  const std::string ambient = built.scene.region_names[kAmbientRegion];
  CHECK(area("core", "window") == doctest::Approx(kPi).epsilon(1e-12));
  CHECK(area("cladding", "window") == doctest::Approx(3.0 * kPi).epsilon(1e-12));
  CHECK(area(ambient, "window") == doctest::Approx(2.0 * 36.0 + 24.0 - 4.0 * kPi).epsilon(1e-12));
  CHECK(area("core", "cladding") == doctest::Approx(10.0 * kPi).epsilon(1e-12));
  CHECK(area("core", ambient) == doctest::Approx(kPi).epsilon(1e-12));
  CHECK(area("cladding", ambient) == doctest::Approx(20.0 * kPi + 3.0 * kPi).epsilon(1e-12));
}

TEST_CASE("Volumes and areas of round parts are those of closed forms, whatever their facets") {
  struct Case {
    std::string shape;
    double volume, area;
  };
  const auto frustum = [](double r, double s, double h) {
    return std::pair{kPi / 3.0 * h * (r * r + r * s + s * s),
                     kPi * (r * r + s * s + (r + s) * std::hypot(h, r - s))};
  };
  std::vector<Case> cases{
      {R"(torus = { radius = "3 mm", tube_radius = "1 mm", segments = 16, tube_segments = 12 })",
       2.0 * kPi * kPi * 3.0, 4.0 * kPi * kPi * 3.0},
      {R"(tube = { outer_radius = "2 mm", inner_radius = "1.5 mm", height = "3 mm", segments = 16 })",
       kPi * 1.75 * 3.0, kTwoPi * 3.5 * 3.0 + kTwoPi * 1.75},
      // Half axes 1 and 2: prolate, with the eccentricity sqrt(3) / 2.
      {R"(spheroid = { radius = "1 mm", half_height = "2 mm", subdivisions = 4 })", 8.0 / 3.0 * kPi,
       kTwoPi * (1.0 + 2.0 / std::sqrt(0.75) * std::asin(std::sqrt(0.75)))},
      {R"(fibre = { radius = "0.5 mm", x = ["0 mm", "0 mm", "6 mm"], z = ["0 mm", "6 mm", "6 mm"],
bend_radius = "3 mm", segments = 16 })",
       kPi * 0.25 * (6.0 + 1.5 * kPi), kPi * (6.0 + 1.5 * kPi) + 0.5 * kPi},
      {"box = [\"2 mm\", \"4 mm\", \"3 mm\"]\nrounding = \"0.3 mm\"",
       1.4 * 3.4 * 2.4 + 0.6 * (1.4 * 3.4 + 3.4 * 2.4 + 2.4 * 1.4) + kPi * 0.09 * (1.4 + 3.4 + 2.4) +
           4.0 / 3.0 * kPi * 0.027,
       2.0 * (1.4 * 3.4 + 3.4 * 2.4 + 2.4 * 1.4) + kTwoPi * 0.3 * (1.4 + 3.4 + 2.4) + 4.0 * kPi * 0.09}};

  // Files of triangles: short cones and discs, and sectors of these about the axis.
  const auto folder = scratch_folder("round_volumes");
  const auto add = [&](const std::string& name, const mesh::TriMesh& made, double volume, double area) {
    const std::filesystem::path path = folder / (name + ".ply");
    mesh::write_ply(path, made);
    cases.push_back(
        {"mesh = \"" + path.string() + "\"\nunit = \"mm\"\ncurved = \"recognize\"", volume, area});
  };
  const auto [volume, area] = frustum(4.0, 3.0, 8.0 / 3.0);
  add("cone", mesh::make_cone(4.0, 3.0, 8.0 / 3.0, 48), volume, area);
  add("tip", mesh::make_cone(3.0, 0.0, 4.0, 48), 12.0 * kPi, kPi * 24.0);
  const auto sector = [](double inner, double outer, double angle, double height, int sides) {
    mesh::TriMesh body;
    const auto n = static_cast<std::uint32_t>(sides + 1);
    for (const double z : {0.0, height})
      for (const double radius : {inner, outer})
        for (std::uint32_t i = 0; i < n; ++i) {
          const double at = angle * i / sides;
          body.vertices.push_back({radius * std::cos(at), radius * std::sin(at), z});
        }
    const auto corner = [&](bool high, bool out, std::uint32_t i) {
      return (high ? 2 * n : 0) + (out ? n : 0) + i;
    };
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      body.triangles.push_back({a, b, c});
      body.triangles.push_back({a, c, d});
    };
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      quad(corner(false, true, i), corner(false, true, i + 1), corner(true, true, i + 1),
           corner(true, true, i));
      quad(corner(false, false, i + 1), corner(false, false, i), corner(true, false, i),
           corner(true, false, i + 1));
      quad(corner(true, false, i), corner(true, true, i), corner(true, true, i + 1),
           corner(true, false, i + 1));
      quad(corner(false, false, i + 1), corner(false, true, i + 1), corner(false, true, i),
           corner(false, false, i));
    }
    quad(corner(false, false, 0), corner(false, true, 0), corner(true, true, 0), corner(true, false, 0));
    quad(corner(true, false, n - 1), corner(true, true, n - 1), corner(false, true, n - 1),
         corner(false, false, n - 1));
    body.group.assign(body.triangles.size(), 0);
    body.groups = {"default"};
    return body;
  };
  add("ring_sector", sector(3.0, 4.0, 0.5 * kPi, 5.0, 18), 0.25 * kPi * 7.0 * 5.0,
      0.5 * kPi * 7.0 * 5.0 + 2.0 * 0.25 * kPi * 7.0 + 2.0 * 5.0);
  for (const Case& known : cases) {
    CAPTURE(known.shape);
    const BuiltScene built = build(spec_of(part("body", known.shape), "body"));
    CHECK(built.scene.parts.front().facets_because == "");
    CHECK(built.scene.parts.front().curved);
    CHECK(built.scene.parts.front().volume_mm3 == doctest::Approx(known.volume).epsilon(1e-9));
    double sum = 0.0;
    for (const FaceInfo& face : built.scene.faces) sum += face.area_mm2;
    CHECK(sum == doctest::Approx(known.area).epsilon(1e-9));
  }
}
