#pragma once
/// How points of an edge lie.

#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray::scene {

/// How points lie: along a line, in a plane, or neither.
struct Arrangement {
  enum class Kind { line, plane, space } kind;
  core::Vec3 direction;  ///< of the line, or normal of the plane
  core::Vec3 through;
};

/// @param points        one at least
/// @param tolerance_mm  distance from a line, or a plane, within which points are on it
Arrangement arrangement_of(const std::vector<core::Vec3>& points, double tolerance_mm);

}  // namespace scintray::scene
