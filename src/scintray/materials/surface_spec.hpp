#pragma once
/// A surface as its definition states it: names looked up, nothing traced or built yet. Which surface
/// object it becomes depends on the media on its two sides, so it is made per interface.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/core/error.hpp"
#include "scintray/optics/surface.hpp"
#include "scintray/optics/unified.hpp"
#include "scintray/topography/build_table.hpp"
#include "scintray/topography/height_map.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::materials {

struct SmoothSpec {};

/// No microsurface: the reflector is in contact with the face.
struct PaintedSpec {};

/// A table file of ours (HDF5), valid for one pair of indices.
struct TableFileSpec {
  std::filesystem::path path;  ///< it exists
  core::FileLocation where;
};

/// How a table is made of a height map: at one wavelength, the scene's own, or at several.
struct TracingSpec {
  topography::TableSettings settings;
  std::vector<double> wavelengths_nm;  ///< in order; empty: the wavelength that most light has
};

/// A measured height map.
struct HeightMapSpec {
  std::filesystem::path path;  ///< it exists
  topography::ReadOptions options;
  topography::Preparation preparation;
  topography::Tiling tiling = topography::Tiling::automatic;
  std::optional<TracingSpec> table;  ///< nothing: rays are traced on the map itself, on the spot
  core::FileLocation where;
};

/// A height map made from a recipe.
struct RecipeSpec {
  topography::SynthesisRecipe recipe;
  std::optional<TracingSpec> table;  ///< nothing: rays are traced on the map itself, on the spot
  core::FileLocation where;
};

using MicrosurfaceSpec =
    std::variant<SmoothSpec, optics::UnifiedSurface, TableFileSpec, HeightMapSpec, RecipeSpec, PaintedSpec>;

struct SurfaceSpec;

/// A share of a surface's area that is another surface.
struct ShareSpec {
  double share = 0.0;
  std::shared_ptr<const SurfaceSpec> surface;
};

struct SurfaceSpec {
  std::string name;
  core::FileLocation where;  ///< of the definition
  MicrosurfaceSpec microsurface;
  std::string gap;  ///< medium of the gap under the reflector, or its index as written; empty: none
  core::Curve gap_index = core::Curve::constant(1.0);  ///< against wavelength (nm)
  core::Curve gap_absorption_per_mm = core::Curve::constant(0.0);
  std::shared_ptr<const optics::WavelengthShifter> gap_shifter;  ///< of the gap's medium, where it has one
  std::optional<double> gap_thickness_um;
  std::optional<optics::Reflector> reflector;  ///< looked up, with the surface's own specular share
  /// One of the two faces of a sheet: `reflector` is this face's share of it (surface/reflector.hpp).
  bool face_of_sheet = false;
  core::Vec3 direction = core::Vec3::Zero();  ///< of a map's x axis (Surface::direction)
  std::vector<ShareSpec> mixture;             ///< shares of 1; empty: the surface is one
  std::vector<std::string> sources;           ///< published sources, its own first, then its bases'
};

/// The surface, and those it is mixed of, with rays followed on height maps themselves, not by way of tables.
SurfaceSpec traced_on_the_spot(SurfaceSpec spec);

}  // namespace scintray::materials
