#pragma once
/// Thin gaps of a region between two parallel flat faces, across which light is followed without a search.

#include <cstdint>
#include <type_traits>
#include <vector>

#include "scintray/core/plain_vec.hpp"

namespace scintray::scene {

struct Boundary;
struct FlatFace;

/// A box of the region with nothing in it, one side of which lies on a face of the boundary, and the opposite
/// one on the plane of a parallel face. A ray from that plane to the face meets nothing else where both ends
/// are in the box.
struct ThinGap {
  core::PlainVec3 x, y;  ///< axes of unit length in the planes, along the sides of the box
  double low_x = 0.0, high_x = 0.0, low_y = 0.0, high_y = 0.0;  ///< sides of the box, mm
  std::uint32_t beyond = 0;                                     ///< a triangle of the face

  /// Whether a point between the two planes is in the box.
  bool contains(double along_x, double along_y) const {
    return along_x >= low_x && along_x <= high_x && along_y >= low_y && along_y <= high_y;
  }
};
static_assert(std::is_trivially_copyable_v<ThinGap>);

/// The thin gaps of a region by the triangles from whose planes rays start.
struct ThinGaps {
  struct Range {
    std::uint32_t begin = 0, end = 0;
  };
  std::vector<ThinGap> gaps;
  std::vector<Range> of_triangle;  ///< ranges of `gaps` by triangle of the boundary; empty: there are none

  bool empty() const { return gaps.empty(); }
};

/// The thin gaps of a region that Embree searches. Faces count that are rectangles; the gap is narrower than
/// a quarter of both sides of what two faces have in common. Gaps from one face to more than 16 others are
/// left out, and those of more than 256 directions: light there is followed by search.
ThinGaps find_thin_gaps(const Boundary& boundary, const std::vector<FlatFace>& faces);

}  // namespace scintray::scene
