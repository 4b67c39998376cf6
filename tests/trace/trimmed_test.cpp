// Parts that are not convex, with exact round faces: against searches along the ray for where their defining
// functions change sign.
#include <algorithm>
#include <cmath>
#include <functional>

#include "scintray/core/sampling.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/shapes.hpp"
#include "support/curved_scenes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::scene_file;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::test;

namespace {

/// A body by a function that is below zero inside, of slope 1 or less, and the box in which it lies.
struct KnownBody {
  std::string shape;
  std::function<double(const Vec3&)> inside;
  Vec3 low, high;
};

double rho(const Vec3& p) { return std::hypot(p.x(), p.y()); }
double slab(double z, double low, double high) { return std::max(low - z, z - high); }

/// Distance at which the sign of the function changes first, from a start where it is not zero; infinite
/// where it does not within `length`.
double first_change(const std::function<double(const Vec3&)>& f, const Vec3& p, const Vec3& d,
                    double length) {
  const bool inside = f(p) < 0.0;
  double t = 0.0;
  while (t < length) {
    const double here = std::abs(f(p + t * d));
    double next = t + std::max(here, 1e-4);
    if ((f(p + next * d) < 0.0) != inside) {
      double low = t, high = next;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        ((f(p + middle * d) < 0.0) == inside ? low : high) = middle;
      }
      return high;
    }
    t = next;
  }
  return HUGE_VAL;
}

std::vector<KnownBody> known_bodies() {
  std::vector<KnownBody> bodies;
  for (const int segments : {12, 72})
    bodies.push_back(
        {fmt::format("revolved = {{ r = [\"1 mm\", \"2 mm\", \"2 mm\", \"1 mm\"], z = [\"0 mm\", "
                     "\"0 mm\", \"5 mm\", \"5 mm\"], segments = {} }}",
                     segments),
         [](const Vec3& p) {
           return std::max({rho(p) - 2.0, 1.0 - rho(p), slab(p.z(), 0.0, 5.0)});
         },
         {-2, -2, 0},
         {2, 2, 5}});
  // A stepped drum with a conical bore that widens.
  bodies.push_back({R"(revolved = { r = ["0.5 mm", "3 mm", "3 mm", "2 mm", "2 mm", "1.5 mm"],
z = ["0 mm", "0 mm", "2 mm", "2 mm", "4 mm", "4 mm"], segments = 16 })",
                    [](const Vec3& p) {
                      const double r = rho(p);
                      const double drum = std::min(std::max(r - 3.0, slab(p.z(), 0.0, 2.0)),
                                                   std::max(r - 2.0, slab(p.z(), 0.0, 4.0)));
                      return std::max(drum, (0.5 + 0.25 * p.z() - r) / std::hypot(1.0, 0.25));
                    },
                    {-3, -3, 0},
                    {3, 3, 4}});
  // Lenses: one side concave, both sides, and a meniscus.
  const auto sphere = [](const Vec3& p, double z, double r) { return (p - Vec3(0, 0, z)).norm() - r; };
  bodies.push_back(
      {R"(lens = { diameter = "4 mm", thickness = "1 mm", top_radius = "-5 mm", segments = 24 })",
       [=](const Vec3& p) {
         return std::max({rho(p) - 2.0, -p.z(), p.z() - 3.0, -sphere(p, 6.0, 5.0)});
       },
       {-2, -2, 0},
       {2, 2, 1.5}});
  bodies.push_back(
      {R"(lens = { diameter = "4 mm", thickness = "0.7 mm", bottom_radius = "-3 mm",
top_radius = "-5 mm", segments = 24 })",
       [=](const Vec3& p) {
         return std::max({rho(p) - 2.0, slab(p.z(), -3.0, 3.0), -sphere(p, 5.7, 5.0), -sphere(p, -3.0, 3.0)});
       },
       {-2, -2, -1},
       {2, 2, 1.5}});
  bodies.push_back({R"(lens = { diameter = "4 mm", thickness = "0.7 mm", bottom_radius = "-5 mm",
top_radius = "4 mm", segments = 24 })",
                    [=](const Vec3& p) {
                      return std::max({rho(p) - 2.0, p.z() - 0.7, sphere(p, 0.7 - 4.0, 4.0), -p.z() - 3.0,
                                       -sphere(p, -5.0, 5.0)});
                    },
                    {-2, -2, -1},
                    {2, 2, 0.7}});
  const auto add = [&](const std::string& shape, const Vec3& low, const Vec3& high,
                       std::function<double(const Vec3&)> inside) {
    bodies.push_back({shape, std::move(inside), low, high});
  };
  add(R"(tube = { outer_radius = "2 mm", inner_radius = "1.9 mm", height = "5 mm", segments = 64 })",
      {-2, -2, 0}, {2, 2, 5}, [](const Vec3& p) {
        return std::max({rho(p) - 2.0, 1.9 - rho(p), slab(p.z(), 0.0, 5.0)});
      });
  add(R"(torus = { radius = "2 mm", tube_radius = "0.8 mm", segments = 24, tube_segments = 12 })",
      {-3, -3, -1}, {3, 3, 1}, [](const Vec3& p) { return std::hypot(rho(p) - 2.0, p.z()) - 0.8; });
  add("box = [\"2 mm\", \"4 mm\", \"3 mm\"]\nrounding = \"0.3 mm\"", {-1, -2, 0}, {1, 2, 3},
      [](const Vec3& p) {
        const Vec3 beyond = (p - Vec3(0, 0, 1.5)).cwiseAbs() - Vec3(0.7, 1.7, 1.2);
        return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0) - 0.3;
      });
  add(R"(lens = { diameter = "4 mm", thickness = "1 mm", bottom_radius = "-3 mm", bottom_conic = -2.5,
segments = 24 })",
      {-2, -2, -1}, {2, 2, 1}, [](const Vec3& p) {
        return std::max({rho(p) - 2.0, p.z() - 1.0, -p.z() - mesh::sagitta(3.0, rho(p), -2.5)});
      });
  const auto bent = [](const Vec3& p, auto section) {
    const Vec3 q = p - Vec3(4, 0, 6);
    const double r = std::hypot(q.x(), q.z());
    return std::min({std::max(section(p.x(), p.y()), slab(p.z(), 0.0, 6.0)),
                     std::max(section(p.z() - 10.0, p.y()), slab(p.x(), 4.0, 10.0)),
                     std::max({section(r - 4.0, q.y()), q.x(), -q.z()})});
  };
  const std::string path = R"(x = ["0 mm", "0 mm", "10 mm"], z = ["0 mm", "10 mm", "10 mm"],
bend_radius = "4 mm", segments = 24 })";
  add("fibre = { radius = \"1 mm\", " + path, {-1, -1, 0}, {10, 1, 11},
      [=](const Vec3& p) { return bent(p, [](double u, double v) { return std::hypot(u, v) - 1.0; }); });
  add("fibre = { side = \"1 mm\", " + path, {-1, -1, 0}, {10, 1, 11}, [=](const Vec3& p) {
    return bent(p, [](double u, double v) { return std::max(std::abs(u), std::abs(v)) - 0.5; });
  });
  return bodies;
}

}  // namespace

TEST_CASE("Hollow and concave parts are left and entered where their surface is, whatever their facets") {
  const auto is_inside_behind = [](const KnownBody& body, const Vec3& p, const Vec3& d, double distance_mm) {
    for (int i = 1; i <= 1000; ++i)
      if (body.inside(p + (distance_mm + 1e-5 * i) * d) < 0.0) return true;
    return false;
  };
  for (const KnownBody& body : known_bodies()) {
    CAPTURE(body.shape);
    const SceneSpec spec = spec_of(part("body", body.shape), "body");
    const BuiltScene built = build(spec);
    const Region &region = region_of(built, "body"), &ambient = built.scene.regions[kAmbientRegion];
    CHECK(built.scene.parts.front().facets_because == "");
    REQUIRE(built.scene.parts.front().curved);
    const double size = (body.high - body.low).norm();
    int inside = 0, entered = 0;
    for (std::uint64_t i = 0; i < 6'000; ++i) {
      Rng rng(7, StreamKind::other, i);
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = body.low[axis] + rng.uniform() * (body.high[axis] - body.low[axis]);
      const Vec3 d = sample_isotropic(rng);
      const double here = body.inside(p);
      if (std::abs(here) < 1e-6) continue;
      CHECK(built.scene.region_contains(region_id_of(built, "body"), p) == (here < 0.0));
      const double expected = first_change(body.inside, p, d, 2.0 * size);
      const Exit exit = built.scene.find_exit(here < 0.0 ? region : ambient, p, d);
      if (here >= 0.0 && expected > 2.0 * size) {
        // The search by steps may pass over a short chord: then the ray is inside behind the exit.
        if (exit.triangle != kNoTriangle) CHECK(is_inside_behind(body, p, d, exit.distance_mm));
        continue;
      }
      REQUIRE(exit.triangle != kNoTriangle);
      // A ray that touches the body over less than a step of the search is found by formula alone.
      if (std::abs(exit.distance_mm - expected) > 1e-9) {
        const double beyond = body.inside(p + (exit.distance_mm + 1e-7) * d);
        CHECK(std::abs(beyond) < 1e-6);
        continue;
      }
      CHECK_FALSE(exit.resolved);
      const Vec3 normal =
          built.scene.normal_at(here < 0.0 ? region : ambient, exit.triangle, p + exit.distance_mm * d);
      CHECK(normal.dot(d) > 0.0);
      (here < 0.0 ? inside : entered) += 1;
    }
    CHECK(inside > 300);
    CHECK(entered > 40);
  }
}

TEST_CASE("Holes, dimples and grooves that a part of higher priority cuts are exact") {
  // A drilled hole with a conical tip, a spherical dimple, and a groove across.
  const auto tool = [](const std::string& name, const std::string& shape, const std::string& place) {
    return "[[part]]\nname = \"" + name + "\"\n" + in_one_line(shape) +
           "\nmedium = \"vacuum_n1\"\nsurface = \"flat\"\npriority = 2\n" + place;
  };
  const std::string parts =
      part("block", R"(box = { low = ["-5 mm", "-3 mm", "0 mm"], high = ["5 mm", "3 mm", "4 mm"] })") +
      tool("drill",
           R"(revolved = { r = ["0 mm", "1 mm", "1 mm", "0 mm"], z = ["0 mm", "0.5 mm", "6 mm", "6 mm"],
segments = 20 })",
           "translate = [\"-3 mm\", \"0 mm\", \"1 mm\"]\n") +
      tool("dimple", R"(sphere = { radius = "1.2 mm", subdivisions = 6 })",
           "translate = [\"0.1 mm\", \"0.2 mm\", \"4.4 mm\"]\n") +
      tool("groove", R"(cylinder = { radius = "0.8 mm", height = "8 mm", segments = 24 })",
           "rotate = { axis = [1, 0, 0], angle = \"90 deg\" }\n"
           "translate = [\"3 mm\", \"4 mm\", \"4.2 mm\"]\n");
  const BuiltScene built = build(spec_of(parts, "block"));
  CHECK(built.scene.parts.front().facets_because == "");
  REQUIRE(built.scene.parts.front().curved);
  const auto inside = [](const Vec3& p) {
    const double box = std::max({std::abs(p.x()) - 5.0, std::abs(p.y()) - 3.0, slab(p.z(), 0.0, 4.0)});
    const double r = std::hypot(p.x() + 3.0, p.y());
    const double drill = std::max(r - 1.0, (r - 2.0 * (p.z() - 1.0)) / std::sqrt(5.0));
    const double dimple = (p - Vec3(0.1, 0.2, 4.4)).norm() - 1.2;
    const double groove = std::hypot(p.x() - 3.0, p.z() - 4.2) - 0.8;
    return std::max({box, -drill, -dimple, -groove});
  };
  std::uint64_t seen = 0;
  for (std::uint64_t i = 0; i < 5'000; ++i) {
    Rng rng(8, StreamKind::other, i);
    const Vec3 p(10.0 * rng.uniform() - 5.0, 6.0 * rng.uniform() - 3.0, 4.0 * rng.uniform());
    const Vec3 d = sample_isotropic(rng);
    if (!(inside(p) < -1e-6)) continue;
    const Exit exit = built.scene.find_exit(region_of(built, "block"), p, d);
    const double expected = first_change(inside, p, d, 20.0);
    REQUIRE(exit.triangle != kNoTriangle);
    if (std::abs(exit.distance_mm - expected) > 1e-7)
      CHECK(std::abs(inside(p + (exit.distance_mm + 1e-7) * d)) < 1e-6);
    ++seen;
  }
  CHECK(seen > 3'000);
  // Below the tip, within the bulge of the cone's facets, where its other nappe has no wall.
  for (const double below : {0.001, 0.003, 0.01}) {
    const Vec3 p(-2.5, 0.0, 1.0 - below);
    const Exit exit = built.scene.find_exit(region_of(built, "block"), p, Vec3(-1, 0, 0));
    CHECK(exit.distance_mm == doctest::Approx(2.5).epsilon(1e-9));
    CHECK_FALSE(exit.resolved);
  }
}

TEST_CASE("Nothing is lost in hollow, bent and rounded parts, tiny, huge, turned or far away") {
  struct Case {
    std::string parts, first;
  };
  const std::string path = R"(x = ["0 mm", "0 mm", "8 mm", "8 mm"], y = ["0 mm", "0 mm", "0 mm", "9 mm"],
z = ["0 mm", "9 mm", "9 mm", "9 mm"], bend_radius = "3 mm", segments = 16 })";
  const auto fibre = [&](const std::string& name, const std::string& radius, const std::string& medium) {
    return part(name, "fibre = { radius = \"" + radius + "\", " + path, medium);
  };
  const std::string far =
      "surface = \"flat\"\nrotate = { axis = [1, 2, 3], angle = \"77 deg\" }\n"
      "translate = [\"10 m\", \"-10 m\", \"3 m\"]\n";
  const std::vector<Case> cases{
      // A fibre with two claddings, flush at both ends, round two bends in different planes.
      {fibre("outer", "1 mm", "n15") + fibre("inner", "0.9 mm", "n16") +
           fibre("core", "0.8 mm", "lso_clear") +
           "[media.n16]\nindex = { n = 1.6 }\nabsorption = { none = true }\nscattering = { none = true }\n",
       "core"},
      // A ball of nearly the radius of the tube around it, and a thin torus about both.
      {part("tube",
            R"(tube = { outer_radius = "2 mm", inner_radius = "1 mm", height = "5 mm", segments = 32 })") +
           part("ball", R"(sphere = { radius = "0.99 mm", subdivisions = 24 })", "lso_clear",
                "surface = \"flat\"\ntranslate = [\"0 mm\", \"0 mm\", \"2.5 mm\"]\n") +
           part("ring",
                R"(torus = { radius = "3 mm", tube_radius = "1 um", segments = 48, tube_segments = 8 })",
                "n15", "surface = \"flat\"\ntranslate = [\"0 mm\", \"0 mm\", \"2.5 mm\"]\n"),
       "tube"},
      // A rod in the bore of a tube, which it fills: one surface; on a window.
      {part("tube",
            R"(tube = { outer_radius = "2 mm", inner_radius = "1 mm", height = "5 mm", segments = 32 })") +
           part("rod", R"(cylinder = { radius = "1 mm", height = "5 mm", segments = 32 })", "lso_clear") +
           part("window", R"(box = { low = ["-3 mm", "-3 mm", "-1 mm"], high = ["3 mm", "3 mm", "0 mm"] })",
                "n15"),
       "rod"},
      {part("a", "box = [\"3 mm\", \"3 mm\", \"20 mm\"]\nrounding = \"0.2 mm\"", "n15", far), "a"},
      {part("a",
            R"(tube = { outer_radius = "2 mm", inner_radius = "1.999 mm", height = "9 mm", segments = 200 })",
            "n15", far),
       "a"},
      {part("a",
            R"(tube = { outer_radius = "2 um", inner_radius = "1 um", height = "0.1 mm", segments = 12 })"),
       "a"},
      {part("a", R"(torus = { radius = "10 m", tube_radius = "3 m", segments = 24, tube_segments = 12 })"),
       "a"}};
  for (const Case& c : cases) {
    CAPTURE(c.parts);
    const SceneSpec spec = spec_of(c.parts, c.first, "[run]\ncontact_tolerance = \"0.0001 um\"\n");
    const BuiltScene built = build(spec);
    for (const PartInfo& info : built.scene.parts) CHECK(info.facets_because == "");
    CHECK(region_of(built, c.first).curved);
    const PhotonSource source(spec.source, built.scene);
    PropagationLimits limits;
    limits.interactions = 500;
    std::uint64_t steps = 0, resolved = 0;
    for (std::uint64_t i = 0; i < 600; ++i) {
      Rng rng(19, StreamKind::photon, i);
      Photon photon = source.emit(built.scene, rng);
      for (bool on_way = true; on_way && photon.interactions < limits.interactions;) {
        const RegionId before = photon.region;
        const Step taken = step(built.scene, photon, rng, limits);
        on_way = !is_final(taken.event);
        steps += taken.segments;
        resolved += taken.resolved;
        if (taken.event == StepEvent::escaped) REQUIRE(before == kAmbientRegion);
        if (!on_way || photon.region == kAmbientRegion) continue;
        // The photon is where its region is, but for rounding.
        const Region& region = built.scene.regions[photon.region];
        const ExactBodies& exact = built.scene.accelerator(region).boundary().exact;
        const Vec3 local = region.point_to_local(photon.position);
        const ExactBody& body = exact.bodies.front();
        if (body.is_convex() || exact.contains(body, local)) continue;
        const double size = (body.high - body.low.vec()).norm();
        REQUIRE(exact.distance_to_faces(body, local) < 1e-9 * size + 1e-8);
      }
    }
    CHECK(steps > 1'000);
    CHECK(static_cast<double>(resolved) < 1e-4 * static_cast<double>(steps));
  }
}

TEST_CASE("Total reflections round a bend and in a bore keep to the walls over 2e5 of them") {
  const std::string tube =
      R"(tube = { outer_radius = "2 mm", inner_radius = "1 mm", height = "20 mm", segments = 12 })";
  const SceneSpec spec = spec_of(part("body", tube), "body");
  const BuiltScene built = build(spec);
  // One that is reflected by the outer wall alone, and one by both walls.
  for (const auto& [position, direction] :
       {std::pair{Vec3(1.9, 0, 3), Vec3(0, 1, 0.1)}, std::pair{Vec3(1.5, 0, 3), Vec3(-0.6, 0.38, 0.7)}}) {
    Photon photon = photon_in(built, spec, position, direction);
    const Vec3 turn = photon.position.vec().cross(photon.ray.direction.vec());
    const double along = photon.ray.direction.z();
    PropagationLimits limits;
    limits.interactions = 200'000;
    Rng rng(1, StreamKind::photon, 1);
    CHECK(step(built.scene, photon, rng, limits).event == StepEvent::reflected);
    CHECK(photon.interactions == 200'000);
    const Vec3 turned = photon.position.vec().cross(photon.ray.direction.vec());
    CHECK(std::abs(turned.z() - turn.z()) < 1e-8);
    CHECK(std::abs(std::abs(photon.ray.direction.z()) - std::abs(along)) < 1e-8);
  }
}

namespace {

/// A face of one cell whose many trims are holes in a box of 40 x 40 mm2.
TrimmedFace face_with_holes(ExactBodies& exact, bool flat) {
  const auto add = [&](const Trim& trim) { exact.trims.push_back(trim); };
  const auto hole = [&](const mesh::SupportSurface& surface) {
    add({Vec3(Vec3::Zero()), 0.0, static_cast<std::uint32_t>(exact.trim_surfaces.size()), true});
    exact.trim_surfaces.push_back(surface);
  };
  for (const Vec3& side : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    add({side, 20.0, kNoSurface, false});
  for (int i = 0; i < 16; ++i)
    hole(mesh::SupportSurface::cylinder({-15.0 + 10.0 * (i / 4), -15.0 + 10.0 * (i % 4), 0.0},
                                        Vec3(0.0, 0.1 * i, 1.0), 1.0 + 0.1 * i));
  hole(mesh::SupportSurface::sphere({0.0, 0.0, 1.0}, 2.0));
  hole(mesh::SupportSurface::cone({10.0, 0.0, 0.0}, Vec3::UnitX(), 1.0, 3.0, 8.0));
  hole(mesh::SupportSurface::torus({-10.0, 0.0, 0.0}, Vec3::UnitZ(), 2.0, 0.5));
  hole(mesh::SupportSurface::torus({0.0, -10.0, 0.0}, Vec3(0.0, 1.0, 1.0).normalized(), 1.2, 0.36));
  TrimmedFace face;
  face.low = Vec3(-20.0, -20.0, flat ? 2.0 : -3.0);
  face.high = Vec3(20.0, 20.0, flat ? 2.0 : 3.0);
  face.trims_end = static_cast<std::uint32_t>(exact.trims.size());
  return face;
}

}  // namespace

TEST_CASE("A support surface's function changes by no more than its bound, on its axis as beside it") {
  const Vec3 origin(0.3, -0.2, 0.1), axis = Vec3(1.0, 2.0, 3.0).normalized();
  const std::vector<mesh::SupportSurface> surfaces{
      mesh::SupportSurface::sphere(origin, 2.0),
      mesh::SupportSurface::cylinder(origin, axis, 1.5),
      mesh::SupportSurface::cone(origin, axis, 1.0, 3.0, 4.0),
      mesh::SupportSurface::spheroid(origin, axis, 1.0, 3.0),
      mesh::SupportSurface::quadric(origin, axis, 0.0, 0.7, 1.0),
      mesh::SupportSurface::quadric(origin, axis, -0.5, 0.2, 2.0),
      mesh::SupportSurface::torus(origin, axis, 2.0, 0.5)};
  Rng rng(22, StreamKind::photon, 0);
  double largest_share = 0.0;
  for (const mesh::SupportSurface& surface : surfaces) {
    CAPTURE(surface.name());
    for (int i = 0; i < 20'000; ++i) {
      const Vec3 at = i % 4 == 0   ? Vec3(origin + (6.0 * rng.uniform() - 3.0) * axis)
                      : i % 4 == 1 ? origin
                                   : Vec3(origin + 4.0 * rng.uniform() * sample_isotropic(rng));
      const double within = 2.0 * rng.uniform();
      const Vec3 other = at + (i % 2 == 0 ? 1.0 : rng.uniform()) * within * sample_isotropic(rng);
      const double change = std::abs(surface.value(other) - surface.value(at));
      const double bound = surface.most_change(at, within);
      CHECK(change <= bound * (1.0 + 1e-12) + 1e-12);
      largest_share = std::max(largest_share, change / bound);
    }
  }
  CHECK(largest_share > 0.9);  // no wider than it has to be
}

TEST_CASE("The grid of a face with many trims answers as they do") {
  for (const bool flat : {true, false}) {
    CAPTURE(flat);
    ExactBodies exact;
    TrimmedFace face = face_with_holes(exact, flat);
    const TrimmedFace without = face;
    exact.build_trim_grid(face);
    REQUIRE(face.grid != kNoSurface);
    // Few are left to be tested, and some boxes are beyond the face.
    const double asked = static_cast<double>(exact.asked_trims.size()), boxes = exact.trim_boxes.size();
    CHECK(asked < 3.0 * boxes);
    CHECK(std::any_of(exact.trim_boxes.begin(), exact.trim_boxes.end(),
                      [](const TrimBox& box) { return box.begin == kNoSurface; }));
    Rng rng(21, StreamKind::photon, 0);
    int within = 0, different = 0;
    for (int i = 0; i < 200'000; ++i) {
      Vec3 point(42.0 * rng.uniform() - 21.0, 42.0 * rng.uniform() - 21.0,
                 flat ? 2.0 : 6.2 * rng.uniform() - 3.1);
      if (i % 2 == 0) {  // next to the edge of a hole
        const mesh::SupportSurface& surface =
            exact.trim_surfaces[static_cast<std::size_t>(i / 2) % exact.trim_surfaces.size()];
        for (int step = 0; step < 3; ++step) point += surface.correction(point);
        point += 1e-9 * core::sample_isotropic(rng);
      }
      const bool expected = exact.is_within(without, point);
      within += expected;
      different += exact.is_within(face, point) != expected;
    }
    CHECK(different == 0);
    CHECK(within > 50'000);
    CHECK(within < 180'000);
  }
}
