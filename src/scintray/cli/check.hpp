#pragma once
/// What `scintray check` shows of a scene: in words, and as a picture.

#include <filesystem>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene/build_scene.hpp"

namespace scintray::cli {

/// Parts, faces, regions, interfaces, and which parts touch. Parts whose names differ by numbers only
/// (crystal[1,2], pad7) and that agree in all that a line states share one line, unless `every_one`.
void print_scene(const scene::BuiltScene& built, bool every_one);

/// One line for each; warnings alike but for numbers share one, unless `every_one`.
void print_warnings(const std::vector<core::Problem>& warnings, bool every_one);

/// The parts of a scene as far as they can be placed, whatever is wrong with them.
std::vector<contact::PlacedMesh> placed_for_picture(const scene_file::SceneSpec& spec);

/// @throws InputError for endings other than .glb and .svg.
void expect_picture_name(const std::filesystem::path& path);

/// Writes the parts, translucent and coloured by medium, with a red mark at every place of a problem:
/// .glb, or .svg with three views and a legend. @throws InputError as expect_picture_name.
void draw_scene(const std::filesystem::path& path, const std::vector<contact::PlacedMesh>& parts,
                const std::vector<core::Problem>& problems);

}  // namespace scintray::cli
