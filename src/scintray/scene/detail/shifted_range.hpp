#pragma once
/// Wavelengths that light has only after it was shifted.

#include <vector>

#include "scintray/materials/database.hpp"
#include "scintray/scene/place_parts.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// The longest wavelength (nm) that a wavelength shifter of the scene re-emits: in a medium, or in the
/// gap of a surface, that its parts, faces or contacts name. 0 when there is no shifter. Names that are
/// not in the database are passed over.
double longest_shifted_nm(const scene_file::SceneSpec& spec, const std::vector<contact::PlacedMesh>& placed,
                          const materials::MaterialDatabase& database);

}  // namespace scintray::scene
