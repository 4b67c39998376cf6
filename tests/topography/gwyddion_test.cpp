/// The program gwyddion, where it is installed: it reads what we read alike, and what we do not.

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "map_files.hpp"
#include "scintray/core/error.hpp"
#include "scintray/topography/detail/readers/formats.hpp"
#include "scintray/topography/height_map.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::topography;
using namespace scintray::test;

namespace {

/// False, and a line that marks the test as skipped, where the program is not installed.
bool gwyddion_is_here() {
  std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (std::filesystem::exists(std::filesystem::path(folder) / "gwyddion")) return true;
  std::cout << "[skipped] the program gwyddion is not installed\n";
  return false;
}

/// A format of Gwyddion's that we do not read: a header of 2048 bytes, then whole numbers.
std::string bcrstm_file() {
  std::string file =
      "fileformat = bcrstm\nheadersize = 2048\nxpixels = 5\nypixels = 3\nxlength = 10000\nylength = 3000\n"
      "bit2nm = 0.5\nintelmode = 1\n";
  file.resize(2048, ' ');
  for (std::int16_t k = 0; k < 15; ++k) file.append(reinterpret_cast<const char*>(&k), sizeof k);
  return file;
}

}  // namespace

TEST_CASE("a format that only Gwyddion knows is read through it") {
  if (!gwyddion_is_here()) return;
  const HeightMap map = read_height_map(written("map.bcr", bcrstm_file()));
  CHECK(map.columns == 5);
  CHECK(map.rows == 3);
  CHECK(map.pitch_x_um == doctest::Approx(2.0));
  CHECK(map.pitch_y_um == doctest::Approx(1.0));
  CHECK(map.at(4, 2) - map.at(0, 0) == doctest::Approx(14 * 0.5e-3));
  CHECK(map.steps[0].find("converted by Gwyddion") != std::string::npos);
}

TEST_CASE("a file that Gwyddion does not know either is refused with a hint") {
  if (!gwyddion_is_here()) return;
  CHECK(complaint(written("junk", "\x89 no height map")).find("Gwyddion does not read it either") !=
        std::string::npos);
  CHECK(complaint(written("-h --version; echo", "\x89 no height map")).find("either") != std::string::npos);
}

TEST_CASE("without the program, the hint is to install it") {
  const std::string path = std::getenv("PATH") ? std::getenv("PATH") : "";
  setenv("PATH", test::scratch_folder("no_programs").c_str(), 1);
  const std::string text = complaint(written("map2.bcr", bcrstm_file()));
  setenv("PATH", path.c_str(), 1);
  CHECK(text.find("install gwyddion") != std::string::npos);
}

TEST_CASE("a program that does not come to an end is ended") {
  const auto folder = test::scratch_folder("endless_program");
  std::ofstream(folder / "gwyddion") << "#!/bin/sh\nexec sleep 1000\n";
  std::filesystem::permissions(folder / "gwyddion", std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH") ? std::getenv("PATH") : "";
  setenv("PATH", (folder.string() + ":" + path).c_str(), 1);
  const GwyddionResult result =
      query_gwyddion(written("map3.bcr", bcrstm_file()), {"map3.bcr", {}}, std::chrono::milliseconds(50));
  setenv("PATH", path.c_str(), 1);
  CHECK(result.answer == GwyddionAnswer::timed_out);
}

TEST_CASE("Gwyddion's own readers find the same heights, pitches and rows in published files") {
  if (!gwyddion_is_here()) return;
  for (const char* name : {"di-3.di", "di-5.di", "mi-1.mi", "P0089OP0027.ibw", "x3p-2.x3p", "sdf-1.sdf"}) {
    CAPTURE(name);
    const auto path = test::shared_file(std::string("data/topography/") + name);
    if (!path) return;
    const HeightMap ours = read_height_map(*path);
    const GwyddionResult theirs_read = query_gwyddion(*path, {name, {}});
    REQUIRE(theirs_read.map);
    const RawMap& theirs = *theirs_read.map;
    REQUIRE(theirs.columns == ours.columns);
    REQUIRE(theirs.rows == ours.rows);
    CHECK(ours.pitch_x_um == doctest::Approx(*theirs.pitch_x_um).epsilon(1e-6));
    CHECK(ours.pitch_y_um == doctest::Approx(*theirs.pitch_y_um).epsilon(1e-6));
    double largest = 0.0, range = 0.0;
    for (std::size_t k = 0; k < ours.heights_um.size(); ++k) {
      const double height = theirs.values[k] * *theirs.height_unit_um;
      largest = std::max(largest, std::abs(height - ours.heights_um[k]));
      range = std::max(range, std::abs(height));
    }
    CHECK(largest <= 1e-6 * range);
  }
}
