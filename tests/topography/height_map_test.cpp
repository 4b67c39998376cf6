#include "scintray/topography/height_map.hpp"
#include "map_files.hpp"

#include <doctest/doctest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "scintray/core/error.hpp"
#include "scintray/topography/map_statistics.hpp"
#include "scintray/topography/prepare.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;
using namespace scintray::test;

namespace {

HeightMap ramp() {
  HeightMap map;
  map.columns = 5;
  map.rows = 3;
  map.pitch_x_um = 0.5;
  map.pitch_y_um = 0.25;
  map.title = "ramp";
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 5; ++i) map.heights_um.push_back(1.0 + 2.0 * i - 3.0 * j);
  return map;
}

}  // namespace

TEST_CASE("a simple field is read as it was written") {
  const auto path = written("ramp.gsf", "");
  write_gsf(path, ramp());
  const HeightMap map = read_height_map(path);
  CHECK(map.columns == 5);
  CHECK(map.rows == 3);
  CHECK(map.title == "ramp");
  CHECK(map.pitch_x_um == doctest::Approx(0.5));
  CHECK(map.pitch_y_um == doctest::Approx(0.25));
  for (std::size_t k = 0; k < 15; ++k)
    CHECK(map.heights_um[k] == doctest::Approx(ramp().heights_um[k]).epsilon(1e-6));
}

TEST_CASE("simple fields of a wrong size, or that lack a pixel, are refused") {
  const auto path = written("cut.gsf", "");
  write_gsf(path, ramp());
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 4);
  CHECK(contains(complaint(path), "truncated"));
  CHECK(contains(
      complaint(written("huge.gsf",
                        std::string("Gwyddion Simple Field 1.0\nXRes = 999999\nYRes = 999999\n\0\0", 56))),
      "expected"));
  CHECK(contains(complaint(written("none.gsf", std::string("Gwyddion Simple Field 1.0\nYRes = 2\n\0", 36))),
                 "XRes is missing"));
}

TEST_CASE("missing points are kept as such, counted, and refused where light interacts with the map") {
  HeightMap holed = ramp();
  holed.at(3, 1) = holed.at(4, 2) = std::nan("");
  const auto path = written("nan.gsf", "");
  write_gsf(path, holed);
  const HeightMap map = read_height_map(path);
  CHECK(std::isnan(map.at(3, 1)));
  CHECK(missing_points(map) == 2);
  CHECK(map.steps.back() == "2 of 15 points missing");
  try {
    make_height_field(map);
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(contains(error.problems().front().text(), "2 of 15 points"));
    CHECK(contains(error.problems().front().hint, "--fill"));
  }
  ReadOptions um;
  um.pitch_um = um.height_unit_um = 1.0;
  CHECK(missing_points(read_height_map(written("nan.txt", "1 nan\n3 4\n"), um)) == 1);
  CHECK(contains(complaint(written("all.txt", "nan nan\nnan nan\n"), um), "no point of the map"));
  CHECK(contains(complaint(written("inf.txt", "1 2\n3 inf\n"), um), "column 2, row 2 is infinite"));
  CHECK(contains(complaint(written("huge.txt", "1 2\n3 1e308\n"), {{}, 1.0, 1e6, {}, false, false}),
                 "infinite"));
}

TEST_CASE("Gwyddion's text export is read with its units, in English, German and Latin-1") {
  const std::string numbers = "# Value units: nm\n1\t2\t3\n4\t5\t6.5e0\n";
  for (const std::string head : {"# Channel: a\n# Width: 30 \xC2\xB5m\n# Height: 4000 nm\n",
                                 "# Kanal: a\n# Breite: 30 \xCE\xBCm\n# H\xC3\xB6he: 4000 nm\n",
                                 "# Kanal: a\n# Breite: 30 \xB5m\n# H\xF6he: 0.004 mm\r\n"}) {
    const HeightMap map = read_height_map(written("export.txt", head + numbers));
    CHECK(map.columns == 3);
    CHECK(map.rows == 2);
    CHECK(map.title == "a");
    CHECK(map.pitch_x_um == doctest::Approx(10.0));
    CHECK(map.pitch_y_um == doctest::Approx(2.0));
    CHECK(map.at(2, 1) == doctest::Approx(6.5e-3));
  }
}

TEST_CASE("a profiler's matrix is read with its conversion factor, also compressed") {
  const std::string text =
      "h=2 w=3\npixel size=3.5e-007 m\ndata unit=rad\nheight conversion factor (-> m)=6e-008\n1 2 3\n4 5 "
      "-6\n";
  const auto path = written("profiler.txt.gz", "");
  gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  for (const auto& from : {written("profiler.txt", text), path}) {
    const HeightMap map = read_height_map(from);
    CHECK(map.pitch_x_um == doctest::Approx(0.35));
    CHECK(map.at(2, 1) == doctest::Approx(-0.36));
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 9);
  CHECK(contains(complaint(path), "gzip"));
  CHECK(contains(complaint(written("short.txt", text.substr(0, text.size() - 7))), "the header states"));
  CHECK(contains(complaint(written("vast.txt", "h=1e300" + text.substr(3))), "the header states 3 x 1e+300"));
}

TEST_CASE("units are required, never guessed") {
  const auto path = written("bare.txt", "1 2\n3 4\n");
  try {
    read_height_map(path);
    FAIL("accepted");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 2);
    CHECK(contains(error.problems()[0].text(), "--pitch"));
    CHECK(contains(error.problems()[1].text(), "--unit"));
  }
  ReadOptions options;
  options.width_um = 4.0;
  options.height_unit_um = 1e-3;
  const HeightMap map = read_height_map(path, options);
  CHECK(map.pitch_x_um == 2.0);
  CHECK(map.at(1, 1) == doctest::Approx(4e-3));
  options.pitch_um = 1.0;
  CHECK(contains(complaint(path, options), "both pitch and width"));
}

TEST_CASE("text that is no height map is refused with its place") {
  CHECK(contains(complaint(written("word.txt", "1 2\n3 x\n")), "word.txt:2:3"));
  CHECK(contains(complaint(written("comma.txt", "1,5 2\n")), "decimal point"));
  CHECK(contains(complaint(written("bytes.txt", "1 2\n3 \x01\xB5\n")), "found \"??\""));
  ReadOptions um;
  um.pitch_um = um.height_unit_um = 1.0;
  CHECK(read_height_map(written("semicolon.csv", "1.5;2\n3; 4\n"), um).at(1, 1) == 4.0);
  CHECK(contains(complaint(written("ragged.txt", "1 2\n3 4 5\n")), "ragged.txt:2"));
  CHECK(contains(complaint(written("empty.txt", "")), "empty"));
  CHECK(contains(complaint(written("binary.gwy", std::string("GWYP\0\0\0", 7))), "truncated"));
  CHECK(contains(complaint("no/such/file.gsf"), "no such file"));
}

TEST_CASE("levelling subtracts exactly the surface that was added") {
  HeightMap map = ramp();
  map.columns = map.rows = 12;
  map.heights_um.clear();
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i)
      map.heights_um.push_back(3.0 + 0.2 * i - 0.1 * j + 0.01 * i * j - 0.03 * j * j);
  HeightMap curved = map;
  level_polynomial(map, 2);
  for (const double h : map.heights_um) CHECK(std::abs(h) < 1e-10);
  level_plane(curved);
  CHECK(map_statistics(curved).sq_um > 0.05);
  CHECK(curved.steps.back() == "plane subtracted");
  CHECK_THROWS_AS(level_polynomial(map, 12), InputError);
}

TEST_CASE("filters keep what they must: a constant, a line under LOESS, the median of an outlier") {
  HeightMap map = ramp();
  HeightMap line = map;
  filter_loess_lines(line, 1.6);
  for (std::size_t k = 0; k < 15; ++k) CHECK(line.heights_um[k] == doctest::Approx(map.heights_um[k]));
  std::fill(map.heights_um.begin(), map.heights_um.end(), 2.0);
  map.at(2, 1) = 50.0;
  HeightMap median = map;
  filter_median(median, 1);
  CHECK(median.at(2, 1) == 2.0);
  map.at(2, 1) = 2.0;
  filter_gaussian(map, 0.3);
  for (const double h : map.heights_um) CHECK(h == doctest::Approx(2.0));
}

TEST_CASE("mirror tiling doubles the period less the edges and keeps the extremes") {
  const HeightField field = make_height_field(ramp(), Tiling::automatic);
  CHECK(field.columns() == 8);
  CHECK(field.rows() == 4);
  CHECK(field.high_um() == 9.0);
  CHECK(field.low_um() == -5.0);
  HeightMap periodic = ramp();
  periodic.periodic = true;
  CHECK(make_height_field(periodic).columns() == 5);
  CHECK(tiling_name(periodic, Tiling::automatic) == "periodic");
}

TEST_CASE("Gwyddion's export may have the decimal comma of its locale, other text may not") {
  const std::string numbers = "1,5\t2,25\n-3\t4e-1\n";
  const HeightMap map =
      read_height_map(written("comma-export.txt",
                              "# Kanal: a\n# Breite: 1,2 \xC2\xB5m\n# H\xC3\xB6he: 2,4 \xC2\xB5m\n"
                              "# Werteinheiten: \xC2\xB5m\n" +
                                  numbers));
  CHECK(map.pitch_x_um == doctest::Approx(0.6));
  CHECK(map.pitch_y_um == doctest::Approx(1.2));
  CHECK(map.at(1, 0) == doctest::Approx(2.25));
  CHECK(contains(complaint(written("comma-bare.txt", numbers)), "decimal point"));
}

TEST_CASE("a list of x y z becomes a grid, whatever its order, with gaps as missing points") {
  const std::string list = "10 0 1\n12 0 2\n14 0 3\n10 1 4\n14 1 6\n12 1 5\n10 2 7\n12 2 8\n";
  const auto path = written("xyz.txt", list);
  CHECK(contains(complaint(path), "--width"));
  ReadOptions options;
  options.width_um = 6.0;
  options.height_unit_um = 1.0;
  const HeightMap map = read_height_map(path, options);
  CHECK(map.columns == 3);
  CHECK(map.rows == 3);
  CHECK(map.pitch_x_um == doctest::Approx(2.0));
  CHECK(map.pitch_y_um == doctest::Approx(1.0));
  CHECK(map.at(0, 0) == 7.0);  // the largest y is the top row
  CHECK(map.at(1, 1) == 5.0);
  CHECK(std::isnan(map.at(2, 0)));
  CHECK(map.steps.back() == "1 of 9 points missing");
  CHECK(contains(complaint(written("xyz2.txt", list + "10 0 1\n"), options), "twice (number 9)"));
  CHECK(contains(complaint(written("xyz3.txt", "0 0 1\n1 0 1\n0 1.3 1\n1 3 1\n0 4 1\n1 5 1\n"), options),
                 "equal distances"));
  CHECK(contains(complaint(written("xyz4.txt", "0 0 1\n1 1 1\n2 2 1\n3 3 1\n"), options),
                 "half of their grid"));
  CHECK(contains(complaint(written("xyz5.txt", "0 0 1\n0 1 1\n0 2 1\n0 3 1\n"), options), "span a plane"));
}
