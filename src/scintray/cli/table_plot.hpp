#pragma once
/// A picture of a surface table.

#include <filesystem>

#include "scintray/optics/table.hpp"

namespace scintray::cli {

/// Writes an SVG of reflectance (left axis, 0 to 1) and mean visible slope (right axis, 0 to 90 deg)
/// against incidence from both sides. SystemError when it cannot be written.
void plot_table(const std::filesystem::path& path, const optics::SurfaceTable& table);

}  // namespace scintray::cli
