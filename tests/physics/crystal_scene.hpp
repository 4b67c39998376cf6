#pragma once
/// The crystal of 20 mm with a detector at its end that most comparisons are made on.

#include <fmt/format.h>

#include <string>

namespace scintray::test {

/// Where in the crystal light is made: distance from the exit end, z_mm +- half_mm.
inline std::string slab(double z_mm, double half_mm = 0.75) {
  return fmt::format(", slab_z = [\"{} mm\", \"{} mm\"]", z_mm - half_mm, z_mm + half_mm);
}

struct CrystalScene {
  std::string medium, surface;  ///< of the crystal; its exit end is smooth
  std::string where = {};       ///< slab(z), or nothing for the whole crystal
  std::uint64_t photons = 0;
  std::string contact = {};  ///< keys of the detector's place after its side: nothing for direct contact
  std::string source = {};   ///< further lines of [source]
  double width_mm = 2.0;
};

/// Scene text: the detector, of index 1.5, takes all light that enters it.
inline std::string crystal_scene(const CrystalScene& scene) {
  return fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["{0} mm", "{0} mm", "20 mm"]
medium = "{1}"
surface = "{2}"
[[part.face]]
name = "exit"
select = {{ normal = [0, 0, -1] }}
surface = "flat"
[[part]]
name = "detector"
box = ["{0} mm", "{0} mm", "1 mm"]
place = {{ touch = "crystal", side = "-z"{3} }}
medium = "n15"
sensor = "perfect"
[source]
type = "photons"
region = {{ part = "crystal"{4} }}
wavelength = "420 nm"
photons = {5}
{6}
)",
                     scene.width_mm, scene.medium, scene.surface, scene.contact, scene.where, scene.photons,
                     scene.source);
}

inline constexpr const char* kUnpolarisedSource = "polarisation = \"unpolarised\"";

struct RoughFace {
  std::string map;       ///< file
  std::string level;     ///< "none" or "plane"
  bool periodic = true;  ///< one period of a periodic surface
  std::string mode;      ///< "on_the_spot" or "table"
};

/// The crystal with a height map on its five free faces, light made about z_mm.
inline std::string rough_crystal(double z_mm, const RoughFace& face, std::uint64_t photons) {
  return crystal_scene({"lso_isotropic", "rough", slab(z_mm), photons, "", kUnpolarisedSource}) +
         fmt::format(R"(
[surfaces.rough]
model = "height_map"
[surfaces.rough.height_map]
file = "{}"
level = "{}"
periodic = {}
[surfaces.rough.tracing]
mode = "{}"
)",
                     face.map, face.level, face.periodic, face.mode);
}

}  // namespace scintray::test
