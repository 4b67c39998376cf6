#include "scintray/analysis/fit/measured_curve.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

std::filesystem::path curve_file(const std::string& text) {
  const auto path = scratch_folder("measured_curve") / "light.csv";
  std::ofstream(path) << text;
  return path;
}

std::string curve_refusal(const std::string& text) {
  return complaint_of([&] { read_measured_curve(curve_file(text)); });
}

}  // namespace

TEST_CASE("a measured curve is read with or without heading, comments and errors") {
  const MeasuredCurve full =
      read_measured_curve(curve_file("# a bar\ndepth,light,error\n2,310,5\n6,280,4\n"));
  REQUIRE(full.points.size() == 2);
  CHECK(full.has_errors);
  CHECK(full.points[1].x == 6.0);
  CHECK(full.points[1].y.value == 280.0);
  CHECK(full.points[1].y.error == 4.0);
  CHECK(full.points[1].where.line == 4);
  const MeasuredCurve bare = read_measured_curve(curve_file("2,310\n6,280\n"));
  CHECK_FALSE(bare.has_errors);
  CHECK(bare.points[0].y.error == 0.0);
}

TEST_CASE("every wrong row of a measured curve is named with its line") {
  const std::string text = curve_refusal("depth,light,error\n6,280,4\n2,310,5\n8,-1,4\n9,250,0\n10,240,-3\n");
  CHECK(contains(text, "light.csv:3"));
  CHECK(contains(text, "a position of 2 after 6; expected them to increase"));
  CHECK(contains(text, "light.csv:4"));
  CHECK(contains(text, "a value of -1"));
  CHECK(contains(text, "light.csv:5"));
  CHECK(contains(text, "an error of 0; expected more than 0"));
  CHECK(contains(text, "an error of -3"));
  CHECK(contains(curve_refusal("2,310,5,1\n"), "rows of 4 values"));
  CHECK(contains(curve_refusal("2,0,5\n6,0,4\n"), "no value above 0"));
}
