#include "scintray/optics/microsurface.hpp"

namespace scintray::optics {

SurfaceOutcome SmoothSurface::scatter(Ray& ray, Side side, const IndexPair& index,
                                      SurfaceInteraction& interaction) const {
  return outcome_on(scatter(ray, side, interaction.normal, index, interaction.rng));
}

SurfaceOutcome PaintedSurface::scatter(Ray&, Side side, const IndexPair&, SurfaceInteraction&) const {
  return outcome_on(other(side));
}

}  // namespace scintray::optics
