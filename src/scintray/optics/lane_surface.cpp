#include "scintray/optics/lane_surface.hpp"

#include <algorithm>

namespace scintray::optics {

namespace {

bool for_lanes(const FacetSurface& facets) {
  return facets.lobe == 1.0 && facets.smear == 0.0 && facets.sigma_alpha_rad > 0.0 &&
         facets.definition == SigmaAlphaDefinition::solid_angle;
}

bool for_lanes(const SurfaceTable& table) {
  return table.azimuths() == 1 && table.azimuth_kind() == AzimuthKind::folded &&
         std::none_of(table.slices().begin(), table.slices().end(),
                      [](const TableSlice& slice) { return slice.reciprocal != nullptr; });
}

bool for_lanes(const Reflector& reflector) {
  return !reflector.transmittance && reflector.volume_index == 0.0 &&
         reflector.polarisation == PaintPolarisation::random;
}

}  // namespace

std::optional<LaneSurface> lane_surface(const Surface& surface) {
  if (!surface.mixture.empty() || surface.admission || surface.gap_shifter) return std::nullopt;
  LaneSurface lanes;
  if (surface.microsurface.get_if<SmoothSurface>()) {
    lanes.micro = LaneSurface::Micro::smooth;
  } else if (surface.microsurface.get_if<PaintedSurface>()) {
    lanes.micro = LaneSurface::Micro::painted;
  } else if (const auto* facets = surface.microsurface.get_if<FacetSurface>(); facets && for_lanes(*facets)) {
    lanes.micro = LaneSurface::Micro::facets;
    lanes.facets = facets;
  } else if (const auto* table = surface.microsurface.get_if<SurfaceTable>(); table && for_lanes(*table)) {
    lanes.micro = LaneSurface::Micro::table;
    lanes.table = table;
  } else {
    return std::nullopt;
  }
  if (surface.reflector) {
    if (!for_lanes(*surface.reflector)) return std::nullopt;
    if (surface.gap_thickness_um && surface.gap_absorption_per_mm.max_y() > 0.0) return std::nullopt;
    lanes.reflector = &*surface.reflector;
  } else if (surface.gap_thickness_um || lanes.micro == LaneSurface::Micro::painted) {
    return std::nullopt;
  }
  return lanes;
}

}  // namespace scintray::optics
