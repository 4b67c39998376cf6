// Photocathodes by n, k and thickness: counts of traced photons beside the characteristic matrix of the film.
#include <cmath>
#include <complex>

#include "physics/traced.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

using Complex = std::complex<double>;

constexpr double kGlass = 1.47, kReal = 2.7, kImaginary = 1.5, kThickness_nm = 26.0, kLight_nm = 420.0;

/// Shares of the light that a film reflects, transmits and absorbs.
struct FilmShares {
  double reflected = 0.0, transmitted = 0.0;
  double absorbed() const { return 1.0 - reflected - transmitted; }
};

/// Shares of one polarisation by the characteristic matrix of F. Abeles: [E, H] at the first face is M [1, Y]
/// at the last, with the admittance n cos(theta) for s and n / cos(theta) for p. Another formula than the
/// program's recursion of Airy sums.
FilmShares by_matrix(double cos_i, double n1, double n3, bool p) {
  const double transverse = n1 * std::sqrt(1.0 - cos_i * cos_i);
  const auto cosine = [&](Complex n) {
    const Complex c = std::sqrt(1.0 - transverse * transverse / (n * n));
    return (n * c).imag() < 0.0 ? -c : c;
  };
  const auto admittance = [&](Complex n) { return p ? n / cosine(n) : n * cosine(n); };
  const Complex n2(kReal, kImaginary), i(0.0, 1.0);
  // Fields as exp(-i omega t): a wave forward in the film has the phase +delta.
  const Complex delta = kTwoPi * n2 * cosine(n2) * kThickness_nm / kLight_nm;
  const Complex y1 = admittance(n1), y2 = admittance(n2), y3 = admittance(n3);
  const Complex e = std::cos(delta) - i * std::sin(delta) * y3 / y2;
  const Complex h = -i * y2 * std::sin(delta) + std::cos(delta) * y3;
  const Complex r = (y1 * e - h) / (y1 * e + h), t = 2.0 * y1 / (y1 * e + h);
  return {std::norm(r), y3.real() / y1.real() * std::norm(t)};
}

FilmShares unpolarised(double cos_i, double n1, double n3) {
  const FilmShares s = by_matrix(cos_i, n1, n3, false), p = by_matrix(cos_i, n1, n3, true);
  return {0.5 * (s.reflected + p.reflected), 0.5 * (s.transmitted + p.transmitted)};
}

const std::string kCathode = R"(
ambient = "vacuum_n1"
[media.glass147]
index = { n = 1.47 }
absorption = { none = true }
scattering = { none = true }
[run]
efficiency_at_birth = false
)";

std::string cathode_sensor(const std::string& efficiency, const std::string& more = "") {
  return "[sensors.bialkali]\nphotocathode = { n = 2.7, k = 1.5, thickness = \"26 nm\" }\n" + more +
         "efficiency = { " + efficiency + " }\n";
}

/// A window from z = 0 to 1 mm, on a black part with its index that takes what comes back.
std::string window_with(const std::string& face) {
  return R"(
[[part]]
name = "window"
box = { low = ["-900 mm", "-900 mm", "0 mm"], high = ["900 mm", "900 mm", "1 mm"] }
medium = "glass147"
surface = "flat"
)" + face +
         R"(
[[part]]
name = "below"
box = { low = ["-900 mm", "-900 mm", "-1 mm"], high = ["900 mm", "900 mm", "0 mm"] }
medium = "opaque"
)";
}

const std::string kFaceSensor =
    "[[part.face]]\nname = \"cathode\"\nselect = { normal = [0, 0, 1] }\nsensor = \"bialkali\"\n";

std::string beam(double z_mm, double cosine, double towards) {
  return fmt::format(
      "[source]\ntype = \"photons\"\nposition = [\"0 mm\", \"0 mm\", \"{} mm\"]\ndirection = [{:.17g}, 0, "
      "{:.17g}]\nwavelength = \"420 nm\"\nphotons = 100_000\n",
      z_mm, std::sqrt(1.0 - cosine * cosine), towards * cosine);
}

void check_counts(const PointResult& result, const FilmShares& film, double escape, Fate reflected,
                  Fate transmitted) {
  check_fraction(result, Fate::detected, escape * film.absorbed());
  check_fraction(result, Fate::not_detected, (1.0 - escape) * film.absorbed());
  check_fraction(result, reflected, film.reflected);
  check_fraction(result, transmitted, film.transmitted);
}

}  // namespace

TEST_CASE("Law of a photocathode: absorptance times escape is detected at every angle, from either side") {
  constexpr double kEscape = 0.6;
  const std::string scene =
      kCathode + cathode_sensor("definition = \"absorbed\", value = 0.6") + window_with(kFaceSensor);
  // 42.9 deg is the critical angle of glass to vacuum.
  for (const double degrees : {0.0, 30.0, 42.0, 44.0, 60.0, 85.0}) {
    CAPTURE(degrees);
    const double cosine = std::cos(degrees * kDegree);
    const FilmShares film = unpolarised(cosine, kGlass, 1.0);
    CHECK((film.transmitted > 1e-12) == (degrees < 42.9));
    check_counts(trace(scene + beam(0.5, cosine, 1.0)).result, film, kEscape, Fate::absorbed_in_medium,
                 Fate::escaped);
  }
  for (const double degrees : {0.0, 70.0}) {
    const double cosine = std::cos(degrees * kDegree);
    check_counts(trace(scene + beam(3.0, cosine, -1.0)).result, unpolarised(cosine, 1.0, kGlass), kEscape,
                 Fate::escaped, Fate::absorbed_in_medium);
  }
}

TEST_CASE(
    "A published efficiency at normal incidence is that of the photocathode, with or without the window") {
  const auto detected = [](const std::string& sensor, double cosine) {
    return trace(kCathode + sensor + window_with(kFaceSensor) + beam(0.5, cosine, 1.0))
        .result.fraction(Fate::detected);
  };
  const std::string internal =
      cathode_sensor("definition = \"internal\", value = 0.25", "window = { index = 1.47 }\n");
  check_law("internal", detected(internal, 1.0), {0.25, 0.0});
  const double entering = 1.0 - std::pow(0.47 / 2.47, 2);
  const std::string external = cathode_sensor(
      "definition = \"external\", value = 0.25, reference_index = 1.0", "window = { index = 1.47 }\n");
  check_law("external", detected(external, 1.0), {0.25 / entering, 0.0});
  const double cosine = 0.5, escape = 0.25 / unpolarised(1.0, kGlass, 1.0).absorbed();
  check_law("internal, 60 deg", detected(internal, cosine),
            {escape * unpolarised(cosine, kGlass, 1.0).absorbed(), 0.0});
}

TEST_CASE("The vacuum of a tube as a sensor: its films convert light from both sides, through both") {
  const std::string tube = R"(
[[part]]
name = "tube"
box = { low = ["-900 mm", "-900 mm", "1 mm"], high = ["900 mm", "900 mm", "2 mm"] }
medium = "vacuum_n1"
sensor = "bialkali"
)";
  const PointResult result = trace(kCathode + cathode_sensor("definition = \"absorbed\", value = 0.6") +
                                   window_with("") + tube + beam(0.5, 1.0, 1.0))
                                 .result;
  // First film glass | vacuum, second vacuum | vacuum; x is what arrives at the second in all.
  const FilmShares first = unpolarised(1.0, kGlass, 1.0), back = unpolarised(1.0, 1.0, kGlass),
                   second = unpolarised(1.0, 1.0, 1.0);
  CHECK(first.transmitted == doctest::Approx(back.transmitted).epsilon(1e-12));  // reciprocity
  const double x = first.transmitted / (1.0 - back.reflected * second.reflected);
  const double absorbed = first.absorbed() + x * (second.absorbed() + second.reflected * back.absorbed());
  check_fraction(result, Fate::detected, 0.6 * absorbed);
  check_fraction(result, Fate::escaped, x * second.transmitted);
}

TEST_CASE("A photocathode whose place in a scene contradicts itself is refused") {
  const auto refused = [](const std::string& text, const std::string& words) {
    CAPTURE(words);
    std::string found;
    try {
      trace(kCathode + cathode_sensor("definition = \"absorbed\", value = 0.6") + text + beam(0.5, 1.0, 1.0));
    } catch (const InputError& error) {
      found = error.what();
    }
    CHECK(found.find(words) != std::string::npos);
  };
  const std::string box =
      "box = { low = [\"-900 mm\", \"-900 mm\", \"1 mm\"], high = [\"900 mm\", \"900 mm\", "
      "\"2 mm\"] }\n";
  refused(window_with("") + "[[part]]\nname = \"tube\"\n" + box + "sensor = \"bialkali\"\n",
          "has a photocathode, but no medium behind it");
  refused(window_with(kFaceSensor + "surface = \"white\"\n"), "which is the surface itself");
  refused(window_with(kFaceSensor) + "[[part]]\nname = \"tube\"\n" + box +
              "medium = \"vacuum_n1\"\nsurface = \"flat\"\n[[contact]]\nbetween = [\"window\", "
              "\"tube\"]\nkind = \"dry\"\n",
          "which is bonded and the only surface there");
}
