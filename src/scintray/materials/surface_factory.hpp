#pragma once
/// From a surface's definition to the surface between two given media: loads and traces height maps,
/// builds tables, and keeps them.

#include <string>
#include <vector>

#include "scintray/materials/relief_store.hpp"
#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::materials {

/// A surface and what the factory noticed.
struct MadeSurface {
  optics::Surface surface;
  std::vector<std::string> warnings;
};

class SurfaceFactory {
 public:
  using Hooks = TableHooks;

  explicit SurfaceFactory(Hooks hooks = {}) : reliefs_(std::move(hooks)) {}

  /// The surface between two media. Tables are for the indices at `reference_nm`, or at the wavelengths that
  /// the surface names; a warning states so when the ratio of indices departs from the table's by more than
  /// kIndexTolerance over [low_nm, high_nm].
  /// @throws InputError for a table file of other indices, an unreadable map, or bad settings.
  MadeSurface make(const SurfaceSpec& spec, const optics::Medium& inside, const optics::Medium& outside,
                   double reference_nm, double low_nm, double high_nm);

 private:
  ReliefStore reliefs_;
};

}  // namespace scintray::materials
