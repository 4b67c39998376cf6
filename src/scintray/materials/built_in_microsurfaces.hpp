#pragma once
/// Definitions of microsurfaces that depend on files, or on the media on their two sides.

#include <filesystem>
#include <optional>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/materials/microsurface_spec.hpp"
#include "scintray/topography/height_map.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::materials {

/// A table file of ScintRay (HDF5), valid for its pairs of indices.
class TableFileSpec : public MicrosurfaceDefinition {
 public:
  TableFileSpec(std::filesystem::path its_path, core::FileLocation its_place)
      : path(std::move(its_path)), where(std::move(its_place)) {}

  std::filesystem::path path;  ///< it exists
  core::FileLocation where;

  optics::Microsurface make(const SurfaceSetting& setting, ReliefStore& reliefs) const override;
  std::optional<std::string> key() const override;
};

/// Settings of a table traced on a height map: at one wavelength, that of the scene, or at several.
struct TracingSpec {
  topography::TableSettings settings;
  std::vector<double> wavelengths_nm;  ///< in order; empty: the wavelength of most light
};

/// A microsurface with a height map.
class ReliefSpec : public MicrosurfaceDefinition {
 public:
  std::optional<TracingSpec> table;  ///< nothing: rays are traced on the height map, on the spot
  core::FileLocation where;

  optics::Microsurface make(const SurfaceSetting& setting, ReliefStore& reliefs) const override;
  std::optional<std::string> key() const override;

 protected:
  /// Text of everything on which the height field depends (materials/table_key.hpp).
  virtual std::string relief_key() const = 0;
  /// The height field, read or synthesised anew.
  virtual Relief make_relief() const = 0;
};

/// A measured height map.
class HeightMapSpec : public ReliefSpec {
 public:
  std::filesystem::path path;  ///< it exists
  topography::ReadOptions options;
  topography::Preparation preparation;
  topography::Tiling tiling = topography::Tiling::automatic;

  std::optional<MicrosurfaceSpec> traced_on_the_spot() const override;

 protected:
  std::string relief_key() const override;
  Relief make_relief() const override;
};

/// A height map made from a recipe.
class RecipeSpec : public ReliefSpec {
 public:
  topography::SynthesisRecipe recipe;

  std::optional<MicrosurfaceSpec> traced_on_the_spot() const override;

 protected:
  std::string relief_key() const override;
  Relief make_relief() const override;
};

}  // namespace scintray::materials
