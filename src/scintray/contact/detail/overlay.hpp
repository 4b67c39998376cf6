#pragma once
/// The overlay of polygons in a plane.

#include <array>
#include <utility>
#include <vector>

#include "scintray/contact/detail/geometry.hpp"

namespace scintray::contact {

/// A straight edge of one or more labelled polygons, between two points.
struct OverlayEdge {
  int a = 0, b = 0;  ///< points
  /// What crossing the edge from the right to the left of a -> b adds to the winding of each label.
  std::vector<std::pair<int, int>> winding;
};

/// A triangle of the overlay, counter-clockwise, and the labels that cover it, ascending.
struct OverlayCell {
  std::array<int, 3> point{};
  std::vector<int> labels;
};

struct Overlay {
  std::vector<Vec2> points;  ///< the given ones, then the crossings of edges
  std::vector<OverlayCell> cells;
};

/// Triangulation of the plane in which every edge consists of sides of cells, with the labels that wind
/// around each cell. Crossings are computed exactly; coverage follows from the edges crossed on the way in
/// from infinity, never from a rounded point, so neighbouring cells cannot disagree. Cells that no label
/// covers are left out. Points must be distinct; edges may cross and overlap.
Overlay overlay(std::vector<Vec2> points, const std::vector<OverlayEdge>& edges);

}  // namespace scintray::contact
