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

/// Share of the light that is incident on a surface, from either side, which the surface admits: what neither
/// is admitted nor passes undeflected is absorbed before anything else happens to it. Geant4's REFLECTIVITY
/// and TRANSMITTANCE.
struct Admission {
  core::Curve admitted;                                  ///< against wavelength (nm)
  core::Curve undeflected = core::Curve::constant(0.0);  ///< continues straight on, without refraction
};

/// The layers under a surface's microsurface, and the orientation of the surface on a face.
struct SurfaceStack {
  std::string name;
  std::optional<Admission> admission;  ///< nothing: all light is admitted

  /// Gap or glue in front of the reflector or, with a thickness and no reflector, between the microsurface
  /// and the smooth boundary of the next medium.
  std::string gap;  ///< medium of the gap, or its index as written; empty: none
  core::Curve gap_index = core::Curve::constant(1.0);              ///< against wavelength (nm)
  core::Curve gap_absorption_per_mm = core::Curve::constant(0.0);  ///< without re-emission
  /// A coating: re-emits absorbed light isotropically, from the point of absorption. Only in a gap with a
  /// thickness.
  std::shared_ptr<const WavelengthShifter> gap_shifter;
  /// Thickness of the gap; without it the gap is thin but wide: light returns to the microsurface at a random
  /// position.
  std::optional<double> gap_thickness_um;
  std::optional<Reflector> reflector;

  /// Direction of the x axis of a height map or directional table, projected onto the face (world, any
  /// length); drawn for every photon where it is zero or perpendicular to the face.
  core::Vec3 direction = core::Vec3::Zero();
};

/// A share of a surface's area that is another surface, finely distributed over it.
template <typename AnySurface>
struct AreaShare {
  double share = 0.0;
  std::shared_ptr<const AnySurface> surface;
};

struct Surface;
using SurfaceShare = AreaShare<Surface>;

/// Conditions of incidence of light on a surface.
struct Incidence {
  Side side = Side::inside;
  core::Vec3 normal;  ///< outward normal of the part whose face it is
  IndexPair index;    ///< of the media on the two sides, at the wavelength
  double wavelength_nm = 0.0;
  ReflectionLog* log = nullptr;  ///< receives every survived reflection at a reflector; may be null
};

/// Light whose wavelength may change within a surface.
struct ShiftingLight {
  double wavelength_nm = 0.0;
  double delay_ns = 0.0;  ///< from absorption to emission, sum of all shifts so far
  ShiftCount count;       ///< of all shifts so far
  /// Indices of the media on the two sides of the surface, at a wavelength (nm).
  core::FunctionRef<IndexPair(double)> index;
};

/// The optical stack of a face. Without a reflector light continues to the other side.
struct Surface : SurfaceStack {
  std::string definition;  ///< its name in the scene or the database, independent of the media on its sides
  Microsurface microsurface = SmoothSurface();
  /// Shares of the area (sum 1) that are other surfaces, as in partial contact; then the microsurface and the
  /// stack, apart from the name, are not used.
  std::vector<SurfaceShare> mixture;

  /// Traces the ray through the stack until it leaves on the inside or the outside, or is absorbed. Light
  /// absorbed by a wavelength shifter in the gap is not re-emitted.
  SurfaceOutcome interact(Ray& ray, const Incidence& incidence, core::Rng& rng) const {
    return interact(ray, incidence, nullptr, rng);
  }
  SurfaceOutcome interact(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index,
                          double wavelength_nm, core::Rng& rng) const {
    return interact(ray, {side, normal, index, wavelength_nm}, nullptr, rng);
  }
  /// As above, with re-emission by a wavelength shifter: `light` is the photon's and is updated.
  SurfaceOutcome interact(Ray& ray, Side side, const core::Vec3& normal, ShiftingLight& light, core::Rng& rng,
                          ReflectionLog* log = nullptr) const {
    return interact(ray, {side, normal, light.index(light.wavelength_nm), light.wavelength_nm, log}, &light,
                    rng);
  }

  /// True when no light is transmitted to the other side.
  bool opaque() const;
  /// True for a smooth boundary without further layers.
  bool plain() const {
    return mixture.empty() && microsurface->kind() == MicrosurfaceKind::smooth && !reflector &&
           !gap_thickness_um && !admission;
  }
  /// True when the surface is exact next to a birefringent medium (MicrosurfaceModel::birefringent).
  bool birefringent() const;
  /// True when a part of its area has a reflector.
  bool has_reflector() const;
  /// Why light does not pass the surface along every path as it would in the opposite direction
  /// (MicrosurfaceModel::reciprocal); empty: it does.
  std::string why_not_reciprocal() const;
  /// True when light may leave the surface at another wavelength.
  bool shifts() const { return mixture.empty() ? gap_shifter != nullptr : mixture_shifts(); }

 private:
  bool mixture_shifts() const;
  SurfaceOutcome interact(Ray& ray, const Incidence& incidence, ShiftingLight* light, core::Rng& rng) const;
};

}  // namespace scintray::optics
