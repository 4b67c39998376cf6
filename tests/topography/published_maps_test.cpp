/// Published height maps load with their known figures, or request what they lack. The figures are
/// those of an independent reading of the same files, after subtracting the least-squares plane.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "map_files.hpp"
#include "scintray/core/error.hpp"
#include "scintray/topography/height_map.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/prepare.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::topography;
using namespace scintray::test;

namespace {

struct Published {
  const char* file;
  const char* channel;  ///< or nullptr
  std::uint32_t columns, rows;
  double pitch_x_um, pitch_y_um;
  double sq_nm, sq_digit, sz_nm, sz_digit;  ///< and the value of their last digit
};

std::optional<HeightMap> load(const std::string& name, const ReadOptions& options = {}) {
  const auto path = test::shared_file("data/topography/" + name);
  if (!path) return std::nullopt;
  return read_height_map(*path, options);
}

}  // namespace

TEST_CASE("published maps have their known heights after levelling") {
  const Published maps[] = {
      {"di-3.di", "Height Sensor", 256, 256, 10.0 / 256, 10.0 / 256, 35.22, 0.01, 409, 1},
      {"di-3.di", nullptr, 256, 256, 10.0 / 256, 10.0 / 256, 35.22, 0.01, 409, 1},
      {"di-3.di", "Height", 256, 256, 10.0 / 256, 10.0 / 256, 45.5, 0.1, 509, 1},
      {"di-5.di", nullptr, 512, 512, 1.0 / 512, 1.0 / 512, 1.54, 0.01, 9.0, 0.1},
      {"mi-1.mi", nullptr, 256, 256, 20.0 / 256, 20.0 / 256, 3.43, 0.01, 42.4, 0.1},
      {"matrix-2.txt.gz", nullptr, 650, 650, 0.369862, 0.369862, 276, 1, 3360, 10},
      {"x3p-2.x3p", nullptr, 650, 650, 0.127656509837346, 0.314582113527746, 77.2, 0.1, 552, 1},
      {"P0089OP0027.ibw", nullptr, 256, 256, 2.0 / 255, 2.0 / 255, 8.09, 0.01, 47.6, 0.1},
      {"chip.gsf", nullptr, 300, 300, 80.0 / 300, 80.0 / 300, 1274, 1, 4500, 10},
      {"chip.gwy", nullptr, 300, 300, 80.0 / 300, 80.0 / 300, 1274, 1, 4500, 10}};
  for (const Published& published : maps) {
    CAPTURE(published.file);
    ReadOptions options;
    if (published.channel) options.channel = published.channel;
    auto map = load(published.file, options);
    if (!map) return;
    CHECK(map->columns == published.columns);
    CHECK(map->rows == published.rows);
    CHECK(map->pitch_x_um == doctest::Approx(published.pitch_x_um).epsilon(1e-9));
    CHECK(map->pitch_y_um == doctest::Approx(published.pitch_y_um).epsilon(1e-9));
    level_plane(*map);
    const MapStatistics statistics = map_statistics(*map);
    CHECK(std::abs(statistics.sq_um * 1e3 - published.sq_nm) <= 0.5 * published.sq_digit);
    CHECK(std::abs(statistics.sz_um * 1e3 - published.sz_nm) <= 0.5 * published.sz_digit);
  }
}

TEST_CASE("the height that the sensor measured has Sq 35.22 nm; slopes and Sa agree as well") {
  auto map = load("di-3.di");
  if (!map) return;
  CHECK(contains(map->steps[0], "channel \"Height Sensor\" of 4"));
  level_plane(*map);
  const MapStatistics statistics = map_statistics(*map);
  CHECK(std::abs(statistics.sq_um * 1e3 - 35.22) <= 0.01);
  CHECK(std::abs(statistics.sa_um * 1e3 - 26.23) <= 0.01);
  // The published slopes count the 10 um from the first point to the last, 255 pitches.
  CHECK(std::abs(statistics.rms_slope_x * 255 / 256 - 0.132) <= 0.0005);
  CHECK(std::abs(statistics.rms_slope_y * 255 / 256 - 0.139) <= 0.0005);
}

TEST_CASE("the same scan in two formats is the same map") {
  const auto field = load("chip.gsf"), container = load("chip.gwy");
  if (!field || !container) return;
  REQUIRE(field->columns == container->columns);
  REQUIRE(field->rows == container->rows);
  CHECK(field->pitch_x_um == doctest::Approx(container->pitch_x_um).epsilon(1e-6));
  CHECK(field->pitch_y_um == doctest::Approx(container->pitch_y_um).epsilon(1e-6));
  double largest = 0.0;
  for (std::size_t k = 0; k < field->heights_um.size(); ++k)
    largest = std::max(largest, std::abs(field->heights_um[k] / container->heights_um[k] - 1.0));
  CHECK(largest <= 6.0e-8);  // half a unit of the last bit in single precision
}

TEST_CASE("the channels of published files are there by name") {
  const auto nanoscope = test::shared_file("data/topography/di-3.di");
  const auto igor = test::shared_file("data/topography/P0089OP0027.ibw");
  const auto picoview = test::shared_file("data/topography/mi-1.mi");
  if (!nanoscope || !igor || !picoview) return;
  ReadOptions options;
  options.channel = "Amplitude Error";
  CHECK(contains(complaint(*nanoscope, options), "\"mV\""));
  options.channel = "Heigth";
  CHECK(contains(complaint(*nanoscope, options),
                 "the channels are \"Height Sensor\", \"Amplitude Error\", \"Phase\", \"Height\""));
  CHECK(contains(complaint(*igor, options),
                 "\"HeightRetrace\", \"AmplitudeRetrace\", \"DeflectionRetrace\", "
                 "\"PhaseRetrace\", \"UserIn0Retrace\""));
  CHECK(contains(complaint(*picoview, options), "\"Friction (Trace)\", \"Friction (Retrace)\""));
  options.channel = "heightr";
  CHECK(contains(read_height_map(*igor, options).steps[0], "\"HeightRetrace\" of 5"));
  options.channel = "Phase";
  CHECK(contains(complaint(*igor, options), "\"PhaseRetrace\" is in \"deg\""));
  options.channel = "User";
  CHECK(contains(complaint(*igor, options), "\"UserIn0Retrace\" is in \"V\""));
}

TEST_CASE("a published scan with missing points keeps them, and is refused where all are needed") {
  const auto map = load("sample-land.x3p");
  if (!map) return;
  CHECK(map->columns == 918);
  CHECK(map->rows == 256);
  CHECK(map->pitch_x_um == doctest::Approx(2.58));
  CHECK(missing_points(*map) == 25292);
  CHECK(map->steps.back() == "25292 of 235008 points missing");
  CHECK(map->heights_um[0] == doctest::Approx(-54.21108289738186));
  CHECK_THROWS_AS(make_height_field(*map), InputError);
}

TEST_CASE("published files without units require them") {
  for (const char* name : {"10x10-one_channel_without_name.ibw", "gwyfile-test.gwy", "xyz-1.txt"}) {
    CAPTURE(name);
    const auto path = test::shared_file(std::string("data/topography/") + name);
    if (!path) return;
    CHECK(contains(complaint(*path), "--width"));
    CHECK(contains(complaint(*path), "--unit"));
    ReadOptions options;
    options.width_um = 10.0;
    options.height_unit_um = 1.0;
    const HeightMap map = read_height_map(*path, options);
    CHECK(map.pitch_x_um == doctest::Approx(10.0 / map.columns));
    CHECK(map.pitch_y_um == doctest::Approx(map.pitch_x_um));
    CHECK(contains(map.steps[0], "heights in units of 1 um as given"));
  }
}

TEST_CASE("small published text files are read with their units") {
  for (const char* name : {"gwyddion-export-english.txt", "gwyddion-export-german.txt"}) {
    CAPTURE(name);
    const auto path = test::shared_file(std::string("data/topography/") + name);
    if (!path) return;
    CHECK(contains(complaint(*path), "different units"));  // metres of height over micrometres of width
    ReadOptions options;
    options.height_unit_um = 1.0;
    const HeightMap map = read_height_map(*path, options);
    CHECK(map.columns == 3);
    CHECK(map.rows == 4);
    CHECK(map.pitch_x_um == doctest::Approx(12.34 / 3));
    CHECK(map.pitch_y_um == doctest::Approx(5.6789 / 4));
    CHECK(map.title == "My Channel Name");
    CHECK(map.at(1, 0) == doctest::Approx(1.5));
  }
  const auto gauge = load("sdf-1.sdf");
  if (!gauge) return;
  CHECK(gauge->columns == 7);
  CHECK(gauge->rows == 4);
  CHECK(gauge->pitch_x_um == doctest::Approx(1.0));
  CHECK(gauge->at(6, 3) == doctest::Approx(0.97986));
}

TEST_CASE("a published Nanoscope file of version 7.2 has the heights of its full scale") {
  const auto path = test::shared_file("data/topography/di-1.di");
  if (!path) return;
  const HeightMap map = read_height_map(*path);
  CHECK(map.columns == 512);
  CHECK(map.pitch_x_um == doctest::Approx(0.5 / 512));
  const auto [low, high] = std::minmax_element(map.heights_um.begin(), map.heights_um.end());
  // 2.910461 V of full scale at 20.82646 nm/V: all heights lie within 60.615 nm.
  CHECK(*high - *low <= 0.060615);
  CHECK(*high - *low > 0.0);
}
