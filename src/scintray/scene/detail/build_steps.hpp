#pragma once
/// The steps of building a scene apart from the look-up of its names.

#include <string>
#include <vector>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/core/error.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// Range of the wavelengths of photons in a scene, and the reference wavelength of tables.
struct WavelengthRange {
  double low_nm = 0.0, high_nm = 0.0, reference_nm = 0.0;
  bool operator==(const WavelengthRange&) const = default;
};

/// True for equal names with equal values at the same places of the same file, so that messages are equal
/// too.
bool same_definitions(const scene_file::InlineTables& a, const scene_file::InlineTables& b);

/// Range of the wavelengths of the source and of the re-emission, above them, by wavelength shifters of the
/// scene: in media, or in the gaps of surfaces, named by its parts, faces or contacts. Names that are not in
/// the database are ignored. Adds to `problems` a source without defined wavelengths.
WavelengthRange find_wavelengths(const scene_file::SceneSpec& spec,
                                 const std::vector<contact::PlacedMesh>& placed,
                                 const materials::MaterialDatabase& database, core::Problems& problems);

/// Adds to `problems` the errors of the scene's own definitions, used or not, that are not there yet. A
/// surface that lacks what those based on it give is sound.
void check_definitions(const scene_file::SceneSpec& spec, const materials::MaterialDatabase& database,
                       core::Problems& problems);

/// Adds to `problems` the sensors that light of the source cannot reach, and to `warnings` a scene without
/// any sensor.
/// @param placed  the parts of the scene, in their order there
void check_sensors(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& placed,
                   const Scene& scene, core::Problems& problems, std::vector<std::string>& warnings);

/// Sets Region::lanes and Region::unfolds of all regions, and SceneRecords::total_reflections, which requires
/// all else of the scene.
///
/// Lanes are for regions that are not rotated and not of a birefringent medium, bounded by planes or one
/// convex body, or with thin gaps: where most of the boundary is smooth and light is often totally reflected,
/// and, except in bodies, where most of it has surfaces for lanes (lane_surface_at.hpp), as long as most of
/// the light there stays in lanes. Boxes unfold, turned ones as well, in which more than half of diffuse
/// light is totally reflected.
void set_lane_kinds(Scene& scene);

}  // namespace scintray::scene
