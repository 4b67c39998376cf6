#include "scintray/mesh/weld.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace scintray::mesh {
namespace {

constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

/// Representatives by cell of a grid of spacing 4 * length, so that a point's neighbours within
/// `length` lie in at most 8 cells and mostly in one.
class VertexGrid {
 public:
  explicit VertexGrid(double length) : length_(length), cell_(4.0 * length) {}

  /// The earliest representative within `length` of point along every axis, or kNone.
  std::uint32_t find(const core::Vec3& point, const std::vector<core::Vec3>& vertices) const {
    const auto low = cell_of(point - core::Vec3::Constant(length_)),
               high = cell_of(point + core::Vec3::Constant(length_));
    std::uint32_t found = kNone;
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto cell = last_in_cell_.find({x, y, z});
          if (cell == last_in_cell_.end()) continue;
          for (std::uint32_t v = cell->second; v != kNone; v = before_in_cell_[v])
            if ((vertices[v] - point).cwiseAbs().maxCoeff() <= length_) found = std::min(found, v);
        }
      }
    }
    return found;
  }

  /// Adds a representative; they are numbered from 0 in the order in which they are added.
  void insert(const core::Vec3& point) {
    const auto number = static_cast<std::uint32_t>(before_in_cell_.size());
    const auto [cell, is_new] = last_in_cell_.try_emplace(cell_of(point), number);
    before_in_cell_.push_back(is_new ? kNone : std::exchange(cell->second, number));
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t h = 0;
      for (const std::int64_t i : cell) {
        h = (h ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15ULL;
        h ^= h >> 29;
      }
      return static_cast<std::size_t>(h);
    }
  };

  /// Coordinates are at most 2^22 lengths, so cells are below 2^20 and fit.
  Cell cell_of(const core::Vec3& point) const {
    if (cell_ == 0.0) return {0, 0, 0};  // every coordinate is zero
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(point[axis] / cell_));
    }
    return cell;
  }

  double length_, cell_;
  std::unordered_map<Cell, std::uint32_t, Hash> last_in_cell_;
  std::vector<std::uint32_t> before_in_cell_;  ///< of each representative, the one added before it, or kNone
};

}  // namespace

void drop_unused_vertices(TriMesh& mesh) {
  std::vector<std::uint32_t> index(mesh.vertices.size(), kNone);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) index[v] = 0;
  }
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < index.size(); ++v) {
    if (index[v] == kNone) continue;
    mesh.vertices[next] = mesh.vertices[v];
    index[v] = next++;
  }
  mesh.vertices.resize(next);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = index[v];
  }
}

std::size_t weld_vertices(TriMesh& mesh, double length_mm) {
  const std::size_t before = mesh.vertices.size();
  drop_unused_vertices(mesh);  // they may be anywhere, beyond the cells of the grid too
  std::vector<std::uint32_t> index(mesh.vertices.size());
  std::vector<core::Vec3> kept;
  VertexGrid grid(length_mm);
  for (std::size_t v = 0; v < index.size(); ++v) {
    const core::Vec3& point = mesh.vertices[v];
    std::uint32_t representative = grid.find(point, kept);
    if (representative == kNone) {
      representative = static_cast<std::uint32_t>(kept.size());
      kept.push_back(point);
      grid.insert(point);
    }
    index[v] = representative;
  }
  mesh.vertices = std::move(kept);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = index[v];
  }
  return before - mesh.vertices.size();
}

}  // namespace scintray::mesh
