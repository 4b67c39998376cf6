#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "scintray/core/data_folder.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/version.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;

TEST_CASE("The version begins with the release") { CHECK(version().rfind(release(), 0) == 0); }

TEST_CASE("SCINTRAY_DATA comes before every other data folder, and must hold materials") {
  const auto folder = test::scratch_folder("data_folder");
  REQUIRE(setenv("SCINTRAY_DATA", folder.c_str(), 1) == 0);
  CHECK_THROWS_AS(data_folder(), InputError);
  std::filesystem::create_directories(folder / "materials");
  CHECK(data_folder() == folder);
  REQUIRE(unsetenv("SCINTRAY_DATA") == 0);
  CHECK(std::filesystem::equivalent(data_folder(), test::source_file("")));
}
