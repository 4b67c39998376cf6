#include "scintray/analysis/goniometer/measured_profile.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "scintray/core/error.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

std::filesystem::path file_of(const std::string& text) {
  const auto path = scratch_folder("measured_profile") / "measured.csv";
  std::ofstream(path) << text;
  return path;
}

std::string refusal(const std::string& text) {
  return complaint_of([&] { read_measured_profile(file_of(text)); });
}

}  // namespace

TEST_CASE("a measured profile is read with or without heading, comments and errors") {
  const MeasuredProfile plain = read_measured_profile(file_of("-10,1\n0,2\n10,1.5\n"));
  CHECK(plain.angle_deg == std::vector<double>{-10, 0, 10});
  CHECK(plain.error.empty());
  const MeasuredProfile full =
      read_measured_profile(file_of("# counts\nangle_deg,value,error\n0,2,0.1\n90,0,0.05\n"));
  CHECK(full.value == std::vector<double>{2, 0});
  CHECK(full.error == std::vector<double>{0.1, 0.05});
}

TEST_CASE("every wrong row of a measured profile is named with its line") {
  const std::string text = refusal("angle_deg,value,error\n0,1,0.1\n0,1,0.1\n95,1,0.1\n96,-1,-2\n");
  CHECK(contains(text, "measured.csv:3"));
  CHECK(contains(text, "expected them to increase"));
  CHECK(contains(text, "measured.csv:4"));
  CHECK(contains(text, "an angle of 95 deg"));
  CHECK(contains(text, "a value of -1"));
  CHECK(contains(text, "an error of -2"));
  CHECK(contains(refusal("0,1\n10,x\n"), "measured.csv:2:4"));
  CHECK(contains(refusal("0\n10\n"), "rows of 1 values"));
  CHECK(contains(refusal("0,1,2,3\n10,1,2,3\n"), "rows of 4 values"));
  CHECK(contains(refusal("0,1\n"), "expected two at least"));
  CHECK(contains(refusal("0,0\n10,0\n"), "no value above 0"));
  CHECK(contains(refusal(""), "no rows"));
}

TEST_CASE("a measurement is scaled to the same area over the angles that it has") {
  DirectionCounts reading;
  constexpr std::uint64_t kRays = 1'000'000;
  const double half_width = 0.1, per_count = 1.0 / (kRays * profile_bin_sr(half_width));
  MeasuredProfile measured;
  for (std::size_t k = 0; k < reading.profile.size(); ++k) {
    const double angle = profile_edge_deg(static_cast<int>(k)) + 0.5;
    reading.profile[k] =
        static_cast<std::uint64_t>(1000.0 * std::exp(-0.5 * std::pow((angle - 40.0) / 12.0, 2)));
    if (angle > 0.0 && angle < 60.0) {  // the same curve in another unit, over a part of it
      measured.angle_deg.push_back(angle);
      measured.value.push_back(3.7 * static_cast<double>(reading.profile[k]));
      measured.error.push_back(7.4);
    }
  }
  const ScaledProfile scaled = scale_to(measured, reading, kRays, half_width);
  CHECK(scaled.factor == doctest::Approx(per_count / 3.7));
  CHECK(scaled.rms < 1e-12);
  CHECK(scaled.profile.error.front() == doctest::Approx(2.0 * per_count));

  // Twice as wide, the area is kept and the difference seen.
  MeasuredProfile flat;
  flat.angle_deg = {10.0, 70.0};
  flat.value = {5.0, 5.0};
  CHECK(scale_to(flat, reading, kRays, half_width).rms > 0.0);

  const DirectionCounts dark;
  CHECK_THROWS_AS(scale_to(measured, dark, kRays, half_width), InputError);
}
