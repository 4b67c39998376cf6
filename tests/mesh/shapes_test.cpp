#include "scintray/mesh/shapes/shapes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "scintray/core/error.hpp"
#include "scintray/mesh/diagnosis.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

std::map<std::string, double> area_by_group(const TriMesh& mesh) {
  std::map<std::string, double> areas;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    areas[mesh.groups[mesh.group[t]]] += mesh.area_vector(t).norm();
  return areas;
}

doctest::Approx exactly(double value) { return doctest::Approx(value).epsilon(1e-12); }

}  // namespace

TEST_CASE("A regular prism has the volume and the sides of its polygon") {
  for (const int n : {3, 4, 6, 17}) {
    CAPTURE(n);
    const TriMesh prism = make_prism(n, 2.0, 5.0);
    const double base = 0.5 * n * 4.0 * std::sin(kTwoPi / n), side = 4.0 * std::sin(kPi / n);
    CHECK(diagnose(prism).sound());
    CHECK(prism.volume() == exactly(5.0 * base));
    const auto areas = area_by_group(prism);
    CHECK(areas.size() == static_cast<std::size_t>(n) + 2);
    CHECK(areas.at("side0") == exactly(5.0 * side));
    CHECK(areas.at("-z") == exactly(base));
    CHECK(areas.at("+z") == exactly(base));
  }
  CHECK_THROWS_AS(make_prism(2, 1.0, 1.0), InputError);
  CHECK_THROWS_AS(make_prism(6, 0.0, 1.0), InputError);
}

TEST_CASE("A chamfered box loses a prism at each edge and keeps trimmed faces") {
  constexpr double a = 3.0, b = 4.0, h = 10.0, c = 0.2;
  const TriMesh box = make_chamfered_box({-1, 0, 2}, {2, 4, 12}, c);
  CHECK(diagnose(box).sound());
  CHECK(diagnose(box).bodies == 1);
  CHECK(box.vertices.size() == 24);
  CHECK(box.triangles.size() == 44);  // V - E + F = 2
  // Edges: right triangles c^2 / 2 along each edge. At a corner three such prisms overlap: inclusion and
  // exclusion with pairs of c^3 / 3 and a triple of c^3 / 4. The corner's triangle x + y + z = 2 c takes the
  // tip of c^3 / 12 that the three bevels leave.
  const double edges = 4.0 * (a + b + h) * 0.5 * c * c;
  const double corners = 8.0 * (1.0 - 1.0 / 4.0 - 1.0 / 12.0) * c * c * c;
  CHECK(box.volume() == exactly(a * b * h - edges + corners));
  const auto areas = area_by_group(box);
  CHECK(areas.at("-z") == exactly((a - 2 * c) * (b - 2 * c)));
  CHECK(areas.at("+x") == exactly((b - 2 * c) * (h - 2 * c)));
  CHECK(areas.at("-y") == exactly((a - 2 * c) * (h - 2 * c)));
  CHECK(areas.at("chamfer") ==
        exactly(4.0 * (a + b + h - 6.0 * c) * std::sqrt(2.0) * c + 8.0 * std::sqrt(3.0) / 4.0 * 2.0 * c * c));
  CHECK_THROWS_AS(make_chamfered_box({0, 0, 0}, {1, 1, 1}, 0.5), InputError);
  CHECK_THROWS_AS(make_chamfered_box({0, 0, 0}, {1, 1, 1}, 0.0), InputError);
}

TEST_CASE("A chamfered hexagonal prism is one sound body with flat bevels") {
  const TriMesh prism = make_prism(6, 2.0, 5.0, 0.3);
  CHECK(diagnose(prism).sound());
  CHECK(prism.volume() < make_prism(6, 2.0, 5.0).volume());
  // The end face is the hexagon whose flats have moved in by the chamfer.
  const double apothem = 2.0 * std::cos(kPi / 6.0) - 0.3;
  CHECK(area_by_group(prism).at("-z") == exactly(6.0 * apothem * apothem * std::tan(kPi / 6.0)));
  CHECK_THROWS_AS(make_prism(6, 2.0, 5.0, 2.0), InputError);
}

TEST_CASE("A frustum between rectangles has the prismatoid's volume, also when oblique") {
  for (const double shift : {0.0, 7.0}) {
    CAPTURE(shift);
    const TriMesh taper = make_tapered({{4.0, 2.0}, {0.0, 0.0}}, {{6.0, 5.0}, {shift, 1.0}}, 9.0);
    CHECK(diagnose(taper).sound());
    // h / 6 (A0 + 4 Am + A1)
    CHECK(taper.volume() == exactly(9.0 / 6.0 * (8.0 + 4.0 * 5.0 * 3.5 + 30.0)));
    const auto areas = area_by_group(taper);
    CHECK(areas.at("-z") == exactly(8.0));
    CHECK(areas.at("+z") == exactly(30.0));
    CHECK(areas.count("+x") == 1);
    for (std::size_t t = 0; t < taper.triangles.size(); ++t)
      if (taper.groups[taper.group[t]] == "+y") CHECK(taper.area_vector(t).y() > 0.0);
  }
  CHECK_THROWS_AS(make_tapered({{1.0, 1.0}, {}}, {{0.0, 1.0}, {}}, 1.0), InputError);
  CHECK_THROWS_AS(make_tapered({{1.0, 1.0}, {}}, {{1.0, 1.0}, {}}, 0.0), InputError);
}

TEST_CASE(
    "A Winston cone is as wide and long as its etendue requires, and its edge rays reach the exit's rim") {
  const double theta = 25.0 * kDegree;
  CHECK(winston_length(2.0, theta) == doctest::Approx((2.0 + 2.0 / std::sin(theta)) / std::tan(theta)));
  const double length = winston_length(2.0, theta);
  CHECK(winston_radius(2.0, theta, 0.0) == doctest::Approx(2.0).epsilon(1e-9));
  CHECK(winston_radius(2.0, theta, length) == doctest::Approx(2.0 / std::sin(theta)).epsilon(1e-9));

  // Edge-ray principle: a ray at the acceptance angle that hits the profile is reflected to the far rim.
  for (const double share : {0.1, 0.5, 0.9}) {
    CAPTURE(share);
    const double z = share * length, step = 1e-5;
    const double r = winston_radius(2.0, theta, z);
    const double slope =
        (winston_radius(2.0, theta, z + step) - winston_radius(2.0, theta, z - step)) / (2.0 * step);
    const Vec3 normal = Vec3(-1.0, 0.0, slope).normalized();
    const Vec3 out = mirror(Vec3(std::sin(theta), 0.0, -std::cos(theta)), normal);
    CHECK(r + out.x() * z / -out.z() == doctest::Approx(-2.0).epsilon(1e-6));
  }

  const TriMesh cone = make_winston({2.0, theta, 0.0, 0.0, 48, 20});
  CHECK(diagnose(cone).sound());
  const auto areas = area_by_group(cone);
  CHECK(areas.at("+z") / areas.at("-z") == doctest::Approx(std::pow(std::sin(theta), -2)).epsilon(1e-9));
  CHECK(areas.size() == 3);
  const TriMesh trough = make_winston({2.0, theta, 5.0, 3.0, 64, 20});
  CHECK(diagnose(trough).sound());
  CHECK(area_by_group(trough).at("-z") == exactly(4.0 * 3.0));
  CHECK(area_by_group(trough).at("+z") ==
        doctest::Approx(2.0 * 3.0 * winston_radius(2.0, theta, 5.0)).epsilon(1e-9));
  CHECK_THROWS_AS(make_winston({2.0, theta, length * 1.01, 0.0, 48, 20}), InputError);
  CHECK_THROWS_AS(make_winston({2.0, 90.0 * kDegree, 0.0, 0.0, 48, 20}), InputError);
  CHECK_THROWS_AS(make_winston({2.0, theta, 0.0, 0.0, 2, 20}), InputError);
}
