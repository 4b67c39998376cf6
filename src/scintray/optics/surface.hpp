#pragma once
/// A surface is a stack: microsurface | gap or glue | reflector or next medium.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/curve.hpp"
#include "scintray/core/function_ref.hpp"
#include "scintray/optics/microsurface.hpp"
#include "scintray/optics/reflector.hpp"
#include "scintray/optics/wavelength_shifter.hpp"

namespace scintray::optics {

/// What lies under a surface's microsurface, and how the surface lies on a face.
struct SurfaceStack {
  std::string name;

  /// What lies under the reflector, or, with a thickness and no reflector, between the microsurface and the
  /// smooth boundary of the next medium.
  std::string gap;  ///< medium of the gap, or its index as written; empty: none
  core::Curve gap_index = core::Curve::constant(1.0);              ///< against wavelength (nm)
  core::Curve gap_absorption_per_mm = core::Curve::constant(0.0);  ///< for good, beside the shifter's
  /// A coating: re-emits light that it absorbs in all directions, from where it was absorbed. Only in a
  /// gap with a thickness.
  std::shared_ptr<const WavelengthShifter> gap_shifter;
  /// Without one the gap is thin but wide: light comes back to the microsurface anywhere on it.
  std::optional<double> gap_thickness_um;
  std::optional<Reflector> reflector;

  /// Direction of a height map's or directional table's x axis, projected onto the face (world, any
  /// length); zero, and on faces that it is perpendicular to: at random for every photon.
  core::Vec3 direction = core::Vec3::Zero();
};

/// A part of a surface's area that is another surface, scattered finely over it.
template <typename AnySurface>
struct AreaShare {
  double share = 0.0;
  std::shared_ptr<const AnySurface> surface;
};

struct Surface;
using SurfaceShare = AreaShare<Surface>;

/// How light reaches a surface.
struct Incidence {
  Side side = Side::inside;
  core::Vec3 normal;  ///< outward normal of the part whose face it is
  IndexPair index;    ///< of the media on the two sides, at the wavelength
  double wavelength_nm = 0.0;
  ReflectionLog* log = nullptr;  ///< takes every reflection at a reflector that was survived; may be null
};

/// Light whose wavelength changes on its way through a surface.
struct ShiftingLight {
  double wavelength_nm = 0.0;
  double delay_ns = 0.0;  ///< from absorption to emission, all that happened so far
  ShiftCount count;       ///< what happened so far
  /// Indices of the media on the two sides of the surface, at a wavelength (nm).
  core::FunctionRef<IndexPair(double)> index;
};

/// The optical stack of a face. Light without a reflector goes on to the other side.
struct Surface : SurfaceStack {
  std::string definition;  ///< its name in the scene or the database, whatever media it lies between
  Microsurface microsurface = SmoothSurface();
  /// Shares of the area (sum 1) that are other surfaces, as in partial contact; then the microsurface and the
  /// stack, but for the name, are not used.
  std::vector<SurfaceShare> mixture;

  /// Follows the ray through the stack until it is on the inside, on the outside, or absorbed. What a
  /// wavelength shifter in the gap absorbs is absorbed.
  SurfaceOutcome interact(Ray& ray, const Incidence& incidence, core::Rng& rng) const {
    return interact(ray, incidence, nullptr, rng);
  }
  SurfaceOutcome interact(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index,
                          double wavelength_nm, core::Rng& rng) const {
    return interact(ray, {side, normal, index, wavelength_nm}, nullptr, rng);
  }
  /// As above, and a wavelength shifter re-emits light: `light` is the photon's, and changes.
  SurfaceOutcome interact(Ray& ray, Side side, const core::Vec3& normal, ShiftingLight& light, core::Rng& rng,
                          ReflectionLog* log = nullptr) const {
    return interact(ray, {side, normal, light.index(light.wavelength_nm), light.wavelength_nm, log}, &light,
                    rng);
  }

  /// True when no light passes to the other side.
  bool opaque() const;
  /// True when it is nothing but a smooth boundary.
  bool plain() const {
    return mixture.empty() && microsurface->kind() == MicrosurfaceKind::smooth && !reflector &&
           !gap_thickness_um;
  }
  /// True when light may leave it at another wavelength.
  bool shifts() const { return mixture.empty() ? gap_shifter != nullptr : mixture_shifts(); }

 private:
  bool mixture_shifts() const;
  SurfaceOutcome interact(Ray& ray, const Incidence& incidence, ShiftingLight* light, core::Rng& rng) const;
};

}  // namespace scintray::optics
