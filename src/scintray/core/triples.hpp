#pragma once
/// Vectors of Eigen and plain ones as triples of numbers, in which laws over a number type are written.

#include "scintray/core/number.hpp"
#include "scintray/core/plain_vec.hpp"

namespace scintray::core {

inline Triple<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Triple<double> triple(const PlainVec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 vec(const Triple<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace scintray::core
