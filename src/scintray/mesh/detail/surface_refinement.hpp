#pragma once
/// Refinement of a tessellated face until it keeps a deviation.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "scintray/core/vec.hpp"

namespace scintray::mesh {

/// Triangles over points of a surface, with the parameters of each point.
struct SurfacePatch {
  std::vector<core::Vec3> vertices;         ///< mm
  std::vector<Eigen::Vector2d> parameters;  ///< u and v of each vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Point (mm) of the surface at u and v.
using SurfacePoint = std::function<core::Vec3(const Eigen::Vector2d&)>;

/// Largest distance (mm) left between the surface and the patch, after edges inside it were halved where the
/// surface is further than `deviation_mm` from the middle of the edge or of a triangle, at the same
/// parameters. Edges of one triangle only are the border that the patch shares with the next face, and stay
/// as they are. Ends after 20 rounds, or with more than 4 million triangles.
double refine(SurfacePatch& patch, const SurfacePoint& surface, double deviation_mm);

}  // namespace scintray::mesh
