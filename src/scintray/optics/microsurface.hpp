#pragma once
/// What all microsurfaces have in common, whatever their model.
///
/// A microsurface separates an inside (the part whose face it is) from an outside. Its mean normal
/// N is the outward normal of that part; heights of a height map grow along N. The same
/// microsurface scatters light from both sides. No microsurface moves a photon: it has no thickness.

#include <cstdint>
#include <optional>

#include "scintray/core/sampling.hpp"
#include "scintray/core/shared.hpp"
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

/// How a map, or another pattern, lies on a face, and where on it a ray is: kept while the ray goes to and
/// fro between the map and what lies close behind it.
struct MapPlace {
  core::Frame map;  ///< the map's x and y, and the mean normal
  double x_um = 0, y_um = 0;

  /// Moves along the unit vector `direction` (world) by `distance_um`, sideways only.
  void shift(const core::Vec3& direction, double distance_um) {
    x_um += distance_um * direction.dot(map.x);
    y_um += distance_um * direction.dot(map.y);
  }
};

/// Where light is after an interaction with a surface.
enum class SurfaceOutcome { inside, outside, absorbed };

constexpr SurfaceOutcome outcome_on(Side side) {
  return side == Side::inside ? SurfaceOutcome::inside : SurfaceOutcome::outside;
}

/// One photon's interaction with a surface, as its microsurface sees it: the same from when the photon
/// arrives until it leaves the stack.
struct SurfaceInteraction {
  const core::Vec3& normal;     ///< mean normal
  const core::Vec3& direction;  ///< SurfaceStack::direction
  double wavelength_nm;         ///< as it is now
  core::Rng& rng;
  /// Where on a map the photon is, once a microsurface has drawn it. The stack moves it through a gap of a
  /// thickness, and forgets it in a gap that is thin but wide.
  std::optional<MapPlace> place = std::nullopt;
};

/// What the stack below a microsurface must know of it.
enum class MicrosurfaceKind : std::uint8_t {
  rough,
  smooth,   ///< Fresnel's equations at the mean normal, and nothing else
  painted,  ///< there is none: what lies below it is in contact with the face
};

/// A microsurface of one model. Immutable, so one serves all threads.
///
/// A new model is a class derived from this one; the optical stack comes with Surface, its name in files with
/// materials::SurfaceModel.
class MicrosurfaceModel {
 public:
  virtual ~MicrosurfaceModel() = default;

  /// Scatters light that arrives on `side`: ray.direction . normal > 0 from inside, < 0 from outside. Leaves
  /// it with its new direction and polarisation on the side of the outcome, with direction . normal < 0 for
  /// inside and > 0 for outside, or absorbed. Random numbers come from interaction.rng alone.
  /// @param index  of what lies on the two sides of the microsurface, at the interaction's wavelength
  virtual SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                                 SurfaceInteraction& interaction) const = 0;

  /// True when nothing that comes from inside gets outside.
  virtual bool opaque() const { return false; }

  MicrosurfaceKind kind() const { return kind_; }

 protected:
  explicit MicrosurfaceModel(MicrosurfaceKind kind = MicrosurfaceKind::rough) : kind_(kind) {}
  MicrosurfaceModel(const MicrosurfaceModel&) = default;
  MicrosurfaceModel(MicrosurfaceModel&&) = default;
  MicrosurfaceModel& operator=(const MicrosurfaceModel&) = default;
  MicrosurfaceModel& operator=(MicrosurfaceModel&&) = default;

 private:
  MicrosurfaceKind kind_;
};

/// A microsurface of any model, as a value.
using Microsurface = core::Shared<MicrosurfaceModel>;

/// Perfectly flat: Fresnel's equations at the mean normal.
class SmoothSurface : public MicrosurfaceModel {
 public:
  SmoothSurface() : MicrosurfaceModel(MicrosurfaceKind::smooth) {}
  Side scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index, core::Rng& rng) const {
    const core::Vec3 against = side == Side::inside ? core::Vec3(-normal) : normal;
    return interact_at_facet(ray, against, index.on(side), index.on(other(side)), rng) ? other(side) : side;
  }
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
};

/// No microsurface: the reflector is painted or evaporated onto the face, nothing is refracted.
class PaintedSurface : public MicrosurfaceModel {
 public:
  PaintedSurface() : MicrosurfaceModel(MicrosurfaceKind::painted) {}
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
};

}  // namespace scintray::optics
