#pragma once
/// What `scintray check` prints of a scene that builds.

#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene/build_scene.hpp"

namespace scintray::cli {

/// Parts, faces, regions, interfaces, and which parts touch. Parts whose names differ by numbers only
/// (crystal[1,2], pad7) and that agree in all that a line states share one line, unless `every_one`.
void print_scene(const scene::BuiltScene& built, bool every_one);

/// One line for each; warnings alike but for numbers share one, unless `every_one`.
void print_warnings(const std::vector<core::Problem>& warnings, bool every_one);

}  // namespace scintray::cli
