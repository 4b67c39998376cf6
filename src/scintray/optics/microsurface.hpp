#pragma once
/// Microsurfaces: the interface common to all models.
///
/// A microsurface separates an inside (the part whose face it is) from an outside. Its mean normal N is the
/// outward normal of that part; heights of a height map increase along N. The same microsurface scatters
/// light from both sides. A microsurface has no thickness and does not displace a photon.

#include <cstdint>
#include <optional>

#include "scintray/core/sampling.hpp"
#include "scintray/core/shared.hpp"
#include "scintray/optics/fresnel.hpp"

namespace scintray::optics {

/// Frame of a directional surface on a face of unit normal `normal`: x along the projection of `along`; where
/// that is zero (shorter than 1e-6), at a random azimuth.
inline core::Frame map_frame(const core::Vec3& normal, const core::Vec3& along, core::Rng& rng) {
  const core::Vec3 lateral = along - along.dot(normal) * normal;
  const double length = lateral.norm();
  const core::Vec3 x = length > 1e-6 ? core::Vec3(lateral / length) : core::sample_polarisation(normal, rng);
  return {x, normal.cross(x), normal};
}

/// Orientation of a height map, or of another pattern, on a face, and the position of a ray on it: kept while
/// the ray is reflected between the height map and the layers close behind it.
struct MapPlace {
  core::Frame map;  ///< x and y of the height map, and the mean normal
  double x_um = 0, y_um = 0;

  /// Moves the position by the lateral part of `distance_um` along the unit vector `direction` (world).
  void shift(const core::Vec3& direction, double distance_um) {
    x_um += distance_um * direction.dot(map.x);
    y_um += distance_um * direction.dot(map.y);
  }
};

/// Outcome of an interaction with a surface: the side on which the light leaves, or absorption.
enum class SurfaceOutcome { inside, outside, absorbed };

constexpr SurfaceOutcome outcome_on(Side side) {
  return side == Side::inside ? SurfaceOutcome::inside : SurfaceOutcome::outside;
}

/// One photon's interaction with a surface, as its microsurface requires it: one object from the arrival of
/// the photon until it leaves the stack.
struct SurfaceInteraction {
  const core::Vec3& normal;     ///< mean normal
  const core::Vec3& direction;  ///< SurfaceStack::direction
  double wavelength_nm;         ///< present wavelength
  core::Rng& rng;
  /// Place of the photon on a height map, once a microsurface has drawn it. The stack moves it through a gap
  /// with a thickness, and resets it in a gap that is thin but wide.
  std::optional<MapPlace> place = std::nullopt;
};

/// Kind of a microsurface, as far as the stack below it depends on it.
enum class MicrosurfaceKind : std::uint8_t {
  rough,
  smooth,   ///< Fresnel's equations at the mean normal alone
  painted,  ///< no microsurface: the layer below is in contact with the face
};

/// A microsurface of one model. Immutable: one serves all threads.
///
/// A new model is a class derived from this one; Surface supplies the optical stack, materials::SurfaceModel
/// the name in files.
class MicrosurfaceModel {
 public:
  virtual ~MicrosurfaceModel() = default;

  /// Scatters light that arrives on `side`: ray.direction . normal > 0 from inside, < 0 from outside. On
  /// return the ray has its new direction and polarisation on the side of the outcome, with direction .
  /// normal < 0 for inside and > 0 for outside, or absorbed. Random numbers come from interaction.rng alone.
  /// @param index  of the media on the two sides of the microsurface, at the interaction's wavelength
  virtual SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                                 SurfaceInteraction& interaction) const = 0;

  /// True when no light from inside is transmitted to the outside.
  virtual bool opaque() const { return false; }

  /// True when light passes along every path as it would in the opposite direction: the probability per
  /// projected solid angle, times the square of the index of incidence, is symmetric in the two directions
  /// (Helmholtz reciprocity). A model for which this is not known is not reciprocal.
  virtual bool reciprocal() const { return false; }

  /// True when the model is exact where a medium is birefringent. For others, light that the model
  /// scatters into such a medium takes one of the two modes of its direction there (take_mode).
  virtual bool birefringent() const { return false; }

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

/// A perfectly flat surface: Fresnel's equations at the mean normal.
class SmoothSurface : public MicrosurfaceModel {
 public:
  SmoothSurface() : MicrosurfaceModel(MicrosurfaceKind::smooth) {}
  Side scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index, core::Rng& rng) const {
    const core::Vec3 against = side == Side::inside ? core::Vec3(-normal) : normal;
    return interact_at_facet(ray, against, index, side, rng) ? other(side) : side;
  }
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
  bool reciprocal() const override { return true; }
  bool birefringent() const override { return true; }
};

/// No microsurface: the reflector is painted or evaporated onto the face, nothing is refracted.
class PaintedSurface : public MicrosurfaceModel {
 public:
  PaintedSurface() : MicrosurfaceModel(MicrosurfaceKind::painted) {}
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
  bool reciprocal() const override { return true; }
};

}  // namespace scintray::optics
