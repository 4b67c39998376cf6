#pragma once
/// A crystal whose absorption length is fitted, for tests of the command fit.

#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

namespace scintray::test {

/// A crystal with an absorption length to be found: most light is lost in it.
inline const std::string kDarkCrystal = R"(
title = "A dark crystal"
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "10 mm"]
medium = "dark"
surface = "polished"
[[part]]
name = "sensor"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "ideal"
[source]
type = "photons"
region = { part = "crystal", slab_z = ["1 mm", "2 mm"] }
wavelength = "420 nm"
photons = 1000
[media.dark]
index = { n = 1.8 }
absorption = { length = "10 mm" }
scattering = { none = true }
)";

inline const std::string kDarkFit = R"([fit]
measurement = "light.csv"
quantity = "detected_fraction"
at = "source.region.slab_z.center"
unit = "mm"
scale = "free"
[[fit.parameter]]
key = "media.dark.absorption.length"
label = "absorption length"
start = "8 mm"
low = "2 mm"
high = "50 mm"
)";

inline const std::string kRows = "depth,light,error\n1,310,9\n3,240,8\n5,190,7\n7,150,6\n9,120,5\n";

class DarkCrystal {
 public:
  explicit DarkCrystal(const std::string& name) : folder(scratch_folder(name)) { write(kDarkFit, kRows); }

  void write(const std::string& fit, const std::string& rows) const {
    std::ofstream(folder / "scene.toml") << kDarkCrystal << fit;
    std::ofstream(folder / "light.csv") << rows;
  }
  Ended fit(std::vector<std::string> arguments = {}) const {
    arguments.insert(arguments.begin(), {"fit", "scene.toml"});
    return run_program(arguments, folder);
  }
  void refuses(const Fragments& what, const Fragments& hint,
               const std::vector<std::string>& arguments = {}) const {
    const Ended ended = fit(arguments);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kBadInput);
    check_contains(ended.output, what);
    check_contains(ended.output, hint);
  }

  std::filesystem::path folder;
};

}  // namespace scintray::test
