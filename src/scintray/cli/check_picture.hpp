#pragma once
/// The picture of `scintray check`.

#include <filesystem>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/scene/place_parts.hpp"

namespace scintray::cli {

/// The parts of a scene as far as they can be placed, whatever is wrong with them.
std::vector<contact::PlacedMesh> placed_for_picture(const scene_file::SceneSpec& spec);

/// @throws InputError for endings other than .glb and .svg.
void expect_picture_name(const std::filesystem::path& path);

/// Writes the parts, translucent and coloured by medium, with a red mark at every place of a problem:
/// .glb, or .svg with three views and a legend. @throws InputError as expect_picture_name.
void draw_scene(const std::filesystem::path& path, const std::vector<contact::PlacedMesh>& parts,
                const std::vector<core::Problem>& problems);

}  // namespace scintray::cli
