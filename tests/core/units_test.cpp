#include "scintray/core/units.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <string>

#include "scintray/core/error.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;
using doctest::Approx;

namespace {

Problem problem_of(const std::string& text, Dimension dimension) {
  try {
    parse_quantity(text, dimension);
  } catch (const InputError& error) {
    return error.problems().at(0);
  }
  return {};
}

}  // namespace

TEST_CASE("Quantities come out in internal units") {
  CHECK(parse_quantity("2 mm", Dimension::length) == Approx(2.0));
  CHECK(parse_quantity("2mm", Dimension::length) == Approx(2.0));
  CHECK(parse_quantity("  -1.5e2 um ", Dimension::length) == Approx(-0.15));
  CHECK(parse_quantity("1 µm", Dimension::length) == Approx(1e-3));
  CHECK(parse_quantity("1 in", Dimension::length) == Approx(25.4));
  CHECK(parse_quantity("0.5 1/cm", Dimension::inverse_length) == Approx(0.05));
  CHECK(parse_quantity("420 nm", Dimension::wavelength) == Approx(420.0));
  CHECK(parse_quantity("2.95 eV", Dimension::wavelength) == Approx(420.28542).epsilon(1e-7));
  CHECK(parse_quantity("40 ps", Dimension::time) == Approx(0.04));
  CHECK(parse_quantity("180 deg", Dimension::angle) == Approx(std::numbers::pi));
  CHECK(parse_quantity("0.511 MeV", Dimension::energy) == Approx(511.0));
  CHECK(parse_quantity("7400 kg/m3", Dimension::density) == Approx(7.4));
  CHECK(parse_quantity("30000 photons/MeV", Dimension::photons_per_energy) == Approx(30.0));
  CHECK(parse_quantity("2 MHz", Dimension::frequency) == Approx(0.002));
  CHECK(parse_quantity("97 %", Dimension::dimensionless) == Approx(0.97));
  CHECK(parse_quantity("0.97", Dimension::dimensionless) == Approx(0.97));
}

TEST_CASE("Every unit that a dimension lists is understood in it") {
  for (const Dimension dimension :
       {Dimension::length, Dimension::inverse_length, Dimension::wavelength, Dimension::time,
        Dimension::frequency, Dimension::angle, Dimension::energy, Dimension::density,
        Dimension::photons_per_energy, Dimension::dimensionless}) {
    CAPTURE(dimension_name(dimension));
    CHECK_FALSE(units_of(dimension).empty());
    for (const std::string& unit : units_of(dimension)) CHECK(parse_quantity("2 " + unit, dimension) > 0.0);
  }
}

TEST_CASE("A bare number where a dimension is expected is refused with the units to add") {
  const Problem problem = problem_of("2", Dimension::length);
  CHECK(contains(problem.what, "\"2\" has no unit"));
  CHECK(contains(problem.what, "length"));
  CHECK(contains(problem.hint, "mm"));
}

TEST_CASE("A unit of another dimension is refused with the units that would do") {
  const Problem problem = problem_of("3 ns", Dimension::length);
  CHECK(contains(problem.what, "\"ns\" is not a unit of length"));
  CHECK(contains(problem.hint, "mm"));
  CHECK_FALSE(contains(problem.hint, "ns"));
}

TEST_CASE("What is not a finite number is refused with an example in the usual unit") {
  for (const char* text : {"", "mm", "two mm", "nan mm", "inf mm", "1e999 mm", "--2 mm"}) {
    CAPTURE(text);
    const Problem problem = problem_of(text, Dimension::length);
    CHECK(contains(problem.what, "finite number"));
    CHECK(contains(problem.hint, "\"2 mm\""));
  }
}

TEST_CASE("A photon energy must be positive to be a wavelength") {
  CHECK(contains(problem_of("0 eV", Dimension::wavelength).hint, "positive"));
  CHECK(contains(problem_of("-1 eV", Dimension::wavelength).hint, "positive"));
}

TEST_CASE("A unit with a slip, in other letters or of other programs names the one that is meant") {
  const auto hint = [](const std::string& text, Dimension dimension) {
    return problem_of(text, dimension).hint;
  };
  CHECK(contains(hint("20 mms", Dimension::length), "\"20 mm\""));
  CHECK(contains(hint("511 KEV", Dimension::energy), "\"511 keV\""));
  CHECK(contains(hint("90 degrees", Dimension::angle), "\"90 deg\""));
  CHECK(contains(hint("90°", Dimension::angle), "\"90 deg\""));
  CHECK(contains(hint("7.4 g/cm^3", Dimension::density), "\"7.4 g/cm3\""));
  CHECK(contains(hint("20*mm", Dimension::length), "\"20 mm\""));
}

TEST_CASE("A unit of another dimension is named as such, and articles fit") {
  CHECK(contains(problem_of("5 mm", Dimension::time).what, "not a unit of time, but of length"));
  CHECK(contains(problem_of("5", Dimension::angle).what, "an angle is expected"));
  CHECK(contains(problem_of("5", Dimension::length).what, "a length is expected"));
}

TEST_CASE("A decimal comma and a typographic minus are named") {
  const Problem comma = problem_of("0,1 mm", Dimension::length);
  CHECK(contains(comma.what, "comma"));
  CHECK(contains(comma.hint, "\"0.1 mm\""));
  const Problem minus = problem_of("\u22123 mm", Dimension::length);
  CHECK(contains(minus.what, "minus"));
  CHECK(contains(minus.hint, "\"-3 mm\""));
}

TEST_CASE("The Greek mu stands for the micro sign, which looks the same") {
  CHECK(parse_quantity("1 \u03bcm", Dimension::length) == Approx(1e-3));
}
