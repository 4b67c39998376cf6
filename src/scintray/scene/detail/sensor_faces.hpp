#pragma once
/// Faces of sensors whose efficiency depends on the place.

#include "scintray/scene/detail/assemble.hpp"

namespace scintray::scene {

/// Sets Scene::sensor_frames, where a sensor's efficiency depends on the place on its face. Requires the
/// scene's faces. Adds to `problems` the faces that have no direction.
void place_sensor_faces(const Assembly& assembly, Scene& scene, core::Problems& problems);

}  // namespace scintray::scene
