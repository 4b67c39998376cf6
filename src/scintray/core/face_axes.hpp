#pragma once
/// Axes of flat faces.

#include <array>

#include "scintray/core/vec.hpp"

namespace scintray::core {

/// The two directions across a plane along which positions and azimuths on it count: for a normal along
/// a world axis the two other axes; in general the first world axis that is not near the normal, turned
/// into the plane, and the direction across it, with its largest component positive.
std::array<Vec3, 2> face_axes(const Vec3& normal);

}  // namespace scintray::core
