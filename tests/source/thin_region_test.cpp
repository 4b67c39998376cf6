// Light from parts that fill little of their bounding box.
#include <cmath>

#include "event_scene.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/source/light_source.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

constexpr double kRadius_mm = 0.5, kHeight_mm = 1000.0;

/// A fibre of 1 mm x 1 m along `axis` of the frame in which it is turned by 45 deg about x and then about z.
std::string skew_fibre() {
  return "[[part]]\nname = \"fibre\"\ncylinder = { radius = \"0.5 mm\", height = \"1000 mm\", segments = 32 "
         "}\n"
         "rotate = [{ axis = [1, 0, 0], angle = \"45 deg\" }, { axis = [0, 0, 1], angle = \"45 deg\" }]\n"
         "medium = \"LSO\"\nsurface = \"flat\"\n";
}

Vec3 along_fibre() {
  return {std::sqrt(0.5) * std::sqrt(0.5), -std::sqrt(0.5) * std::sqrt(0.5), std::sqrt(0.5)};
}

std::vector<Vec3> starts(const Scene& scene, const std::string& region, std::uint64_t photons) {
  const scene_file::SceneFile file = scene_file::SceneFile::from_text(
      "ambient = \"vacuum\"\n" + skew_fibre() + "[source]\ntype = \"photons\"\nregion = " + region +
          "\nwavelength = \"420 nm\"\ntime = \"0 ns\"\nphotons = " + std::to_string(photons) +
          "\n[surfaces.flat]\nmodel = \"smooth\"\n",
      scene_path());
  const auto source = make_light_source(file.spec(0), scene);
  std::vector<Vec3> places;
  for (std::uint64_t i = 0; i < photons; ++i) {
    Rng rng(20261123, StreamKind::photon, i);
    places.push_back(source->emit(scene, {}, i, rng).position.vec());
  }
  return places;
}

}  // namespace

TEST_CASE("photons start uniformly in the volume of a thin part that is not along an axis") {
  const Scene scene = scene_of(skew_fibre());
  constexpr std::uint64_t kPhotons = 20'000;
  constexpr std::size_t kBins = 20;
  std::vector<std::uint64_t> length(kBins, 0), radius(kBins, 0);
  // Corners of the polygon lie on the radius: its own circle of equal area is a little smaller.
  const double equal_area = kRadius_mm * kRadius_mm * 32 * std::sin(kTwoPi / 32) / kTwoPi;
  for (const Vec3& place : starts(scene, "{ part = \"fibre\" }", kPhotons)) {
    const double along = place.dot(along_fibre());
    REQUIRE(along >= -1e-9);
    REQUIRE(along <= kHeight_mm + 1e-9);
    const double from_axis = (place - along * along_fibre()).norm();
    REQUIRE(from_axis <= kRadius_mm + 1e-9);
    ++length[std::min(kBins - 1, static_cast<std::size_t>(kBins * along / kHeight_mm))];
    ++radius[std::min(kBins - 1, static_cast<std::size_t>(kBins * from_axis * from_axis / equal_area))];
  }
  const std::vector<double> equal(kBins, static_cast<double>(kPhotons) / kBins);
  CHECK(chi_square_test(length, equal).p_value > 1e-4);  // the chance of a false alarm
  // Rings that lie in the polygon; 4 sigma of the binomial distribution in each, a chance of 1e-3 together.
  const double error = std::sqrt(equal[0] * (1.0 - 1.0 / kBins));
  for (std::size_t ring = 0; ring < 18; ++ring) {
    CAPTURE(ring);
    CHECK(std::abs(static_cast<double>(radius[ring]) - equal[ring]) < 4.0 * error);
  }
}

TEST_CASE("a slab across a thin skew part is the region of its own volume there") {
  const Scene scene = scene_of(skew_fibre());
  for (const Vec3& place : starts(scene, "{ part = \"fibre\", slab_z = [\"100 mm\", \"101 mm\"] }", 500)) {
    CHECK(place.z() >= 100.0);
    CHECK(place.z() <= 101.0);
  }
}
