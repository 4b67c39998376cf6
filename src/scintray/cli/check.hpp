#pragma once
/// Output of `scintray check`: text and a picture of a scene.

#include <filesystem>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene/build_scene.hpp"

namespace scintray::cli {

/// Prints a scene's parts, faces, regions, interfaces, and the parts that touch. Parts whose names differ
/// only by numbers (crystal[1,2], pad7) and that agree in the content of a line share one, unless
/// `every_one`.
void print_scene(const scene::BuiltScene& built, bool every_one);

/// The parts of a scene as far as they can be placed, also with errors.
std::vector<contact::PlacedMesh> placed_for_picture(const scene_file::SceneSpec& spec);

/// @throws InputError for extensions other than .glb and .svg.
void expect_picture_name(const std::filesystem::path& path);

/// Writes the parts, translucent and coloured by medium, with a red mark at every position of a problem:
/// .glb, or .svg with three views and a legend. @throws InputError as expect_picture_name.
void draw_scene(const std::filesystem::path& path, const std::vector<contact::PlacedMesh>& parts,
                const std::vector<core::Problem>& problems);

}  // namespace scintray::cli
