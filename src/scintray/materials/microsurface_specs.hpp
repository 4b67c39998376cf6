#pragma once
/// The definitions of the models that need files, or the media on their two sides, to become microsurfaces.

#include <filesystem>
#include <optional>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/materials/microsurface_spec.hpp"
#include "scintray/topography/height_map.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::materials {

/// A table file of ours (HDF5), valid for one pair of indices.
class TableFileSpec : public MicrosurfaceDefinition {
 public:
  TableFileSpec(std::filesystem::path its_path, core::FileLocation its_place)
      : path(std::move(its_path)), where(std::move(its_place)) {}

  std::filesystem::path path;  ///< it exists
  core::FileLocation where;

  optics::Microsurface make(const SurfaceSetting& setting, ReliefStore& reliefs) const override;
};

/// How a table is made of a height map: at one wavelength, the scene's own, or at several.
struct TracingSpec {
  topography::TableSettings settings;
  std::vector<double> wavelengths_nm;  ///< in order; empty: the wavelength that most light has
};

/// A microsurface whose heights are known.
class ReliefSpec : public MicrosurfaceDefinition {
 public:
  std::optional<TracingSpec> table;  ///< nothing: rays are traced on the map itself, on the spot
  core::FileLocation where;

  optics::Microsurface make(const SurfaceSetting& setting, ReliefStore& reliefs) const override;

 protected:
  virtual Relief relief(ReliefStore& reliefs) const = 0;
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
  Relief relief(ReliefStore& reliefs) const override;
};

/// A height map made from a recipe.
class RecipeSpec : public ReliefSpec {
 public:
  topography::SynthesisRecipe recipe;

  std::optional<MicrosurfaceSpec> traced_on_the_spot() const override;

 protected:
  Relief relief(ReliefStore& reliefs) const override;
};

}  // namespace scintray::materials
