#pragma once
/// The steps of building a scene that stand beside the looking up of its names.

#include <string>
#include <vector>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/core/error.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// Wavelengths that photons of a scene can have, and the one tables are made for.
struct WavelengthRange {
  double low_nm = 0.0, high_nm = 0.0, reference_nm = 0.0;
};

/// The wavelengths of the source, and above them those that wavelength shifters of the scene re-emit: in
/// media, or in the gaps of surfaces, that its parts, faces or contacts name. Names that are not in the
/// database are passed over. Adds to `problems`: a source whose wavelengths the scene leaves open.
WavelengthRange find_wavelengths(const scene_file::SceneSpec& spec,
                                 const std::vector<contact::PlacedMesh>& placed,
                                 const materials::MaterialDatabase& database, core::Problems& problems);

/// Adds to `problems` the sensors that light of the source cannot reach, and to `warnings` a scene without
/// any sensor.
/// @param placed  the parts of the scene, in their order there
void check_sensors(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& placed,
                   const Scene& scene, core::Problems& problems, std::vector<std::string>& warnings);

}  // namespace scintray::scene
