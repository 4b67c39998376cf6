#pragma once
/// A crystal on a sensor, for tests of how its photons are propagated.

#include <string>

namespace scintray::test {

/// A square sensor behind grease, and photons from all of the crystal.
inline std::string sensor_and_source(const std::string& side) {
  return R"([[part]]
name = "detector"
box = [")" +
         side + R"(", ")" + side + R"(", "1 mm"]
place = { touch = "crystal", side = "-z", gap = "0.1 mm", fill = "optical_grease_roncali2013" }
medium = "optical_grease_roncali2013"
sensor = "ideal"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 3_000
)";
}

/// A crystal of absorbing, scattering LSO with a sensor behind grease.
inline std::string crystal(const std::string& surface, const std::string& more = "") {
  return R"(
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["2 mm", "3 mm", "20 mm"]
medium = "LSO_roncali2013"
surface = ")" +
         surface + R"("
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "polished"
)" + sensor_and_source("2 mm") +
         more;
}

/// A surface for it.
inline const char* const kPaint = R"([surfaces.paint]
model = "painted"
reflectance = 0.97
specular_share = 0.3
)";

}  // namespace scintray::test
