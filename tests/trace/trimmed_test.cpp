// Parts that are not convex, with exact round faces: against searches along the ray for where their defining
// functions change sign.
#include <algorithm>
#include <cmath>
#include <functional>

#include "scintray/core/sampling.hpp"
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
  return bodies;
}

}  // namespace

TEST_CASE("Hollow and concave parts are left and entered where their surface is, whatever their facets") {
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
        CHECK(exit.triangle == kNoTriangle);
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
    CHECK(inside > 500);
    CHECK(entered > 300);
  }
}

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
