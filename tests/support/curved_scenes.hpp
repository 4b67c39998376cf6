#pragma once
/// Scenes of a few round parts in vacuum.

#include <stdexcept>
#include <string>

#include "physics/traced.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"

namespace scintray::test {

/// A scene of parts, in vacuum, with a source in the first of them.
inline scene_file::SceneSpec spec_of(const std::string& parts, const std::string& first,
                                     const std::string& run = "") {
  return scene_spec("ambient = \"vacuum_n1\"\n" + parts + R"(
[source]
type = "photons"
region = { part = ")" +
                    first +
                    R"(" }
wavelength = "420 nm"
photons = 1000
)" + run);
}

/// A shape whose inline table goes on in the next line, which TOML does not allow, in one line.
inline std::string in_one_line(std::string shape) {
  for (std::size_t at = shape.find(",\n"); at != std::string::npos; at = shape.find(",\n"))
    shape[at + 1] = ' ';
  return shape;
}

inline std::string part(const std::string& name, const std::string& shape, const std::string& medium = "n15",
                        const std::string& rest = "surface = \"flat\"\n") {
  return "[[part]]\nname = \"" + name + "\"\n" + in_one_line(shape) + "\nmedium = \"" + medium + "\"\n" +
         rest;
}

inline scene::BuiltScene build(const scene_file::SceneSpec& spec) {
  scene::SceneBuilder builder;
  return builder.build(spec);
}

inline core::RegionId region_id_of(const scene::BuiltScene& built, const std::string& name) {
  for (const core::RegionId id : built.scene.regions.ids())
    if (built.scene.region_names[id] == name) return id;
  throw std::runtime_error("no region " + name);
}

/// Region of a part.
inline const scene::Region& region_of(const scene::BuiltScene& built, const std::string& name) {
  return built.scene.regions[region_id_of(built, name)];
}

/// Name of the region that a triangle of a region's boundary leads to.
inline std::string name_at(const scene::BuiltScene& built, const scene::Region& region,
                           std::uint32_t triangle) {
  const scene::BoundaryLink& link = built.scene.link(region, triangle);
  const scene::Interface& interface = built.scene.interfaces[link.interface];
  return built.scene.region_names[link.from_back ? interface.front : interface.back];
}

/// A photon at a place, in the region of the scene's source.
inline source::Photon photon_in(const scene::BuiltScene& built, const scene_file::SceneSpec& spec,
                                const core::Vec3& position, const core::Vec3& direction) {
  core::Rng rng(1, core::StreamKind::photon, 0);
  const PhotonSource source(spec.source, built.scene);
  source::Photon photon = source.emit(built.scene, rng);
  photon.position = position;
  photon.ray.direction = direction.normalized();
  photon.ray.polarisation =
      core::Vec3(photon.ray.direction.vec().cross(core::Vec3(0.3, 0.5, 0.7)).normalized());
  photon.optical_depth = HUGE_VAL;
  return photon;
}

}  // namespace scintray::test
