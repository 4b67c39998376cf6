#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>

#include "physics/traced.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::mesh;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::test;

namespace {

constexpr double kCrystal = 1.82;

double critical_angle(double n1, double n2) { return std::asin(n2 / n1); }

/// Integral of f over [a, b] by Simpson's rule.
template <typename F>
double integrate(F f, double a, double b, int panels = 2000) {
  const double h = (b - a) / (2 * panels);
  double sum = f(a) + f(b);
  for (int i = 1; i < 2 * panels; ++i) sum += (i % 2 ? 4.0 : 2.0) * f(a + i * h);
  return sum * h / 3.0;
}

double unpolarised(double angle, double n1, double n2) {
  return fresnel(std::cos(angle), n1, n2).unpolarised();
}

/// Lambertian-weighted mean of the reflectance.
double diffuse_reflectance(double n1, double n2) {
  const double limit = n1 > n2 ? critical_angle(n1, n2) : 0.5 * kPi;
  const double below =
      integrate([&](double t) { return unpolarised(t, n1, n2) * std::sin(2.0 * t); }, 0.0, limit);
  return below + std::pow(std::cos(limit), 2);
}

/// A point on the walls of a box side x side x 20 mm3 that stands on z = 0, uniform in area, and the
/// normal into the box.
std::pair<Vec3, Vec3> wall_point(double side, Rng& rng) {
  constexpr double kHeight = 20.0;
  const double u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
  const double sign = v < 0.5 ? -1.0 : 1.0;
  if (u < side / (side + 2.0 * kHeight))  // an end
    return {Vec3((2.0 * v - (v < 0.5 ? 0.5 : 1.5)) * side, (w - 0.5) * side, v < 0.5 ? 0.0 : kHeight),
            Vec3(0, 0, -sign)};
  const double along = (2.0 * v - (v < 0.5 ? 0.5 : 1.5)) * side;
  const Vec3 point(0.5 * sign * side, along, w * kHeight), normal(-sign, 0, 0);
  if (rng.uniform() < 0.5) return {point, normal};
  return {Vec3(point.y(), point.x(), point.z()), Vec3(0, -sign, 0)};
}

const std::string kCube = R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["4 mm", "4 mm", "4 mm"]
medium = "lso_clear"
surface = "flat"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 200_000
[run]
max_interactions = 400
)";

}  // namespace

TEST_CASE("Law: Fresnel reflectance at normal incidence") {
  CHECK(unpolarised(0.0, kCrystal, 1.0) == doctest::Approx(0.08455).epsilon(1e-4));
  CHECK(unpolarised(0.0, kCrystal, 1.5) == doctest::Approx(0.00929).epsilon(1e-3));
}

TEST_CASE("Law: no p-polarised light is reflected at Brewster's angle") {
  const double brewster = std::atan(1.0 / kCrystal);
  CHECK(brewster / kDegree == doctest::Approx(28.7866).epsilon(1e-5));
  CHECK(fresnel(std::cos(brewster), kCrystal, 1.0).reflectance_p < 1e-28);
}

TEST_CASE("Law: diffuse reflectance of a smooth interface, both ways, and its n squared relation") {
  const double inside = diffuse_reflectance(kCrystal, 1.0), outside = diffuse_reflectance(1.0, kCrystal);
  CHECK(inside == doctest::Approx(0.739392).epsilon(1e-5));
  CHECK(outside == doctest::Approx(0.136763).epsilon(1e-4));
  CHECK(kCrystal * kCrystal * (1.0 - inside) == doctest::Approx(1.0 - outside).epsilon(1e-5));

  // And as the tracer samples it, polarised photon by photon.
  for (const auto& [n1, n2, expected] :
       {std::tuple{kCrystal, 1.0, 0.739392}, std::tuple{1.0, kCrystal, 0.136763}}) {
    std::uint64_t reflected = 0;
    constexpr std::uint64_t kRays = 400'000;
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(3, StreamKind::other, i);
      Ray ray;
      ray.direction = sample_lambertian(-Vec3::UnitZ(), rng);
      ray.polarisation = sample_polarisation(ray.direction, rng);
      reflected += !interact_at_facet(ray, Vec3::UnitZ(), n1, n2, rng);
      REQUIRE(std::abs(ray.direction.norm() - 1.0) < 1e-12);
      REQUIRE(std::abs(ray.polarisation.dot(ray.direction)) < 1e-9);
    }
    check_law("reflected", binomial_estimate(reflected, kRays), {expected, 1e-6});
  }
}

TEST_CASE("Law: critical and Brewster angles, reflectances and escape cones for pairs of indices") {
  // Independent numbers, rounded to 1e-6, or 1e-4 deg; Simpson's rule is good to 3e-6 where the reflectance
  // rises steeply below the critical angle.
  constexpr double kRounding = 5.1e-7, kIntegral = 4e-6, kAngle = 5.1e-5;
  std::ifstream stream(source_file("tests/reference/analytic_checks.txt"));
  const std::regex decimal(R"(-?\d+\.\d+)");
  std::size_t pairs = 0;
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("n1=", 0) != 0) continue;
    CAPTURE(line);
    std::vector<double> number;
    for (std::sregex_iterator found(line.begin(), line.end(), decimal), end; found != end; ++found)
      number.push_back(std::stod(found->str()));
    REQUIRE(number.size() == 12);
    const double n1 = number[0], n2 = number[1], critical = critical_angle(n1, n2);
    const auto transmitted = [&](double t) { return 0.5 * (1.0 - unpolarised(t, n1, n2)) * std::sin(t); };
    const double cone = 0.5 * (1.0 - std::cos(critical)), internal = diffuse_reflectance(n1, n2);
    CHECK(std::abs(critical / kDegree - number[2]) < kAngle);
    CHECK(std::abs(unpolarised(0.0, n1, n2) - number[3]) < kRounding);
    CHECK(std::abs(cone - number[4]) < kRounding);
    CHECK(std::abs(6.0 * cone - number[5]) < kRounding);
    CHECK(std::abs(1.0 - 6.0 * cone - number[6]) < kRounding);
    CHECK(std::abs(integrate(transmitted, 0.0, critical) - number[7]) < kIntegral);
    CHECK(std::abs(internal - number[8]) < kIntegral);
    const double external = diffuse_reflectance(n2, n1);
    CHECK(std::abs(external - number[9]) < kIntegral);
    CHECK(std::abs(1.0 - (1.0 - external) * n2 * n2 / (n1 * n1) - number[10]) < kIntegral);
    CHECK(std::abs(std::atan(n2 / n1) / kDegree - number[11]) < kAngle);
    ++pairs;
  }
  CHECK(pairs == 10);
}

TEST_CASE("Law: light trapped for ever in a lossless polished box, 3 cos(tc) - 2") {
  const Traced traced = trace(kCube);
  const double expected = 3.0 * std::cos(critical_angle(kCrystal, 1.0)) - 2.0;
  CHECK(expected == doctest::Approx(0.5066).epsilon(1e-4));
  check_fraction(traced.result, Fate::cut_interactions, expected);
  check_fraction(traced.result, Fate::escaped, 1.0 - expected);
}

TEST_CASE("Law: share of light that leaves a lossless polished box through one face, (1 - cos(tc)) / 2") {
  std::string scene = kCube;
  scene.insert(scene.find("[source]"), R"(
[[part]]
name = "sensor"
box = ["4 mm", "4 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "perfect_n1"
)");
  check_fraction(trace(scene).result, Fate::detected, 0.5 * (1.0 - std::cos(critical_angle(kCrystal, 1.0))));
}

TEST_CASE("Law: share detected by a sensor of index 1.5 on a lossless polished box") {
  // Closed forms integrated over direction, with the polarisation either forgotten at each surface or
  // kept; independent numbers.
  const std::string sensor = R"(
[[part]]
name = "sensor"
box = ["4 mm", "4 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "perfect"
)";
  for (const auto& [polarisation, expected] :
       {std::pair{"unpolarised", 0.362172}, std::pair{"random", 0.362205}}) {
    std::string scene = kCube;
    scene.insert(scene.find("[source]"), sensor);
    scene.insert(scene.find("photons ="), std::string("polarisation = \"") + polarisation + "\"\n");
    check_fraction(trace(scene).result, Fate::detected, expected);
  }
}

TEST_CASE("Law: polished bar, sides in total reflection, absorption, sensor at one end") {
  // Directions within 50 deg of the axis are incident on the sides beyond the critical angle. With a = 1/(la
  // cos t), P = T [exp(-a z) + Rf exp(-a (2L - z))] / (2 (1 - Rd Rf exp(-2 a L))).
  constexpr double kLength = 20.0, kAbsorption = 30.0, kDepth = 8.0, kHalfAngle = 50.0 * kDegree;
  const auto detected_at = [&](double theta) {
    const double a = 1.0 / (kAbsorption * std::cos(theta));
    const double r_near = unpolarised(theta, kCrystal, 1.5), r_far = unpolarised(theta, kCrystal, 1.0);
    const double there_and_back = 1.0 - r_near * r_far * std::exp(-2.0 * a * kLength);
    return (1.0 - r_near) * (std::exp(-a * kDepth) + r_far * std::exp(-a * (2.0 * kLength - kDepth))) /
           (2.0 * there_and_back);
  };
  const double critical = critical_angle(kCrystal, 1.0);
  const auto weighted = [&](double t) { return detected_at(t) * std::sin(t); };
  const double expected = (integrate(weighted, 0.0, critical) + integrate(weighted, critical, kHalfAngle)) /
                          (1.0 - std::cos(kHalfAngle));

  std::uint64_t detected = 0, photons = 0;
  for (const std::string axis : {"-1", "1"}) {
    const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "bar"
box = ["2 mm", "2 mm", "20 mm"]
medium = "lso_absorbing"
surface = "flat"
[[part]]
name = "sensor"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "bar", side = "-z" }
sensor = "perfect"
[source]
type = "photons"
position = ["0.1 mm", "-0.3 mm", "8 mm"]
direction = { cone = [0, 0, )" + axis +
                                R"(], half_angle = "50 deg" }
wavelength = "420 nm"
polarisation = "unpolarised"
photons = 200_000
)");
    detected += traced.result.count(Fate::detected);
    photons += traced.result.photons;
  }
  const Estimate measured = binomial_estimate(detected, photons);
  CAPTURE(measured.value);
  CAPTURE(expected);
  check_law("detected", measured, {expected, 0.0});
}

TEST_CASE("Law: integrating sphere with a port, f / (1 - rho (1 - f))") {
  // A hollow of 20 x 24^2 triangles painted white, with one cap open. Lambertian walls of a sphere
  // illuminate the whole sphere uniformly, so light is incident on the port with probability f, its share of
  // the tessellation's own area.
  const auto mesh = scratch_folder("integrating_sphere") / "sphere.stl";
  write_stl(mesh, make_sphere(10.0, 24));
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "sphere"
mesh = ")" + mesh.string() + R"("
unit = "mm"
medium = "vacuum_n1"
surface = "wall"
[[part.face]]
name = "port"
select = { box = { low = ["-6 mm", "-6 mm", "8.5 mm"], high = ["6 mm", "6 mm", "11 mm"] } }
surface = "flat"
[source]
type = "photons"
position = ["0 mm", "0 mm", "0 mm"]
wavelength = "420 nm"
photons = 200_000
[surfaces.wall]
model = "painted"
reflectance = 0.95
specular_share = 0.0
)");
  const Scene& scene = traced.built.scene;
  const double port = face_area(scene, "sphere:port");
  const double f = port / (port + face_area(scene, "sphere:other"));
  CHECK(f > 0.05);
  check_fraction(traced.result, Fate::escaped, f / (1.0 - 0.95 * (1.0 - f)));
}

TEST_CASE("Law: mean chord 4V/S in isotropic light, unchanged by scattering") {
  // Isotropic uniform light enters through every wall alike, as Lambert's law. (Photons started in the
  // volume would find long chords more often than short ones.)
  for (const std::string medium : {"vacuum_n1", "cloudy_n1"}) {
    for (const auto& row : {std::pair{"2", 1.905}, std::pair{"5", 4.444}}) {
      const auto& size = row.first;
      const auto& expected = row.second;
      const SceneSpec spec = scene_spec(std::string(R"(
ambient = "vacuum_n1"
[[part]]
name = "box"
box = [")") + size + R"( mm", ")" + size +
                                        R"( mm", "20 mm"]
medium = ")" + medium + R"("
surface = "white"
[source]
type = "photons"
region = { part = "box" }
wavelength = "420 nm"
photons = 1
)");
      SceneBuilder builder;
      const BuiltScene built = builder.build(spec);
      const PhotonSource source(spec.source, built.scene);
      Moments chord;
      for (std::uint64_t i = 0; i < 200'000; ++i) {
        Rng rng(11, StreamKind::photon, i);
        Photon photon = source.emit(built.scene, rng);
        const auto [position, inward] = wall_point(std::stod(size), rng);
        photon.position = position;
        photon.ray.direction = sample_lambertian(inward, rng);
        while (photon.interactions < 1) step(built.scene, photon, rng);
        chord.add(photon.path_mm);
      }
      CAPTURE(medium);
      CAPTURE(size);
      const double side = std::stod(size);
      const double law = 4.0 * side * side * 20.0 / (2.0 * side * side + 80.0 * side);
      CHECK(law == doctest::Approx(expected).epsilon(3e-4));
      check_law("mean chord, mm", chord.mean(), {law, 0.0});
    }
  }
}

TEST_CASE("Law: Lambert's p(theta) = sin 2 theta, mean cosine 2/3") {
  Moments cosine;
  std::vector<std::uint64_t> histogram(30, 0);
  constexpr std::uint64_t kRays = 300'000;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    Rng rng(5, StreamKind::other, i);
    const double c = sample_lambertian(Vec3(0.6, 0.0, 0.8), rng).dot(Vec3(0.6, 0.0, 0.8));
    cosine.add(c);
    ++histogram[std::min<std::size_t>(29, static_cast<std::size_t>(std::acos(c) / (0.5 * kPi) * 30.0))];
  }
  check_law("mean cosine", cosine.mean(), {2.0 / 3.0, 0.0});
  std::vector<double> expected;
  for (int i = 0; i < 30; ++i) {
    const double low = 0.5 * kPi * i / 30.0, high = 0.5 * kPi * (i + 1) / 30.0;
    expected.push_back(kRays * (std::pow(std::sin(high), 2) - std::pow(std::sin(low), 2)));
  }
  CHECK(chi_square_test(histogram, expected).p_value > 1e-4);
}

TEST_CASE("Law: the first of N photons with decay time tau comes after tau / N on average") {
  const SceneSpec spec = scene_spec(R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "scintillator"
surface = "flat"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
time = "decay"
photons = 1
[media.scintillator]
index = { n = 1.82 }
absorption = { none = true }
scattering = { none = true }
yield = { value = "25 1/keV" }
emission = { spectrum = { wavelength = [400, 440], wavelength_unit = "nm", value = [1, 1] } }
[[media.scintillator.decay]]
time = "40 ns"
rise = "0 ns"
fraction = 1.0
)");
  SceneBuilder builder;
  const BuiltScene built = builder.build(spec);
  const PhotonSource source(spec.source, built.scene);
  constexpr std::uint64_t kPhotons = 50;
  Moments first;
  for (std::uint64_t event = 0; event < 20'000; ++event) {
    double earliest = HUGE_VAL;
    for (std::uint64_t i = 0; i < kPhotons; ++i) {
      Rng rng(7, StreamKind::photon, event, i);
      earliest = std::min(earliest, source.emit(built.scene, rng).time_ns);
    }
    first.add(earliest);
  }
  check_law("first photon, ns", first.mean(), {40.0 / kPhotons, 0.0});
}
