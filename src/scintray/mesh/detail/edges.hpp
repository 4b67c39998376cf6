#pragma once
/// Edges of a mesh, and the triangles that share each.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// Angle (rad, 0 to pi) between two directions of any length; exact also for small angles.
inline double angle_between(const core::Vec3& a, const core::Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// One triangle's use of the edge between vertices low < high.
struct EdgeUse {
  std::uint32_t low, high;
  std::uint32_t triangle;
  bool forward;  ///< the triangle runs from low to high
};

/// All uses, sorted by edge and then by triangle. A side whose two vertices are the same is no edge.
std::vector<EdgeUse> sorted_edge_uses(const TriMesh& mesh);

/// Calls visit(first, last) with the range of uses of each edge.
template <typename Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first + 1;
    while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high) {
      ++last;
    }
    visit(&uses[first], &uses[0] + last);
    first = last;
  }
}

/// The triangles beside each triangle, through shared edges of any number of triangles.
class TriangleNeighbours {
 public:
  explicit TriangleNeighbours(const TriMesh& mesh);
  const std::uint32_t* begin(std::size_t triangle) const { return list_.data() + start_[triangle]; }
  const std::uint32_t* end(std::size_t triangle) const { return list_.data() + start_[triangle + 1]; }

 private:
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> list_;
};

/// Label per triangle, 0, 1, ... in order of first triangle: sets connected through edges. The number
/// of labels is in `count`.
std::vector<std::uint32_t> connected_bodies(const TriMesh& mesh, std::size_t& count);

}  // namespace scintray::mesh
