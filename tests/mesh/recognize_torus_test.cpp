// Tori recognized in triangles, and what is not one.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scintray/core/rng.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/recognize.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/mesh/shapes/shapes.hpp"
#include "scintray/mesh/shapes/solids.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;

namespace {

using TorusOutline = std::vector<Eigen::Vector2d>;

constexpr double kTorusTolerance = 1e-6;  // mm

/// The triangles alone, turned and moved: what a file of triangles states.
TriMesh triangles_of(const TriMesh& shape) {
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.rotate(Eigen::AngleAxisd(1.1, Vec3(0.3, 2.0, -0.5).normalized()));
  motion.translation() = Vec3(-4.0, 11.0, 2.5);
  TriMesh result = transformed(shape, motion);
  result.supports.clear();
  result.support.clear();
  return result;
}

/// Part of a turn, or all of it, of a full tube about a circle of radius 5 mm.
TriMesh bend(double tube_mm, double extent_rad, int segments, int tube_segments) {
  TorusOutline circle;
  for (int i = 0; i < tube_segments; ++i) {
    const double angle = kTwoPi * i / tube_segments;
    circle.emplace_back(5.0 + tube_mm * std::cos(angle), tube_mm * std::sin(angle));
  }
  return revolved(circle, {0.3, extent_rad, segments});
}

/// The same of a tube with a hole.
TriMesh hollow_bend(double inner, double outer, double extent_rad, int segments, int tube_segments) {
  const bool full = extent_rad >= kTwoPi;
  return mapped_cube({segments, tube_segments, 1}, {full, true, false}, [&](const Vec3& at) {
    const double phi = 0.3 + at.x() * extent_rad, angle = kTwoPi * at.y();
    const double r = inner + at.z() * (outer - inner), rho = 5.0 + r * std::cos(angle);
    return Vec3(rho * std::cos(phi), rho * std::sin(phi), r * std::sin(angle));
  });
}

/// What was found has these radii, of the tori alone.
void check_torus(const TriMesh& mesh, const RecognizedFace& face, double major, double minor,
                 double within = 1e-7) {
  const SupportSurface& surface = mesh.supports[face.support];
  CHECK(std::string(surface.name()) == "torus");
  CHECK(surface.major == doctest::Approx(major).epsilon(within));
  CHECK(std::sqrt(surface.radius2) == doctest::Approx(minor).epsilon(within));
}

bool has_torus(const TriMesh& mesh) {
  return std::any_of(mesh.supports.begin(), mesh.supports.end(),
                     [](const SupportSurface& surface) { return surface.is_torus(); });
}

std::size_t facets_left(const TriMesh& mesh) {
  if (mesh.support.empty()) return mesh.triangles.size();
  return static_cast<std::size_t>(std::count(mesh.support.begin(), mesh.support.end(), kNoSupport));
}

/// Every corner moved by up to `most_mm` along each axis.
void make_noisy(TriMesh& mesh, double most_mm) {
  Rng rng(3, StreamKind::photon, 1);
  for (Vec3& vertex : mesh.vertices)
    vertex += most_mm * (2.0 * Vec3(rng.uniform(), rng.uniform(), rng.uniform()) - Vec3::Ones());
}

}  // namespace

TEST_CASE("A full torus of triangles is recognized, coarse or fine") {
  // Facets of 12 sections are at up to 30.9 degrees to each other round a tube of 12 sides.
  for (const auto& sides :
       {std::pair{12, 14}, std::pair{13, 17}, std::pair{72, 36}, std::pair{24, 72}, std::pair{200, 100}})
    for (const double minor : {0.02, 1.0, 4.5}) {
      const int segments = sides.first, tube_segments = sides.second;
      CAPTURE(segments);
      CAPTURE(tube_segments);
      CAPTURE(minor);
      TriMesh mesh = triangles_of(make_torus({5.0, minor, segments, tube_segments}));
      const std::vector<RecognizedFace> found = recognize_round_faces(mesh, kTorusTolerance);
      REQUIRE(found.size() == 1);
      check_torus(mesh, found[0], 5.0, minor);
      CHECK(found[0].corner_distance_mm < 1e-9);
      CHECK(facets_left(mesh) == 0);
    }
  TriMesh mesh = triangles_of(make_torus({5.0, 1.0, 24, 16}));
  const std::vector<RecognizedFace> found = recognize_round_faces(mesh, kTorusTolerance);
  REQUIRE(found.size() == 1);
  CHECK(describe(mesh, found[0]).find("torus of radii 5 mm and 1 mm recognized in 768 triangles") == 0);
  const SupportSurface& surface = mesh.supports[0];
  const Eigen::AngleAxisd turn(1.1, Vec3(0.3, 2.0, -0.5).normalized());
  CHECK((surface.origin.vec() - Vec3(-4.0, 11.0, 2.5)).norm() < 1e-9);
  CHECK(std::abs(surface.axis.dot(turn * Vec3(Vec3::UnitZ()))) == doctest::Approx(1.0).epsilon(1e-12));
}

TEST_CASE("Sectors of a torus are recognized, full and hollow ones, and their ends stay flat") {
  for (const double extent : {0.05, 0.5, 0.5 * kPi, kPi, 5.0})
    for (const double step_deg : {5.0, 15.0, 30.0}) {
      const int segments = std::max(2, static_cast<int>(std::ceil(extent / (step_deg * kDegree) - 1e-9)));
      CAPTURE(extent);
      CAPTURE(segments);
      TriMesh full = triangles_of(bend(1.0, extent, segments, 72));
      std::vector<RecognizedFace> found = recognize_round_faces(full, kTorusTolerance);
      REQUIRE(found.size() == 1);
      check_torus(full, found[0], 5.0, 1.0);
      CHECK(found[0].triangles == 2 * 72 * static_cast<std::size_t>(segments));

      TriMesh hollow = triangles_of(hollow_bend(0.5, 1.5, extent, segments, 36));
      found = recognize_round_faces(hollow, kTorusTolerance);
      REQUIRE(found.size() == 2);
      const bool wide_first = hollow.supports[found[0].support].radius2 > 1.0;
      check_torus(hollow, found[wide_first ? 0 : 1], 5.0, 1.5);
      check_torus(hollow, found[wide_first ? 1 : 0], 5.0, 0.5);
      for (const RecognizedFace& face : found)
        CHECK(face.triangles == 2 * 36 * static_cast<std::size_t>(segments));
      CHECK(facets_left(hollow) == 2 * 2 * 36);
    }
}

TEST_CASE("A bent tube of one segment determines no torus, and is not the sphere through its two sections") {
  TriMesh wedge = triangles_of(bend(1.0, 0.05, 1, 72));
  for (const RecognizedFace& face : recognize_round_faces(wedge, kTorusTolerance)) {
    CHECK(std::string(wedge.supports[face.support].name()) == "cylinder");  // within the tolerance
    CHECK(face.triangles < 2 * 72 / 4);
  }
}

TEST_CASE("A torus of irregular triangles is recognized") {
  // Corners anywhere on the torus, near those of a grid, and diagonals either way.
  constexpr std::uint32_t kAlong = 60, kAround = 30;
  TriMesh mesh;
  Rng rng(5, StreamKind::photon, 1);
  for (std::uint32_t i = 0; i < kAlong; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const double phi = kTwoPi * (i + 0.4 * rng.uniform()) / kAlong;
      const double angle = kTwoPi * (j + 0.4 * rng.uniform()) / kAround;
      const double rho = 5.0 + 2.0 * std::cos(angle);
      mesh.vertices.emplace_back(rho * std::cos(phi), rho * std::sin(phi), 2.0 * std::sin(angle));
    }
  for (std::uint32_t i = 0; i < kAlong; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const std::uint32_t next = (i + 1) % kAlong, above = (j + 1) % kAround;
      const std::uint32_t a = i * kAround + j, b = next * kAround + j, c = next * kAround + above,
                          d = i * kAround + above;
      if (rng.uniform() < 0.5) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  mesh.group.assign(mesh.triangles.size(), 0);
  mesh.groups = {"default"};
  TriMesh turned = triangles_of(mesh);
  const std::vector<RecognizedFace> found = recognize_round_faces(turned, kTorusTolerance);
  REQUIRE(found.size() == 1);
  check_torus(turned, found[0], 5.0, 2.0);
  CHECK(facets_left(turned) == 0);
}

TEST_CASE("Fillets are tori between cylinders and planes: a disc and a rod with rounded rims") {
  for (const double height : {1.0, 20.0}) {
    CAPTURE(height);
    TorusOutline outline{{0.0, 0.0}};
    for (int i = 0; i <= 8; ++i) {
      const double angle = 0.5 * kPi * i / 8;
      outline.emplace_back(3.0 + 0.4 * std::sin(angle), 0.4 - 0.4 * std::cos(angle));
    }
    for (int i = 0; i <= 8; ++i) {
      const double angle = 0.5 * kPi * i / 8;
      outline.emplace_back(3.0 + 0.4 * std::cos(angle), height - 0.4 + 0.4 * std::sin(angle));
    }
    outline.emplace_back(0.0, height);
    TriMesh mesh = triangles_of(revolved(outline, {0.0, kTwoPi, 72}));
    const std::vector<RecognizedFace> found = recognize_round_faces(mesh, kTorusTolerance);
    REQUIRE(found.size() == 3);
    int tori = 0;
    for (const RecognizedFace& face : found) {
      if (!mesh.supports[face.support].is_torus()) {
        CHECK(std::string(mesh.supports[face.support].name()) == "cylinder");
        CHECK(face.triangles == 2 * 72);
        continue;
      }
      ++tori;
      check_torus(mesh, face, 3.0, 0.4);
      CHECK(face.triangles == 2 * 72 * 8);
    }
    CHECK(tori == 2);
  }
}

TEST_CASE(
    "A sector of a torus in single precision, as STL has it, is recognized within the contact tolerance") {
  const auto path = test::scratch_folder("recognized_torus") / "bend.stl";
  TriMesh shape = hollow_bend(0.5, 1.5, 0.5 * kPi, 18, 36);
  translate(shape, {100.0, 200.0, 50.0});
  write_stl(path, shape);
  TriMesh mesh = import_mesh(path, 1.0).mesh;
  const std::vector<RecognizedFace> found = recognize_round_faces(mesh, 1e-4);
  REQUIRE(found.size() == 2);
  const bool wide_first = mesh.supports[found[0].support].radius2 > 1.0;
  check_torus(mesh, found[wide_first ? 0 : 1], 5.0, 1.5, 1e-5);
  check_torus(mesh, found[wide_first ? 1 : 0], 5.0, 0.5, 1e-5);
  for (const RecognizedFace& face : found) CHECK(face.corner_distance_mm < 4e-5);
}

TEST_CASE("What is no torus, or not within the tolerance, is not recognized as one") {
  TriMesh noisy = triangles_of(make_torus({5.0, 1.0, 72, 36}));
  make_noisy(noisy, 1e-3);
  TriMesh within = noisy;
  CHECK(recognize_round_faces(noisy, kTorusTolerance).empty());
  const std::vector<RecognizedFace> found = recognize_round_faces(within, 2e-3);
  REQUIRE(found.size() == 1);
  check_torus(within, found[0], 5.0, 1.0, 1e-3);
  CHECK(found[0].corner_distance_mm > 1e-4);
  CHECK(found[0].corner_distance_mm <= 2e-3);

  // A tube of elliptical section, and one about an ellipse, both by 1 %.
  for (const Vec3& factors : {Vec3(1.0, 1.0, 1.01), Vec3(1.01, 1.0, 1.0)}) {
    Eigen::Affine3d stretch = Eigen::Affine3d::Identity();
    stretch.linear().diagonal() = factors;
    TriMesh oval = transformed(make_torus({5.0, 1.0, 72, 36}), stretch);
    oval.supports.clear();
    oval.support.clear();
    recognize_round_faces(oval, kTorusTolerance);
    CHECK_FALSE(has_torus(oval));
  }

  // Small pieces of an ellipsoid of three axes are within 0.1 um of tori.
  TriMesh ellipsoid = make_sphere(1.0, 24);
  ellipsoid.supports.clear();
  ellipsoid.support.clear();
  for (Vec3& vertex : ellipsoid.vertices) vertex = vertex.cwiseProduct(Vec3(1.0, 2.0, 3.0));
  recognize_round_faces(ellipsoid, 1e-4);
  CHECK_FALSE(has_torus(ellipsoid));
  // And strips of them, facets of like size between two of its sections, of cones.
  TorusOutline half;
  for (int i = -36; i <= 36; ++i)
    half.emplace_back(std::abs(i) == 36 ? 0.0 : 2.0 * std::cos(kPi * i / 72), 3.0 * std::sin(kPi * i / 72));
  TriMesh sections = revolved(half, {0.0, kTwoPi, 72});
  for (Vec3& vertex : sections.vertices) vertex.x() *= 0.5;
  recognize_round_faces(sections, 1e-4);
  CHECK_FALSE(has_torus(sections));
  CHECK(sections.triangles.size() - facets_left(sections) <
        48);  // one piece at a pole is within 0.1 um of a cone

  // One that crosses itself.
  TriMesh apple;
  TorusOutline arc;
  for (int i = -20; i <= 20; ++i) {
    const double angle = 2.0 * i / 20;
    arc.emplace_back(std::max(0.0, 1.0 + 2.0 * std::cos(angle)), 2.0 * std::sin(angle));
  }
  apple = triangles_of(revolved(arc, {0.0, kTwoPi, 72}));
  recognize_round_faces(apple, kTorusTolerance);
  CHECK_FALSE(has_torus(apple));
}

TEST_CASE(
    "Spheres, cylinders and cones are not recognized as tori, whatever torus leads through their corners") {
  TriMesh ball = triangles_of(make_sphere(2.0, 6));
  REQUIRE(recognize_round_faces(ball, kTorusTolerance).size() == 1);
  CHECK(ball.supports[0].is_sphere());
  for (const double height : {0.1, 5.0}) {
    TriMesh rod = triangles_of(make_cylinder(4.0, height, 72));
    REQUIRE(recognize_round_faces(rod, kTorusTolerance).size() == 1);
    CHECK(std::string(rod.supports[0].name()) == "cylinder");
  }
  // Walls between three rings, and between four that are mirror images: both lie on a torus.
  const TorusOutline three{{0.0, 0.0}, {4.0, 0.0}, {4.4, 2.0}, {4.5, 4.0}, {0.0, 4.0}};
  const TorusOutline four{{0.0, 0.0}, {4.0, 0.0}, {4.3, 2.0}, {4.3, 4.0}, {4.0, 6.0}, {0.0, 6.0}};
  for (const TorusOutline& outline : {three, four}) {
    TriMesh barrel = triangles_of(revolved(outline, {0.0, kTwoPi, 72}));
    CHECK(recognize_round_faces(barrel, kTorusTolerance).size() == outline.size() - 3);
    CHECK_FALSE(has_torus(barrel));
    CHECK(facets_left(barrel) == 2 * 72);
  }
  // A wall that noise bends a little less than it may is no torus of a large radius.
  TriMesh rough = triangles_of(make_cylinder(1.5, 20.0, 72));
  make_noisy(rough, 1e-4);
  const std::vector<RecognizedFace> found = recognize_round_faces(rough, 3e-4);
  REQUIRE(found.size() == 1);
  CHECK(std::string(rough.supports[0].name()) == "cylinder");
}

TEST_CASE("Meshes that are no bodies do not stop the recognition") {
  const auto add_group = [](TriMesh& mesh) {
    mesh.group.assign(mesh.triangles.size(), 0);
    mesh.groups = {"default"};
  };
  TriMesh empty;
  CHECK(recognize_round_faces(empty, kTorusTolerance).empty());
  TriMesh one;
  one.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {{0, 1, 2}};
  add_group(one);
  CHECK(recognize_round_faces(one, kTorusTolerance).empty());
  TriMesh same = one;  // all in one place, and twice
  same.triangles = {{0, 0, 0}, {0, 1, 1}, {0, 1, 2}, {0, 1, 2}, {2, 1, 0}};
  add_group(same);
  CHECK(recognize_round_faces(same, kTorusTolerance).empty());

  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, 1e200, 1e-200}) {
    CAPTURE(bad);
    TriMesh torus = make_torus({5.0, 1.0, 24, 12});
    torus.supports.clear();
    torus.support.clear();
    TriMesh scaled = torus;
    torus.vertices[17].x() = bad;
    recognize_round_faces(torus, kTorusTolerance);
    for (const SupportSurface& surface : torus.supports)
      CHECK(std::isfinite(surface.major + surface.radius2));
    for (Vec3& vertex : scaled.vertices) vertex *= bad;
    recognize_round_faces(scaled, kTorusTolerance);
    CHECK(scaled.supports.empty());
  }
  TriMesh flattened = make_torus({5.0, 1.0, 24, 12});
  flattened.supports.clear();
  flattened.support.clear();
  for (Vec3& vertex : flattened.vertices) vertex.z() = 0.0;
  CHECK(recognize_round_faces(flattened, kTorusTolerance).empty());
}
