#pragma once
/// Small scenes of the tests of Simulation.

#include <mutex>
#include <string>

#include "scintray/scene_file/read_scene.hpp"
#include "support/shared.hpp"

namespace scintray::test {

/// A crystal on a sensor; the material database has all its definitions.
inline const std::string kCrystal = R"(
title = "A crystal"
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "4 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "pmt"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "R6231"
)";

/// That crystal with white or grey paint on all faces but the one at the sensor. The surface is called
/// "paint".
inline std::string painted_crystal(double reflectance) {
  const std::string polished = "surface = \"polished\"\n";
  std::string text = kCrystal;
  text.replace(text.find(polished), polished.size(), R"(surface = "paint"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "polished"
)");
  return text + "[surfaces.paint]\nmodel = \"painted\"\nspecular_share = 0.0\nreflectance = " +
         std::to_string(reflectance) + "\n";
}

inline const std::string kPhotons = R"(
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "emission"
time = "decay"
photons = 3_000
photons_per_event = 100
)";

inline const std::string kEvents = R"(
[source]
type = "gamma_events"
events = 12
region = { part = "crystal" }
energy = "50 keV"
)";

/// Three surfaces, so three scenes to build.
inline const std::string kSurfaceSweep = R"(
[[sweep]]
key = "part.crystal.surface"
label = "surface"
values = ["polished", "roncali2013_unified_rough", "flat"]
[surfaces.flat]
model = "smooth"
)";

/// By one thread at a time: the thread sanitizer does not see the code that reads scene files, and would take
/// what that code made once, for all threads, for a race.
inline scene_file::SceneFile scene_of(const std::string& text) {
  static std::mutex reading;
  const std::lock_guard lock(reading);
  return scene_file::SceneFile::from_text(text, source_file("scene.toml").string());
}

}  // namespace scintray::test
