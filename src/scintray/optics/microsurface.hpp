#pragma once
/// The common language of all microsurfaces.
///
/// A microsurface separates an inside (the part whose face it is) from an outside. Its mean normal
/// N is the outward normal of that part; heights of a height map grow along N. The same
/// microsurface is met from both sides. No microsurface moves a photon: it has no thickness.

#include <cstdint>

#include "scintray/core/sampling.hpp"
#include "scintray/optics/fresnel.hpp"

namespace scintray::optics {

/// On which side of a microsurface a photon is.
enum class Side : std::uint8_t { inside = 0, outside = 1 };

constexpr Side other(Side side) { return side == Side::inside ? Side::outside : Side::inside; }

/// Refractive indices on the two sides of a microsurface.
struct IndexPair {
  double inside = 1.0;
  double outside = 1.0;
  double on(Side side) const { return side == Side::inside ? inside : outside; }
};

/// The frame of a surface with direction on a face of unit normal `normal`: x along the projection of
/// `along`; where that is zero (shorter than 1e-6), at a random azimuth.
inline core::Frame map_frame(const core::Vec3& normal, const core::Vec3& along, core::Rng& rng) {
  const core::Vec3 lateral = along - along.dot(normal) * normal;
  const double length = lateral.norm();
  const core::Vec3 x = length > 1e-6 ? core::Vec3(lateral / length) : core::sample_polarisation(normal, rng);
  return {x, normal.cross(x), normal};
}

/// What a photon's meeting with a surface came to.
enum class SurfaceOutcome { inside, outside, absorbed };

constexpr SurfaceOutcome outcome_on(Side side) {
  return side == Side::inside ? SurfaceOutcome::inside : SurfaceOutcome::outside;
}

// Every microsurface offers
//   Side scatter(Ray& ray, Side side, const Vec3& normal, const IndexPair& index, Rng& rng) const;
// the ray arrives on `side` (direction . normal > 0 from inside, < 0 from outside) and leaves with
// its new direction and polarisation on the returned side, with direction . normal < 0 for inside
// and > 0 for outside. Nothing is absorbed.

}  // namespace scintray::optics
