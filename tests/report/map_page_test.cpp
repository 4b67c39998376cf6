#include "scintray/report/pages/pages.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/report/plots/detail/height_image.hpp"
#include "scintray/report/text/map_numbers.hpp"
#include "support/page_scripts.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::topography;
using namespace scintray::report;
using namespace scintray::report;

namespace {

HeightMap waves() {
  HeightMap map;
  map.columns = 40;
  map.rows = 20;
  map.pitch_x_um = map.pitch_y_um = 0.5;
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 40; ++i) map.heights_um.push_back(std::sin(0.5 * i) + 0.1 * j);
  map.steps = {"read a<b>.gsf"};
  return map;
}

}  // namespace

TEST_CASE("a page of a map escapes its text, shows both maps, and leaves gaps where points are missing") {
  HeightMap holed = waves();
  for (std::uint32_t i = 10; i < 15; ++i) holed.at(i, 10) = std::nan("");
  const std::string page = map_page("a<b>", holed, waves());
  CHECK(page.find("a<b>") == std::string::npos);
  CHECK(page.find("a&lt;b&gt;") != std::string::npos);
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = page.find("data:image/png;base64,", at)) != std::string::npos; ++at)
    ++pictures;
  CHECK(pictures == 2);
  CHECK(test::scripts_of(page).page.find("nan") == std::string::npos);
  // The first curve starts anew behind the gap.
  const std::size_t curve = page.find("class=\"curve\" d=\"");
  REQUIRE(curve != std::string::npos);
  const std::string path = page.substr(curve, page.find("/>", curve) - curve);
  CHECK(std::count(path.begin(), path.end(), 'M') == 2);
}

TEST_CASE("a picture differs where a point is missing, and keeps the shape of the field") {
  HeightMap map = waves(), holed = waves();
  holed.at(3, 3) = std::nan("");
  CHECK(height_image(map, -1, 3, "x") != height_image(holed, -1, 3, "x"));
  CHECK(height_image(map, -1, 3, "x").find("aspect-ratio:20/10") != std::string::npos);
}

TEST_CASE("numbers of a map that are not available are \"-\", and a map without heights is refused") {
  HeightMap flat = waves();
  std::fill(flat.heights_um.begin(), flat.heights_um.end(), 1.0);
  for (const MapNumber& number : map_numbers(flat)) {
    if (number.name == "Sal" || number.name == "Str" || number.name == "Std") CHECK(number.value == "-");
    if (number.name == "points") CHECK(number.value == "800");
  }
  std::fill(flat.heights_um.begin(), flat.heights_um.end(), std::nan(""));
  CHECK_THROWS_AS(map_numbers(flat), InputError);
  CHECK_THROWS_AS(map_page("x", flat, flat), InputError);
}
