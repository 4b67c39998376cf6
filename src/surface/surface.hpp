#pragma once
/// A surface is a stack: microsurface | gap or glue of no thickness | reflector.

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "scintray/core/curve.hpp"
#include "scintray/surface/height_field.hpp"
#include "scintray/surface/microsurface.hpp"
#include "scintray/surface/table.hpp"
#include "scintray/surface/unified.hpp"

namespace scintray {

/// Perfectly flat: Fresnel's equations at the mean normal.
struct SmoothSurface {
  Side scatter(Ray& ray, Side side, const Vec3& normal, const IndexPair& index, Rng& rng) const {
    const Vec3 against = side == Side::inside ? Vec3(-normal) : normal;
    return meet_facet(ray, against, index.on(side), index.on(other(side)), rng) ? other(side) : side;
  }
};

/// No microsurface: the reflector is painted or evaporated onto the face, nothing is refracted.
struct PaintedSurface {};

using Microsurface = std::variant<SmoothSurface, UnifiedSurface, std::shared_ptr<const SurfaceTable>,
                                  std::shared_ptr<const HeightField>, PaintedSurface>;

/// A sheet that reflects or absorbs, from either of its sides.
struct Reflector {
  std::string name;
  Curve reflectance;            ///< against wavelength (nm)
  double specular_share = 0.0;  ///< share of reflected light that is mirrored; the rest Lambertian
};

/// What a photon's meeting with a surface came to.
enum class SurfaceOutcome { inside, outside, absorbed };

/// The optical stack of a face. Light without a reflector goes on to the other side.
struct Surface {
  std::string name;
  Microsurface microsurface = SmoothSurface{};
  Curve gap_index = Curve::constant(1.0);  ///< index of the gap or glue under the reflector
  std::optional<Reflector> reflector;

  /// Follows the ray through the stack until it is on the inside, on the outside, or absorbed.
  ///
  /// @param normal  outward normal of the part whose face it is
  /// @param index   indices of the media on the two sides
  SurfaceOutcome meet(Ray& ray, Side side, const Vec3& normal, const IndexPair& index, double wavelength_nm,
                      Rng& rng) const;

  /// True when no light passes to the other side.
  bool opaque() const { return reflector.has_value(); }
};

}  // namespace scintray
