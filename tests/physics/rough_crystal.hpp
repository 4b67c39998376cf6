#pragma once
/// A 2 x 2 x 20 mm3 crystal whose five free faces are a height map.

#include <fmt/format.h>

#include <string>

namespace scintray::test {

struct RoughFace {
  std::string map;       ///< file
  std::string level;     ///< "none" or "plane"
  bool periodic = true;  ///< one period of a periodic surface
  std::string mode;      ///< "on_the_spot" or "table"
};

/// Scene text: the exit end is smooth, on a medium of index 1.5 where all light is detected; light is made
/// at z_mm +- 0.75 mm.
inline std::string rough_crystal(double z_mm, const RoughFace& face, std::uint64_t photons) {
  return fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "lso_isotropic"
surface = "rough"
[[part.face]]
name = "exit"
select = {{ normal = [0, 0, -1] }}
surface = "flat"
[[part]]
name = "detector"
box = ["2 mm", "2 mm", "1 mm"]
place = {{ touch = "crystal", side = "-z" }}
medium = "n15"
sensor = "perfect"
[source]
type = "photons"
region = {{ part = "crystal", slab_z = ["{} mm", "{} mm"] }}
wavelength = "420 nm"
polarisation = "unpolarised"
photons = {}
[surfaces.rough]
model = "height_map"
[surfaces.rough.height_map]
file = "{}"
level = "{}"
periodic = {}
[surfaces.rough.tracing]
mode = "{}"
)",
                     z_mm - 0.75, z_mm + 0.75, photons, face.map, face.level, face.periodic, face.mode);
}

}  // namespace scintray::test
