#pragma once
/// A page that shows a height map before and after its preparation.

#include <filesystem>
#include <string>

#include "scintray/topography/height_map.hpp"

namespace scintray::report {

/// One self-contained HTML page: both maps, which show the same part of a surface, as pictures, a line
/// profile along x and one along y through their middles, the numbers of both, and the steps. `before` is
/// shown less its mean height. InputError when every point of a map is missing.
std::string map_page(const std::string& title, const topography::HeightMap& before,
                     const topography::HeightMap& after);

/// Writes the page. SystemError when it cannot.
void write_map_page(const std::filesystem::path& path, const std::string& title,
                    const topography::HeightMap& before, const topography::HeightMap& after);

}  // namespace scintray::report
