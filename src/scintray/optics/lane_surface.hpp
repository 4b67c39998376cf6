#pragma once
/// Surfaces at which photons can be scattered in the lanes of vector registers.

#include <optional>

#include "scintray/optics/facets.hpp"
#include "scintray/optics/surface.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::optics {

/// A surface of a microsurface and, behind it, the next medium or a reflector that transmits nothing.
struct LaneSurface {
  enum class Micro { smooth, facets, painted, table };
  Micro micro = Micro::smooth;
  const FacetSurface* facets = nullptr;  ///< of Micro::facets
  const SurfaceTable* table = nullptr;   ///< of Micro::table
  const Reflector* reflector = nullptr;  ///< null: the next medium
};

/// The parts of a surface; nothing where it has others, as a coating, a mixture or a height map: photons are
/// then scattered one by one.
std::optional<LaneSurface> lane_surface(const Surface& surface);

}  // namespace scintray::optics
