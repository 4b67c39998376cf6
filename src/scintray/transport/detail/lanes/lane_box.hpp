#pragma once
/// The face through which a ray in each lane leaves a region that is a box along the axes of its frame,
/// computed as for one ray in scene/detail/nearest_plane.hpp: the same numbers, as products with normals
/// whose components are 0, 1 and -1 are exact.

#include <limits>

#include "scintray/core/lanes/lane_number.hpp"

namespace scintray::transport {
namespace {

/// A box along the axes of a region's frame: the places of its faces (mm) times the sign of their normals, in
/// the order of scene::Boundary::is_box.
template <typename Real>
struct LaneBox {
  Real offset_mm[6];
};

/// The sign bit, or none, for each coordinate.
template <typename Real>
struct LaneSigns {
  core::BitsOf<Real> x, y, z;

  /// A vector, negated where there is a sign.
  core::Triple<Real> of(const core::Triple<Real>& v) const {
    return {number_of(bits_of(v.x) ^ x), number_of(bits_of(v.y) ^ y), number_of(bits_of(v.z) ^ z)};
  }
};

/// The face of a box through which a ray in each lane leaves.
template <typename Real>
struct LaneBoxAhead {
  using Mask = core::MaskOf<Real>;
  using Vector = core::Triple<Real>;
  Real distance_mm;
  Mask y, z;  ///< the face is across z; else across y; neither: across x

  /// @param inverse  of the magnitudes of the direction's components
  LaneBoxAhead(const LaneBox<Real>& box, const Vector& from, const Vector& direction, const Vector& inverse) {
    const Real to_x = distance(box.offset_mm, from.x, direction.x, inverse.x),
               to_y = distance(box.offset_mm + 2, from.y, direction.y, inverse.y),
               to_z = distance(box.offset_mm + 4, from.z, direction.z, inverse.z);
    // Numbers that are none, along a face, are not below others, and are not the least of two as the first of
    // them.
    const Real first = least(to_x, Real(std::numeric_limits<double>::infinity()));
    y = to_y < first;
    const Real second = least(to_y, first);
    z = to_z < second;
    distance_mm = least(to_z, second);
  }
  Real of_face(const Real& at_x, const Real& at_y, const Real& at_z) const {
    return select(z, at_z, select(y, at_y, at_x));
  }
  /// The sign bit where the face is across an axis.
  LaneSigns<Real> signs() const {
    const Real sign(-0.0);
    return {bits_of(where(!(y | z), sign)), bits_of(where(y & !z, sign)), bits_of(where(z, sign))};
  }
  /// Component of the direction along the axis that the face is across: the cosine between ray and normal but
  /// for its sign.
  Real along(const Vector& direction) const { return of_face(direction.x, direction.y, direction.z); }
  /// Number of the face.
  Real face(const Real& along) const {
    return where(z, Real(4.0)) + where(y & !z, Real(2.0)) + where(along < Real(0.0), Real(1.0));
  }

 private:
  static Real distance(const Real* offset_mm, const Real& at, const Real& towards, const Real& inverse) {
    return greatest(select_by_sign(towards, offset_mm[0] - at, offset_mm[1] + at), Real(0.0)) * inverse;
  }
};

}  // namespace
}  // namespace scintray::transport
