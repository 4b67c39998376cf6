#include "scintray/mesh/detail/edges.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace scintray::mesh {

namespace {

bool comes_before(const EdgeUse& a, const EdgeUse& b) {
  return std::tie(a.low, a.high, a.triangle, a.forward) < std::tie(b.low, b.high, b.triangle, b.forward);
}

template <typename Visit>
void for_each_use(const TriMesh& mesh, Visit visit) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t from = mesh.triangles[t][side];
      const std::uint32_t to = mesh.triangles[t][(side + 1) % 3];
      if (from == to) continue;
      visit(EdgeUse{std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(t), from < to});
    }
  }
}

}  // namespace

/// Those of each lower vertex are first brought together: some six, which take no time to sort.
std::vector<EdgeUse> sorted_edge_uses(const TriMesh& mesh) {
  std::uint32_t last = 0;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) last = std::max(last, v);
  std::vector<std::size_t> start(std::size_t{last} + 2, 0);
  for_each_use(mesh, [&start](const EdgeUse& use) { ++start[use.low + std::size_t{1}]; });
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<EdgeUse> uses(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for_each_use(mesh, [&](const EdgeUse& use) { uses[next[use.low]++] = use; });
  for (std::size_t v = 0; v + 1 < start.size(); ++v)
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(start[v]),
              uses.begin() + static_cast<std::ptrdiff_t>(start[v + 1]), comes_before);
  return uses;
}

TriangleNeighbours::TriangleNeighbours(const TriMesh& mesh) : start_(mesh.triangles.size() + 1, 0) {
  const auto uses = sorted_edge_uses(mesh);
  // An edge of many triangles links them in a ring, so that its cost is linear.
  const auto for_each_link = [&uses](auto&& link) {
    for_each_edge(uses, [&link](const EdgeUse* first, const EdgeUse* last) {
      const std::size_t n = static_cast<std::size_t>(last - first);
      for (std::size_t i = 0; i + 1 < n; ++i) link(first[i].triangle, first[i + 1].triangle);
      if (n > 2) link(first[n - 1].triangle, first[0].triangle);
    });
  };
  for_each_link([this](std::uint32_t a, std::uint32_t b) { ++start_[a + 1], ++start_[b + 1]; });
  for (std::size_t t = 0; t + 1 < start_.size(); ++t) start_[t + 1] += start_[t];
  list_.resize(start_.back());
  auto next = start_;
  for_each_link([this, &next](std::uint32_t a, std::uint32_t b) {
    list_[next[a]++] = b;
    list_[next[b]++] = a;
  });
}

std::vector<std::uint32_t> connected_bodies(const TriMesh& mesh, std::size_t& count) {
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  const TriangleNeighbours neighbours(mesh);
  std::vector<std::uint32_t> label(mesh.triangles.size(), kNone);
  std::vector<std::uint32_t> stack;
  count = 0;
  for (std::size_t seed = 0; seed < label.size(); ++seed) {
    if (label[seed] != kNone) continue;
    label[seed] = static_cast<std::uint32_t>(count);
    stack.push_back(static_cast<std::uint32_t>(seed));
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (auto* n = neighbours.begin(t); n != neighbours.end(t); ++n) {
        if (label[*n] != kNone) continue;
        label[*n] = static_cast<std::uint32_t>(count);
        stack.push_back(*n);
      }
    }
    ++count;
  }
  return label;
}

}  // namespace scintray::mesh
