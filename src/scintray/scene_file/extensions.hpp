#pragma once
/// What code outside of ScintRay adds to what scene files may name.

#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/scene_file/tally_variable.hpp"

namespace scintray::scene_file {

/// Lists that are needed while a scene file is read. Models of surfaces and sensors are needed later
/// (simulation::SimulationOptions::models).
struct Extensions {
  TallyVariables variables = TallyVariables::built_in();           ///< that tallies may name
  mesh::MeshFormats mesh_formats = mesh::MeshFormats::built_in();  ///< of parts, and of elements of arrays
};

}  // namespace scintray::scene_file
