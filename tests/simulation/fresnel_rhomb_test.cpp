// Elliptical polarisation in traced scenes: a Fresnel rhomb, with an analyser at Brewster's angle.
#include <cmath>
#include <complex>
#include <fstream>

#include "physics/traced.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

constexpr double kRhombIndex = 1.5;

/// Phase of p over s of one total reflection, from Fresnel's amplitudes with an imaginary cosine of
/// refraction.
double phase_of_reflection(double angle) {
  const std::complex<double> cos_t(0.0, std::sqrt(std::pow(kRhombIndex * std::sin(angle), 2) - 1.0));
  const double cos_i = std::cos(angle);
  const auto r_s = (kRhombIndex * cos_i - cos_t) / (kRhombIndex * cos_i + cos_t);
  const auto r_p = (cos_i - kRhombIndex * cos_t) / (cos_i + kRhombIndex * cos_t);
  return std::arg(r_p / r_s);
}

/// A rhomb whose long faces light along x is incident on at `angle`, 1 mm high at its entrance at x = 0, cut
/// across at about x = `length_mm` by a plane to whose normal light along x is at Brewster's angle from
/// within. The plane of incidence there is turned about x by `turn` from that of the long faces.
std::string rhomb_with_analyser(double angle, double length_mm, double turn) {
  const double brewster = std::atan(1.0 / kRhombIndex);
  const Vec3 cut(std::cos(brewster), std::sin(brewster) * std::sin(turn),
                 std::sin(brewster) * std::cos(turn));
  const Vec3 along(std::sin(angle), 0.0, std::cos(angle));
  const Vec3 middle = Vec3(0.0, 0.0, 0.5) + length_mm / along.x() * along;
  std::string text;
  for (const auto& [y, z] :
       {std::pair{-0.3, 0.0}, std::pair{0.3, 0.0}, std::pair{0.3, 1.0}, std::pair{-0.3, 1.0}}) {
    const Vec3 start(0.0, y, z), end = start + cut.dot(middle - start) / cut.dot(along) * along;
    for (const Vec3& v : {start, end})
      text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z());
  }
  text += "f 1 7 5 3\nf 2 4 6 8\nf 1 3 4 2\nf 3 5 6 4\nf 5 7 8 6\nf 7 1 2 8\n";
  const auto path =
      scratch_folder("fresnel_rhomb") / fmt::format("rhomb_{:.0f}_{:.3f}.obj", 1e6 * length_mm, turn);
  std::ofstream(path) << text;
  return path.string();
}

struct Analysed {
  Estimate transmitted;
  double expected = 0.0;
};

/// Light at 45 deg to the plane of incidence, after `reflections` total reflections, at the analyser.
Analysed analyse(double angle, int reflections, double turn, const std::string& state) {
  // Light along x from z = 0.5 is reflected at x = tan(angle) / 2, then by -cos(2 angle) tan(angle) later,
  // then by tan(angle) later, and so on; the rhomb ends halfway to the next reflection.
  const double tangent = std::tan(angle);
  const double last = 0.5 * tangent - std::cos(2.0 * angle) * tangent +
                      (0.5 * reflections - 1.0) * tangent * (1.0 - std::cos(2.0 * angle));
  const std::string file = rhomb_with_analyser(angle, last + 0.5 * tangent, turn);
  // Transmitted light has one interaction more than the total reflections, and escapes; what is reflected at
  // the analyser is cut.
  const PointResult result = trace(fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "rhomb"
mesh = "{}"
unit = "mm"
medium = "n15"
surface = "flat"
[source]
type = "photons"
position = ["0.01 mm", "0 mm", "0.5 mm"]
direction = [1, 0, 0]
polarisation = [0, 1, 1]
wavelength = "420 nm"
photons = 40_000
[run]
max_interactions = {}
polarisation = "{}"
)",
                                               file, reflections + 2, state))
                                 .result;
  // The analyser reflects R of the light across its plane of incidence, and nothing of the light in it.
  const double n2 = kRhombIndex * kRhombIndex, reflectance = std::pow((n2 - 1.0) / (n2 + 1.0), 2);
  const double phase = reflections * phase_of_reflection(angle);
  const double across = 0.5 * (1.0 - std::sin(2.0 * turn) * std::cos(phase));
  return {result.fraction(Fate::escaped), 1.0 - reflectance * across};
}

/// The angle of incidence at which a total reflection shifts the phase by 45 deg, the larger of the two.
double rhomb_angle() {
  double low = 51.7 * kDegree, high = 80.0 * kDegree;  // the phase falls from its maximum
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::abs(phase_of_reflection(middle)) > 0.25 * kPi ? low : high) = middle;
  }
  return low;
}

}  // namespace

TEST_CASE(
    "Law of the Fresnel rhomb: two total reflections make linear light circular, four turn it by 90 deg") {
  const double angle = rhomb_angle();
  CAPTURE(angle / kDegree);
  CHECK(std::abs(std::remainder(4.0 * phase_of_reflection(angle), kTwoPi)) ==
        doctest::Approx(kPi).epsilon(1e-9));
  for (const int reflections : {2, 4})
    for (const double turn : {0.0, 45.0, 90.0, 135.0}) {
      const Analysed found = analyse(angle, reflections, turn * kDegree, "elliptical");
      check_law(fmt::format("{} reflections, analyser at {:g} deg", reflections, turn), found.transmitted,
                {found.expected, 0.0});
    }
}

TEST_CASE("Law of the phase of total reflection, at other angles; a linear state does not have it") {
  for (const double degrees : {47.0, 60.0, 75.0}) {
    const Analysed found = analyse(degrees * kDegree, 2, 45.0 * kDegree, "elliptical");
    check_law(fmt::format("{:g} deg", degrees), found.transmitted, {found.expected, 0.0});
  }
  const Analysed linear = analyse(rhomb_angle(), 2, 45.0 * kDegree, "linear");
  CHECK(std::abs(linear.transmitted.value - linear.expected) > 10.0 * linear.transmitted.error);
}

TEST_CASE("Elliptical polarisation of a source of unpolarised light is refused") {
  std::string found;
  try {
    trace(R"(
ambient = "vacuum_n1"
[source]
type = "photons"
position = ["0 mm", "0 mm", "0 mm"]
direction = [1, 0, 0]
polarisation = "unpolarised"
wavelength = "420 nm"
photons = 10
[run]
polarisation = "elliptical"
)");
  } catch (const InputError& error) {
    found = error.what();
  }
  CHECK(found.find("the light of the source is unpolarised") != std::string::npos);
}
