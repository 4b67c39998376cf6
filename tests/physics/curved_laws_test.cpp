// Laws of light in bodies with exact round faces: closed forms, and rays followed by their invariants.
#include <algorithm>
#include <cmath>

#include "physics/traced.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/mesh/export/triangle_files.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/optics/fresnel.hpp"
#include "scintray/scene/facet_faces.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"
#include "support/shared.hpp"
#include "support/step_shapes.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::test;

namespace {

constexpr double kLso = 1.82;

/// Integral of f over [a, b] by Simpson's rule.
template <typename F>
double simpson(F f, double a, double b, int panels = 4000) {
  const double h = (b - a) / (2 * panels);
  double sum = f(a) + f(b);
  for (int i = 1; i < 2 * panels; ++i) sum += (i % 2 ? 4.0 : 2.0) * f(a + i * h);
  return sum * h / 3.0;
}

double reflectance(double cosine, double n1, double n2) {
  if (1.0 - cosine * cosine >= n2 * n2 / (n1 * n1)) return 1.0;
  return fresnel(cosine, n1, n2).unpolarised();
}

const std::string kVacuum = "ambient = \"vacuum_n1\"\n";
const std::string kLso300 =
    "[media.lso_300]\nindex = { n = 1.82 }\nabsorption = { length = \"300 mm\" }\n"
    "scattering = { none = true }\n";

std::string source_in(const std::string& part, int photons, const std::string& rest = "") {
  return "[source]\ntype = \"photons\"\nwavelength = \"420 nm\"\npolarisation = \"unpolarised\"\nregion = { "
         "part = \"" +
         part + "\"" + rest + " }\nphotons = " + std::to_string(photons > 1 ? law_photons(photons) : 1) +
         "\n";
}

/// The n-th point of a low-discrepancy sequence in the unit cube of four dimensions: multiples of powers of
/// the root of x^5 = x + 1 (M. Roberts 2018, a generalisation of the golden ratio).
std::array<double, 4> even_point(std::uint64_t n) {
  constexpr double kRoot = 1.16730397826141868426;
  std::array<double, 4> point{};
  double power = 1.0;
  for (double& x : point) {
    power /= kRoot;
    const double sum = 0.5 + power * static_cast<double>(n);
    x = sum - std::floor(sum);
  }
  return point;
}

struct RodShares {
  double escaped = 0.0, detected = 0.0, absorbed = 0.0;
};

/// Shares of light emitted uniformly in a rod with a sensor of index `sensor` at its lower end and vacuum
/// around. All reflections conserve the angles at the wall and at the ends: rays are followed by these, with
/// weights in place of random choices.
RodShares rod_shares(double n, double radius, double length, double absorption_length, double sensor) {
  constexpr std::uint64_t kRays = 400'000;
  RodShares sum;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    const auto [u, v, w, z0] = even_point(i);
    const double cosine = 2.0 * u - 1.0, sine = std::sqrt(1.0 - cosine * cosine);
    // Height of the point in the circle, and the direction there along x.
    const double rho = radius * std::sqrt(v), angle = kTwoPi * w;
    const double x = rho * std::cos(angle), y = rho * std::sin(angle);
    const double half_chord = std::sqrt(radius * radius - y * y);
    const double at_wall = reflectance(sine * half_chord / radius, n, 1.0);
    const double at_top = reflectance(std::abs(cosine), n, 1.0),
                 at_sensor = reflectance(std::abs(cosine), n, sensor);
    double z = z0 * length, up = cosine, weight = 1.0;
    double to_wall = (half_chord - x) / sine;
    while (weight > 1e-6) {
      const double to_end = (up > 0.0 ? length - z : z) / std::abs(up);
      const double path = std::min(to_wall, to_end), kept = std::exp(-path / absorption_length);
      sum.absorbed += weight * (1.0 - kept);
      weight *= kept;
      z += path * up;
      to_wall -= path;
      if (to_end <= path) {
        const double reflected = up > 0.0 ? at_top : at_sensor;
        (up > 0.0 ? sum.escaped : sum.detected) += weight * (1.0 - reflected);
        weight *= reflected;
        up = -up;
      } else {
        sum.escaped += weight * (1.0 - at_wall);
        weight *= at_wall;
        to_wall = 2.0 * half_chord / sine;
      }
    }
  }
  for (double* share : {&sum.escaped, &sum.detected, &sum.absorbed}) *share /= static_cast<double>(kRays);
  return sum;
}

/// Checks the light that a fibre keeps: that of its ends, and what goes round in it so flat or so steeply
/// that it has not come to one of them after the most interactions.
void check_kept(const tally::PointResult& result, double expected) {
  std::uint64_t all = 0;
  for (const Fate fate : {Fate::detected, Fate::escaped, Fate::absorbed_in_medium, Fate::cut_interactions})
    all += result.count(fate);
  const std::uint64_t kept = result.count(Fate::detected) + result.count(Fate::cut_interactions);
  check_law("kept", binomial_estimate(kept, all), {expected, 0.0});
}

/// A rod of LSO of 3 mm x 20 mm, with an absorption length of 300 mm, on a sensor.
std::string rod_scene(int sides, int photons) {
  return kVacuum +
         fmt::format(R"([[part]]
name = "rod"
cylinder = {{ radius = "1.5 mm", height = "20 mm", segments = {} }}
medium = "lso_300"
surface = "flat"
[[part]]
name = "sensor"
cylinder = {{ radius = "1.5 mm", height = "1 mm", segments = {} }}
place = {{ touch = "rod", side = "-z" }}
sensor = "perfect"
)",
                     sides, sides) +
         source_in("rod", photons) + kLso300;
}

}  // namespace

TEST_CASE("Law: light trapped for ever in a lossless ball, cos^3(tc)") {
  // Rays of light emitted uniformly reach the wall with a density of cosines 3 c^2: its chord, 2 R c, times
  // c.
  const double cosine = std::sqrt(1.0 - 1.0 / (kLso * kLso));
  const Traced traced = trace(kVacuum + R"([[part]]
name = "ball"
sphere = { radius = "2 mm" }
medium = "lso_clear"
surface = "flat"
)" + source_in("ball", 400'000) +
                              "[run]\nmax_interactions = 300\n");
  check_fraction(traced.result, Fate::cut_interactions, std::pow(cosine, 3));
  check_fraction(traced.result, Fate::escaped, 1.0 - std::pow(cosine, 3));
}

TEST_CASE("Law: light that escapes from an absorbing ball of 2 mm radius, by an integral over the cosine") {
  constexpr double kRadius = 2.0, kAbsorption = 300.0;
  const double limit = std::sqrt(1.0 - 1.0 / (kLso * kLso));
  const double expected = simpson(
      [&](double c) {
        const double chord = 2.0 * kRadius * c, kept = std::exp(-chord / kAbsorption),
                     r = reflectance(c, kLso, 1.0);
        return 3.0 * c * c * kAbsorption / chord * (1.0 - kept) * (1.0 - r) / (1.0 - r * kept);
      },
      limit + 1e-12, 1.0, 100'000);
  CHECK(expected == doctest::Approx(0.412).epsilon(2e-3));
  const Traced traced = trace(kVacuum + R"([[part]]
name = "ball"
sphere = { radius = "2 mm" }
medium = "lso_300"
surface = "flat"
)" + source_in("ball", 1'000'000) +
                              "[media.lso_300]\nindex = { n = 1.82 }\nabsorption = { length = \"300 mm\" }\n"
                              "scattering = { none = true }\n");
  check_fraction(traced.result, Fate::escaped, expected);
}

TEST_CASE(
    "Law: light in an LSO rod of 3 mm x 20 mm with a sensor at one end, by the invariants of its rays") {
  const RodShares expected = rod_shares(kLso, 1.5, 20.0, 300.0, 1.5);
  CHECK(expected.escaped + expected.detected + expected.absorbed == doctest::Approx(1.0).epsilon(1e-5));
  for (const int sides : {12, 72, 512}) {
    const Traced traced = trace(rod_scene(sides, 400'000));
    CAPTURE(sides);
    check_fraction(traced.result, Fate::detected, expected.detected);
    check_fraction(traced.result, Fate::escaped, expected.escaped);
    check_fraction(traced.result, Fate::absorbed_in_medium, expected.absorbed);
  }
}

TEST_CASE("Law: the rod as a file of triangles, in which its wall is recognized") {
  const RodShares expected = rod_shares(kLso, 1.5, 20.0, 300.0, 1.5);
  const auto folder = scratch_folder("recognized_rod");
  for (const auto& [sides, single] : {std::pair{16, true}, std::pair{72, false}}) {
    const std::filesystem::path file = folder / fmt::format("rod{}.{}", sides, single ? "stl" : "ply");
    const mesh::TriMesh rod = mesh::make_cylinder(1.5, 20.0, sides);
    single ? mesh::write_stl(file, rod) : mesh::write_ply(file, rod);
    const Traced traced = trace(kVacuum +
                                fmt::format(R"([[part]]
name = "rod"
mesh = "{}"
unit = "mm"
curved = "recognize"
medium = "lso_300"
surface = "flat"
[[part]]
name = "sensor"
cylinder = {{ radius = "1.5 mm", height = "1 mm", segments = 40 }}
place = {{ touch = "rod", side = "-z" }}
sensor = "perfect"
)",
                                            file.string()) +
                                source_in("rod", 200'000) + kLso300);
    CAPTURE(file);
    check_fraction(traced.result, Fate::detected, expected.detected);
    check_fraction(traced.result, Fate::escaped, expected.escaped);
    check_fraction(traced.result, Fate::absorbed_in_medium, expected.absorbed);
  }
}

TEST_CASE("Facets of a rod let out light that its wall would keep, and no more than is estimated") {
  const RodShares expected = rod_shares(kLso, 1.5, 20.0, 300.0, 1.5);
  for (const int sides : {16, 64, 256}) {
    CAPTURE(sides);
    const Traced traced = trace(rod_scene(sides, 100'000) + "[run]\ncurved = \"facets\"\n");
    const Estimate escaped = traced.result.fraction(Fate::escaped);
    const double let_out = escaped.value - expected.escaped;
    CAPTURE(let_out);
    const std::vector<FacetFace> faces = facet_faces(traced.built);
    const auto wall = std::find_if(faces.begin(), faces.end(),
                                   [](const FacetFace& face) { return face.name.starts_with("rod:"); });
    REQUIRE(wall != faces.end());
    CHECK(wall->deviation.angle_rad == doctest::Approx(kPi / sides).epsilon(1e-6));
    CAPTURE(wall->let_out);
    CHECK(let_out > kSigmas * escaped.error);
    CHECK(wall->let_out > let_out + kSigmas * escaped.error);
    CHECK(wall->let_out < 8.0 * let_out);  // an estimate, not only a bound
  }
}

TEST_CASE("The light that facets let out is estimated as none without total reflection, and as all at most") {
  RoundWall wall{1.82, 1.0, 0.0, 2.8, 0.1};
  const double all = 1.0 - 1.0 / (1.82 * 1.82);
  CHECK(light_let_out(wall) == doctest::Approx(all));  // light that is never absorbed
  wall.absorption_per_mm = 1.0 / 300.0;
  CHECK(light_let_out(wall) < all + 1e-12);
  // Little light, by the derivative of sin^2 at the critical angle.
  wall.facet_angle_rad = 1e-6;
  const double spread = 2e-6 * std::sqrt(300.0 / 2.8 / 3.0), sine = 1.0 / 1.82;
  CHECK(light_let_out(wall) ==
        doctest::Approx(2.0 * sine * std::sqrt(1.0 - sine * sine) * spread).epsilon(1e-4));
  wall.index_outside = 1.9;
  CHECK(light_let_out(wall) == 0.0);
  wall.index_outside = 1.0;
  wall.facet_angle_rad = 0.0;
  CHECK(light_let_out(wall) == 0.0);
}

TEST_CASE("Law: a round fibre keeps light by its angle at the wall, meridional and skew") {
  // Share of isotropic light emitted uniformly over a circle whose angle of incidence at the wall is beyond
  // the critical one: with the density 4/pi cos^2(psi) of the angle psi to the radius at the wall, sin(theta)
  // cos(psi) < cos(tc) (A. W. Snyder and J. D. Love, Optical Waveguide Theory, section 4-10: bound and
  // tunnelling rays together).
  constexpr double kIndex = 1.5;
  const double limit = std::sqrt(1.0 - 1.0 / (kIndex * kIndex));
  const double escaping = simpson(
      [&](double theta) {  // share of psi below acos(limit / sin)
        const double most = limit / std::sin(theta);
        if (most >= 1.0) return 0.0;
        const double psi = std::acos(most);
        return std::sin(theta) * 2.0 / kPi * (psi + 0.5 * std::sin(2.0 * psi));
      },
      std::asin(limit), 0.5 * kPi, 200'000);
  const Traced traced = trace(kVacuum + R"([[part]]
name = "fibre"
cylinder = { radius = "0.5 mm", height = "2000 mm", segments = 12 }
medium = "n15"
surface = "flat"
[[part]]
name = "below"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "fibre", side = "-z" }
sensor = "perfect"
[[part]]
name = "above"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "fibre", side = "+z" }
sensor = "perfect"
)" + source_in("fibre", 200'000, R"(, slab_z = ["999 mm", "1001 mm"])"));
  check_kept(traced.result, 1.0 - escaping);
}

namespace {

/// A shape with the volume (mm3) and the area (mm2) of closed forms.
struct KnownBody {
  std::string shape;
  double volume, area;
};

std::vector<KnownBody> known_bodies() {
  std::vector<KnownBody> bodies{
      {R"(cylinder = { radius = "1.5 mm", height = "4 mm", segments = 12 })", kPi * 2.25 * 4.0,
       kTwoPi * 1.5 * 5.5},
      {R"(sphere = { radius = "2 mm", subdivisions = 2 })", 4.0 / 3.0 * kPi * 8.0, 16.0 * kPi},
      {R"(tube = { outer_radius = "2 mm", inner_radius = "1.5 mm", height = "3 mm", segments = 16 })",
       kPi * 1.75 * 3.0, kTwoPi * 3.5 * 3.0 + kTwoPi * 1.75},
      {R"(torus = { radius = "3 mm", tube_radius = "1 mm", segments = 16, tube_segments = 12 })",
       2.0 * kPi * kPi * 3.0, 4.0 * kPi * kPi * 3.0},
      {R"(spheroid = { radius = "1 mm", half_height = "2 mm", subdivisions = 3 })", 8.0 / 3.0 * kPi,
       kTwoPi * (1.0 + 2.0 / std::sqrt(0.75) * std::asin(std::sqrt(0.75)))},
      {R"(fibre = { radius = "0.5 mm", x = ["0 mm", "0 mm", "6 mm"], z = ["0 mm", "6 mm", "6 mm"], )"
       R"(bend_radius = "3 mm", segments = 16 })",
       kPi * 0.25 * (6.0 + 1.5 * kPi), kPi * (6.0 + 1.5 * kPi) + 0.5 * kPi},
      {"box = [\"2 mm\", \"4 mm\", \"3 mm\"]\nrounding = \"0.3 mm\"",
       1.4 * 3.4 * 2.4 + 0.6 * (1.4 * 3.4 + 3.4 * 2.4 + 2.4 * 1.4) + kPi * 0.09 * (1.4 + 3.4 + 2.4) +
           4.0 / 3.0 * kPi * 0.027,
       2.0 * (1.4 * 3.4 + 3.4 * 2.4 + 2.4 * 1.4) + kTwoPi * 0.3 * (1.4 + 3.4 + 2.4) + 4.0 * kPi * 0.09}};
  for (const auto& [low, high, height] :
       {std::tuple{2.0, 0.0, 3.0}, std::tuple{0.5, 2.0, 1.0}, std::tuple{1.0, 1.5, 6.0}})
    bodies.push_back(
        {fmt::format("cone = {{ bottom_radius = \"{} mm\", top_radius = \"{} mm\", height = \"{} "
                     "mm\", segments = 16 }}",
                     low, high, height),
         kPi / 3.0 * height * (low * low + low * high + high * high),
         kPi * (low * low + high * high + (low + high) * std::hypot(height, low - high))});
  const double sag = 5.0 - std::sqrt(21.0), edge = 2.0 - 2.0 * sag;
  bodies.push_back({R"(lens = { diameter = "4 mm", thickness = "2 mm", bottom_radius = "5 mm", )"
                    R"(top_radius = "5 mm", segments = 24 })",
                    2.0 * kPi * sag * sag * (15.0 - sag) / 3.0 + kPi * 4.0 * edge,
                    2.0 * kTwoPi * 5.0 * sag + kTwoPi * 2.0 * edge});
  return bodies;
}

std::string cloudy(const std::string& name, double index) {
  return fmt::format(
      "[media.cloudy_{}]\nindex = {{ n = {} }}\nabsorption = {{ none = true }}\n"
      "scattering = {{ length = \"2 mm\", kind = \"isotropic\" }}\n",
      name, index);
}

/// Mean chord (mm) between walls that reflect all light by Lambert's law: photons tend to a uniform
/// distribution over the walls, with scattering or without.
Estimate mean_chord(const BuiltScene& built, const SceneSpec& spec, int photons) {
  const PhotonSource source(spec.source, built.scene);
  Moments chord;
  for (int i = 0; i < photons; ++i) {
    Rng rng(21, StreamKind::photon, static_cast<std::uint64_t>(i));
    Photon photon = source.emit(built.scene, rng);
    double before = 0.0, sum = 0.0;
    constexpr std::uint32_t kFirst = 20, kLast = 120;
    for (std::uint32_t seen = 0; photon.interactions < kLast;) {
      const Step taken = step(built.scene, photon, rng);
      REQUIRE_FALSE(is_final(taken.event));
      if (photon.interactions == seen) continue;
      seen = photon.interactions;
      if (seen == kFirst) before = photon.path_mm;
      sum = photon.path_mm - before;
    }
    chord.add(sum / (kLast - kFirst));
  }
  return chord.mean();
}

}  // namespace

TEST_CASE("Law: mean chord 4V/S of exact bodies, and white walls that keep everything") {
  for (const KnownBody& body : known_bodies()) {
    CAPTURE(body.shape);
    const SceneSpec spec =
        scene_spec(kVacuum + "[[part]]\nname = \"body\"\n" + body.shape +
                   "\nmedium = \"cloudy_n1\"\nsurface = \"white\"\n" + source_in("body", 1));
    SceneBuilder builder;
    const BuiltScene built = builder.build(spec);
    CHECK(built.scene.parts.front().curved);
    CHECK(built.scene.parts.front().volume_mm3 == doctest::Approx(body.volume).epsilon(1e-6));
    double area = 0.0;
    for (const FaceInfo& face : built.scene.faces) area += face.area_mm2;
    CHECK(area == doctest::Approx(body.area).epsilon(1e-6));
    const double law = 4.0 * body.volume / body.area;
    // Chords of flat bodies vary more.
    Estimate chord;
    for (int photons = 6'000; chord.error == 0.0 || chord.error > 1e-3 * law; photons *= 4) {
      REQUIRE(photons < 1'000'000);
      chord = mean_chord(built, spec, photons);
    }
    check_law("mean chord of " + body.shape.substr(0, body.shape.find(' ')) + ", mm", chord, {law, 0.0});
  }
}

TEST_CASE("Law: light in nested round bodies between white walls fills them as n squared times volume") {
  // Without absorption the radiance over n squared tends to be the same everywhere, so that the share of the
  // time spent in each body is n^3 V (path: n^2 V) of the sum.
  const SceneSpec spec = scene_spec(
      kVacuum +
      "[[part]]\nname = \"shell\"\nsphere = { radius = \"3 mm\", subdivisions = 2 }\nmedium = "
      "\"cloudy_n1\"\nsurface = \"white\"\n"
      "[[part]]\nname = \"rod\"\ncylinder = { radius = \"1 mm\", height = \"3 mm\", segments = 12 }\n"
      "translate = [\"0 mm\", \"0 mm\", \"-1.5 mm\"]\nmedium = \"cloudy_15\"\nsurface = \"flat\"\n"
      "[[part]]\nname = \"ball\"\nsphere = { radius = \"0.7 mm\", subdivisions = 2 }\nmedium = "
      "\"cloudy_18\"\n"
      "surface = \"flat\"\n" +
      source_in("shell", 1) + cloudy("15", 1.5) + cloudy("18", 1.8));
  SceneBuilder builder;
  const BuiltScene built = builder.build(spec);
  for (const PartInfo& part : built.scene.parts) CHECK(part.curved);
  const double ball = 4.0 / 3.0 * kPi * 0.343, rod = kPi * 3.0 - ball, shell = 36.0 * kPi - kPi * 3.0;
  const double weights[] = {shell, 2.25 * rod, 3.24 * ball};
  const double sum = weights[0] + weights[1] + weights[2];
  const PhotonSource source(spec.source, built.scene);
  // Of windows with a number of interactions, sums have the ratio of the law; the mean of their ratios does
  // not.
  std::vector<std::array<double, 3>> paths;
  std::array<double, 3> total{};
  const int photons = law_photons(4'000);
  for (int i = 0; i < photons; ++i) {
    Rng rng(23, StreamKind::photon, static_cast<std::uint64_t>(i));
    Photon photon = source.emit(built.scene, rng);
    std::array<double, 3> path{};
    constexpr std::uint32_t kFirst = 60, kLast = 460;
    while (photon.interactions < kLast) {
      const std::string name = built.scene.region_names[photon.region];
      const double before = photon.path_mm;
      const bool counts = photon.interactions >= kFirst;
      const Step taken = step(built.scene, photon, rng);
      REQUIRE_FALSE(is_final(taken.event));
      if (counts) path[name == "shell" ? 0 : name == "rod" ? 1 : 2] += photon.path_mm - before;
    }
    paths.push_back(path);
    for (std::size_t k = 0; k < 3; ++k) total[k] += path[k];
  }
  const double all = total[0] + total[1] + total[2];
  const char* const names[] = {"shell", "rod", "ball"};
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = total[k] / all;
    Moments residual;
    for (const std::array<double, 3>& path : paths)
      residual.add((path[k] - share * (path[0] + path[1] + path[2])) * photons / all);
    check_law(std::string("share of the path in the ") + names[k], {share, residual.mean().error},
              {weights[k] / sum, 0.0});
  }
}

TEST_CASE("Law: a fibre of core and cladding keeps light by the critical angle between them") {
  // Rays that leave the core are lost through the wall of the cladding, which a black jacket covers. Light of
  // the core with an angle at its wall beyond that of total reflection stays: as in the bare fibre, with n2 /
  // n1.
  constexpr double kCore = 1.6, kCladding = 1.49;
  const double limit = std::sqrt(1.0 - kCladding * kCladding / (kCore * kCore));
  const double escaping = simpson(
      [&](double theta) {
        const double most = limit / std::sin(theta);
        if (most >= 1.0) return 0.0;
        const double psi = std::acos(most);
        return std::sin(theta) * 2.0 / kPi * (psi + 0.5 * std::sin(2.0 * psi));
      },
      std::asin(limit), 0.5 * kPi, 200'000);
  const Traced traced =
      trace(kVacuum + R"([[part]]
name = "jacket"
cylinder = { radius = "0.6 mm", height = "2000 mm", segments = 12 }
medium = "opaque"
[[part]]
name = "cladding"
cylinder = { radius = "0.5 mm", height = "2000 mm", segments = 16 }
medium = "cladding"
surface = "flat"
[[part]]
name = "core"
cylinder = { radius = "0.48 mm", height = "2000 mm", segments = 10 }
medium = "core"
surface = "flat"
[[part]]
name = "below"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "core", side = "-z" }
sensor = "matched"
[[part]]
name = "above"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "core", side = "+z" }
sensor = "matched"
)" + source_in("core", 200'000, R"(, slab_z = ["999 mm", "1001 mm"])") +
            fmt::format("[media.core]\nindex = {{ n = {} }}\nabsorption = {{ none = true }}\n"
                        "scattering = {{ none = true }}\n"
                        "[media.cladding]\nindex = {{ n = {} }}\nabsorption = {{ none = true }}\n"
                        "scattering = {{ none = true }}\n"
                        "[sensors.matched]\nefficiency = {{ definition = \"internal\", value = 1.0 }}\n"
                        "window = {{ index = 1.6 }}\n",
                        kCore, kCladding));
  check_kept(traced.result, 1.0 - escaping);
}

#ifdef SCINTRAY_TESTS_STEP
TEST_CASE("Fates in a rod and a ball of a STEP file do not depend on its tessellation") {
  for (const StepSolid solid : {StepSolid::cylinder, StepSolid::sphere}) {
    const auto path = scratch_folder("curved_step") / "body.step";
    write_step(path, {{"body", solid, {2.0, 0.0, 9.0}, {1.0, 2.0, 3.0}, {}, {}, ""}});
    std::vector<std::uint64_t> escaped;
    for (const double deviation_mm : {0.2, 0.02, 0.002}) {
      const Traced traced = trace(
          kVacuum + "[[part]]\nname = \"body\"\nmesh = \"" + path.string() + "\"\n" +
          fmt::format("tessellation = {{ deviation = \"{} mm\", angle = \"30 deg\" }}\n", deviation_mm) +
          "medium = \"lso\"\nsurface = \"flat\"\n" + source_in("body", 100'000));
      CHECK(traced.built.scene.parts.front().curved);
      const double volume = solid == StepSolid::sphere ? 4.0 / 3.0 * kPi * 8.0 : kPi * 4.0 * 9.0;
      CHECK(traced.built.scene.parts.front().volume_mm3 == doctest::Approx(volume).epsilon(1e-6));
      escaped.push_back(traced.result.count(Fate::escaped));
    }
    for (const std::uint64_t count : escaped)
      CHECK(std::abs(static_cast<double>(count) - static_cast<double>(escaped.front())) <
            kSigmas * std::sqrt(2.0 * static_cast<double>(count)));
  }
}
#endif
