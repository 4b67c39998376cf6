#pragma once
/// Scenes of the doctor's tests, and what is asked of them.

#include "physics/traced.hpp"
#include "support/photon_source.hpp"
#include "support/words.hpp"

namespace scintray::test {

/// A [[part]] with the keys of its shape (and what else), one a line.
inline std::string part_text(const std::string& name, const std::string& keys, const std::string& medium) {
  return "[[part]]\nname = \"" + name + "\"\n" + keys + "medium = \"" + medium + "\"\nsurface = \"flat\"\n";
}

/// box = ... of two corners, mm.
inline std::string corners(const core::Vec3& low, const core::Vec3& high) {
  return fmt::format(
      "box = {{ low = [\"{:.6g} mm\", \"{:.6g} mm\", \"{:.6g} mm\"], high = [\"{:.6g} mm\", \"{:.6g} mm\", "
      "\"{:.6g} mm\"] }}\n",
      low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
}

inline std::string from_file(const std::string& path) { return "mesh = \"" + path + "\"\nunit = \"mm\"\n"; }

/// Parts (and contacts) in vacuum, and photons that start anywhere in one of them.
inline std::string lit_scene(const std::string& parts, const std::string& start, int photons) {
  return "ambient = \"vacuum_n1\"\n" + parts +
         fmt::format(
             "[source]\ntype = \"photons\"\nregion = {{ part = \"{}\" }}\nwavelength = \"420 nm\"\nphotons = "
             "{}\n",
             start, photons);
}

/// What building the scene complains of; empty when it does not.
inline std::string refusal(const std::string& text) {
  return complaint_of([&] { scene::SceneBuilder().build(scene_spec(text)); });
}

/// Area of all interfaces between two regions, mm2.
inline double area_between(const scene::Scene& scene, const std::string& a, const std::string& b) {
  double area = 0.0;
  for (const core::InterfaceId i : scene.interfaces.ids()) {
    const std::string &back = scene.region_names[scene.interfaces[i].back],
                      &front = scene.region_names[scene.interfaces[i].front];
    if ((back == a && front == b) || (back == b && front == a)) area += scene.interface_area_mm2[i];
  }
  return area;
}

/// Traces the first photons one by one and checks that each segment lies in the region of its record.
inline void check_propagation(const scene::Scene& scene, const scene_file::SourceSpec& spec,
                              std::uint64_t photons) {
  constexpr double kShort_mm = 0.01;  // shorter segments do not determine the side
  const PhotonSource source(spec, scene);
  std::size_t propagations = 0, astray = 0;
  for (std::uint64_t photon = 0; photon < photons; ++photon) {
    std::optional<source::Photon> before;
    simulation::replay(
        scene, source, {}, {0, photon}, [&](const source::Photon& now, const transport::Step&) {
          if (before && (now.position - before->position).norm() > kShort_mm) {
            ++propagations;
            astray += !scene.region_contains(before->region, 0.5 * (before->position + now.position));
          }
          before = now;
        });
  }
  CHECK(propagations > photons);
  CHECK(astray == 0);
}

}  // namespace scintray::test
