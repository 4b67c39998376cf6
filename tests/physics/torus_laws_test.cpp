// Laws of light in bent tubes that came as triangles, in which their walls are recognized.
#include <cmath>

#include "physics/traced.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/solids.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;

namespace {

/// A tube of radius 1 mm about a circle of 3 mm, or part of it, with or without a hole, from its triangles.
struct BentTube {
  double extent_rad = kTwoPi, hole_mm = 0.0;
  int segments = 72, tube_segments = 36;

  mesh::TriMesh mesh() const {
    const auto ring = [&](double radius) {
      std::vector<Eigen::Vector2d> circle;
      for (int i = 0; i < tube_segments; ++i) {
        const double angle = kTwoPi * i / tube_segments;
        circle.emplace_back(3.0 + radius * std::cos(angle), radius * std::sin(angle));
      }
      return circle;
    };
    if (hole_mm <= 0.0) return mesh::revolved(ring(1.0), {0.0, extent_rad, segments});
    const auto place = [&](const Vec3& at) {
      const double phi = at.x() * extent_rad, angle = kTwoPi * at.y();
      const double r = hole_mm + at.z() * (1.0 - hole_mm), rho = 3.0 + r * std::cos(angle);
      return Vec3(rho * std::cos(phi), rho * std::sin(phi), r * std::sin(angle));
    };
    return mesh::mapped_cube({segments, tube_segments, 1}, {extent_rad >= kTwoPi, true, false}, place);
  }

  /// Of its ends, which lie in the plane y = 0 where there are any, mirrors are made.
  std::string part() const {
    const auto path = scratch_folder("bent_tube") / "tube.ply";
    mesh::write_ply(path, mesh());
    return "[[part]]\nname = \"body\"\nmesh = \"" + path.string() +
           "\"\nunit = \"mm\"\ncurved = \"recognize\"\nmedium = \"glass_5\"\nsurface = \"flat\"\n" +
           (extent_rad >= kTwoPi ? std::string()
                                 : "[[part.face]]\nname = \"ends\"\nsurface = \"mirror\"\nselect = { box = { "
                                   "low = [\"-9 mm\", "
                                   "\"-1 um\", \"-9 mm\"], high = [\"9 mm\", \"1 um\", \"9 mm\"] } }\n");
  }
};

int photons() { return law_photons(160'000); }

/// Number of photons that leave a part, started evenly in it; outside they are absorbed at once, so that none
/// enters it again across the hole.
double leaving(const std::string& part, bool exact = true) {
  const Traced traced = trace("ambient = \"black_n1\"\n" + part + R"([media.black_n1]
index = { n = 1.0 }
absorption = { length = "0.1 um" }
scattering = { none = true }
[media.glass_5]
index = { n = 1.5 }
absorption = { length = "5 mm" }
scattering = { none = true }
[surfaces.mirror]
model = "painted"
reflectance = 1.0
specular_share = 1.0
[source]
type = "photons"
wavelength = "420 nm"
polarisation = "unpolarised"
region = { part = "body" }
photons = )" + std::to_string(photons()) +
                              "\n");
  CHECK(traced.built.scene.parts.front().facets_because == "");
  CHECK(traced.built.scene.parts.front().curved == exact);
  CHECK(traced.result.count(Fate::absorbed_in_medium) == static_cast<std::uint64_t>(photons()));
  const scene::Scene& scene = traced.built.scene;
  return static_cast<double>(traced.result.absorbed_in_medium[scene.regions[scene::kAmbientRegion].medium]);
}

/// Standard deviations between two numbers of photons.
double sigmas_between(double count, double other) {
  const double share = 0.5 * (count + other) / photons();
  return std::abs(count - other) / std::sqrt(2.0 * photons() * share * (1.0 - share));
}

}  // namespace

TEST_CASE(
    "Law: half a torus between mirrors is a whole one, whatever the triangles in which it is recognized") {
  // The mirrors are in planes of symmetry, so that every path in the whole torus has its image in the half.
  const double whole = leaving(
      "[[part]]\nname = \"body\"\ntorus = { radius = \"3 mm\", tube_radius = \"1 mm\" }\nmedium = "
      "\"glass_5\"\nsurface = \"flat\"\n");
  CHECK(sigmas_between(leaving(BentTube{kTwoPi, 0.0, 24, 16}.part()), whole) < kSigmas);
  CHECK(sigmas_between(leaving(BentTube{kPi, 0.0, 12, 16}.part()), whole) < kSigmas);
  CHECK(sigmas_between(leaving(BentTube{kPi, 0.0, 36, 72}.part()), whole) < kSigmas);
  // Facets let out more: a face that is not recognized would be seen.
  std::string facets = BentTube{kPi, 0.0, 12, 16}.part();
  facets.erase(facets.find("curved = \"recognize\"\n"), std::string("curved = \"recognize\"\n").size());
  CHECK(sigmas_between(leaving(facets, false), whole) > 10.0);
  const double hollow = leaving(BentTube{kTwoPi, 0.7}.part());
  CHECK(sigmas_between(hollow, whole) > 10.0);
  CHECK(sigmas_between(leaving(BentTube{kPi, 0.7, 12, 16}.part()), hollow) < kSigmas);
}
