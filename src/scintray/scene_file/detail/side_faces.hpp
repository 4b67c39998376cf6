#pragma once
/// Sides of shapes, and groups of mesh files, as faces of their parts.

#include <string>
#include <vector>

#include "scintray/scene_file/spec.hpp"

namespace scintray::scene_file {

/// Names that the sides of a shape can have: "+z" of a box, "side" of a cylinder; none of a mesh file, whose
/// groups are known when it is read.
std::vector<std::string> side_names(const ShapeSpec& shape);

/// Adds to the parts the faces that tallies and contacts name and that no rule defines: each a rule without a
/// place in the file, without surface and sensor, for the group of that name. Such a rule applies to
/// triangles that no other one matches, and makes no face where there are none.
void name_sides(SceneSpec& scene);

}  // namespace scintray::scene_file
