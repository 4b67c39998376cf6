/// `scintray map`: height maps described, prepared and made.

#include <cmath>
#include <limits>

#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/topography/height_map.hpp"
#include "support/page_scripts.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::topography;
using namespace scintray::test;

namespace {

/// A tilted wave with a spike, as an instrument might leave it.
std::filesystem::path folder_with_map(const std::string& name) {
  const auto folder = scratch_folder("map_" + name);
  HeightMap map;
  map.columns = 120;
  map.rows = 100;
  map.pitch_x_um = map.pitch_y_um = 0.5;
  map.title = name;
  for (std::uint32_t j = 0; j < map.rows; ++j)
    for (std::uint32_t i = 0; i < map.columns; ++i)
      map.heights_um.push_back(0.02 * i + 0.3 * std::sin(0.2 * i) + 0.2 * std::cos(0.15 * j));
  map.at(60, 50) = 30.0;
  write_gsf(folder / "map.gsf", map);
  return folder;
}

std::string page_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("map describe prints every parameter by its name, mean visible slopes, and warnings") {
  const auto folder = folder_with_map("describe");
  const Ended ended = run_program({"map", "describe", "map.gsf"}, folder);
  CAPTURE(ended.output);
  CHECK(ended.exit_code == cli::kSuccess);
  for (const std::string name : {"Sa", "Sq", "Sz", "Ssk", "Sku", "Sdq", "Sdr", "Sal", "Str", "Std",
                                 "mean visible slope", "share of its area", "88.50"})
    CHECK(contains(ended.output, name));
  check_contains(ended.output, {"warning:", "map", "too small"});
}

TEST_CASE("map prepare mends a map, prints its parameters, and draws it before and after") {
  const auto folder = folder_with_map("prepare");
  const Ended ended =
      run_program({"map", "prepare", "map.gsf", "-o", "out.gsf", "--crop", "5 um,0 um,50 um,45 um",
                   "--outliers", "100", "--fill", "--loess", "3 um", "--page", "page.html"},
                  folder);
  CAPTURE(ended.output);
  REQUIRE(ended.exit_code == cli::kSuccess);
  for (const std::string part :
       {"before", "after", "cropped to 100 x 90", "1 outliers removed", "1 missing points filled",
        "LOESS along lines, width 3 um", "plane subtracted", "out.gsf", "page.html"})
    CHECK(contains(ended.output, part));
  const HeightMap map = read_height_map(folder / "out.gsf");
  CHECK(map.columns == 100);
  CHECK(map.rows == 90);
  for (const double height : map.heights_um) CHECK(std::abs(height) < 2.0);
  const std::string page = page_text(folder / "page.html");
  CHECK(contains(page, "data:image/png;base64,iVBORw0KGgo"));  // the first bytes of every PNG
  CHECK(contains(page, "<svg"));
  CHECK(contains(page, "cropped to 100 x 90"));
  CHECK_FALSE(contains(scripts_of(page).page, "http://www.w3.org/1999/xlink"));
}

TEST_CASE("map synthesize makes the same map again, and a table is built from it") {
  const auto folder = scratch_folder("map_synthesize");
  for (const std::string name : {"a.gsf", "b.gsf"}) {
    const Ended ended =
        run_program({"map", "synthesize", "saw_cut", "--rms-height", "0.4 um", "--correlation-length", "3 um",
                     "--lay-length", "20 um", "--lay-angle", "30 deg", "--points", "128", "-o", name},
                    folder);
    CAPTURE(ended.output);
    REQUIRE(ended.exit_code == cli::kSuccess);
    CHECK(contains(ended.output, "lay at 30"));
    CHECK(contains(ended.output, "mean visible slope"));
  }
  CHECK(page_text(folder / "a.gsf") == page_text(folder / "b.gsf"));
  const Ended built = run_program(
      {"table", "build", "a.gsf", "-o", "a.h5", "--inside-index", "1.82", "--outside-index", "1",
       "--periodic", "--rays", "2", "--incidence-step", "30 deg", "--azimuth-step", "90 deg", "--no-refine"},
      folder);
  CAPTURE(built.output);
  CHECK(built.exit_code == cli::kSuccess);
}

TEST_CASE("a spectrum in a file becomes a map; one that is no spectrum is refused with its line") {
  const auto folder = scratch_folder("map_spectrum");
  const auto made = [&](const std::string& rows, const std::string& unit) {
    std::ofstream(folder / "psd.csv") << rows;
    return run_program({"map", "synthesize", "spectrum", "--spectrum", "psd.csv", "--frequency-unit", "1/um",
                        "--density-unit", unit, "--points", "64", "-o", "out.gsf"},
                       folder);
  };
  const Ended good = made("frequency,density\n0.1,1e9\n1,1e7\n3,1e5\n", "nm4");
  CAPTURE(good.output);
  CHECK(good.exit_code == cli::kSuccess);
  CHECK(contains(good.output, "spectrum of 3 points from 0.1 to 3"));
  const Ended unsorted = made("0.1,1\n1,1\n0.5,1\n", "um4");
  CHECK(unsorted.exit_code == cli::kBadInput);
  CHECK(contains(unsorted.output, "psd.csv:3"));
  CHECK(contains(unsorted.output, "increasing"));
  const Ended negative = made("0.1,1\n1,-1\n", "um4");
  CHECK(contains(negative.output, "psd.csv:2"));
  CHECK(contains(negative.output, "expected 0 or more"));
  CHECK(contains(made("0.1,1\n1,1\n", "um3").output, "um4"));
  CHECK(contains(made("0.1\n1\n", "um4").output, "single column"));
}

TEST_CASE("preparations and recipes that cannot be are explained") {
  const auto folder = folder_with_map("mistakes");
  const auto answer = [&](std::vector<std::string> words) {
    const Ended ended = run_program(words, folder);
    CHECK(ended.exit_code != cli::kSuccess);
    CHECK_FALSE(std::filesystem::exists(folder / "out.gsf"));
    return ended.output;
  };
  const auto prepared = [&](const std::string& option, const std::string& value) {
    return answer({"map", "prepare", "map.gsf", "-o", "out.gsf", option, value});
  };
  check_contains(prepared("--crop", "100,0,50,50"), {"inside", "map of 120 x 100"});
  CHECK(contains(prepared("--crop", "1,2,3"), "X,Y,WIDTH,HEIGHT"));
  CHECK(contains(prepared("--crop", "1 um,2 um,3,4"), "unit"));
  CHECK(contains(prepared("--level", "poly:9"), "N from 0 to 8"));
  CHECK(contains(prepared("--loess", "0.5 um"), "three points"));
  CHECK(contains(prepared("--loess", "90 um"), "more than a line"));
  CHECK(contains(prepared("--outliers", "0.1"), "--outliers"));
  CHECK(contains(answer({"map", "synthesize", "saw_cut", "-o", "out.gsf", "--rms-height", "1 um"}),
                 "--lay-angle"));
  CHECK(contains(answer({"map", "synthesize", "polished", "-o", "out.gsf", "--rise", "1 um"}), "no meaning"));
}
