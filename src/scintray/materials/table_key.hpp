#pragma once
/// Keys of surface tables: texts of everything on which a table depends. Equal keys are equal tables, to the
/// last bit; numbers are written in full, and files by their content.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/topography/build_table.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::materials {

struct SurfaceSpec;
struct TracingSpec;

/// A height map file and how it is read, prepared and continued.
struct MapSource {
  const std::filesystem::path& path;
  const topography::ReadOptions& options;
  const topography::Preparation& preparation;
  topography::Tiling tiling;
};

/// Key of the height field of a map file, by the file's name without its folder (the table's provenance has
/// it) and its content.
std::string height_map_key(const MapSource& source);
/// Key of the height field of a recipe.
std::string recipe_key(const topography::SynthesisRecipe& recipe);
/// Key of the content of a file; that of an empty one when it cannot be read.
std::string file_key(const std::filesystem::path& path);

/// Settings of a table within the key of a microsurface.
std::string tracing_key(const TracingSpec& tracing);

/// Key of a whole surface between any two media: its microsurface, layers and shares. Nothing for a surface
/// with a microsurface whose key is not known, or that shifts wavelengths.
std::optional<std::string> stack_key(const SurfaceSpec& surface);

/// Key of the table of a height field or a surface, by its own key, at the indices of a spectrum. It includes
/// the versions of a table's layout (optics::kTableFileVersion) and content
/// (topography::kTableContentVersion) and the release of ScintRay.
std::string table_key(const std::string& surface, const topography::TableSettings& settings,
                      const std::vector<topography::SpectralPoint>& spectrum);

}  // namespace scintray::materials
