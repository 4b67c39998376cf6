#pragma once
/// Factory of surfaces between two media from their definitions: loads and traces height maps, builds tables,
/// and keeps them.

#include <string>
#include <vector>

#include "scintray/materials/relief_store.hpp"
#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::materials {

/// A surface and the warnings from its construction.
struct MadeSurface {
  optics::Surface surface;
  std::vector<std::string> warnings;
};

class SurfaceFactory {
 public:
  using Hooks = TableHooks;

  explicit SurfaceFactory(Hooks hooks = {}) : reliefs_(std::move(hooks)) {}

  /// The surface between two media. Tables are for the indices at `reference_nm`, or at the wavelengths named
  /// by the surface; a warning is added when the ratio of indices deviates from the table's by more than
  /// kIndexTolerance within [low_nm, high_nm].
  /// @throws InputError for a table file of other indices, an unreadable map, or bad settings.
  MadeSurface make(const SurfaceSpec& spec, const optics::Medium& inside, const optics::Medium& outside,
                   double reference_nm, double low_nm, double high_nm);

 private:
  ReliefStore reliefs_;
};

}  // namespace scintray::materials
