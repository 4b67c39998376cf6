#include "scintray/contact/detail/overlay.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <climits>
#include <deque>
#include <map>

namespace scintray::contact {

namespace {

/// Winding number of each label, ascending by label, zeros left out.
using Windings = std::vector<std::pair<int, int>>;

struct PointIndex {
  int value = -1;
};
struct CellState {
  bool reached = false;
  Windings windings;
};

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<PointIndex, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel,
                                                CGAL::Triangulation_face_base_with_info_2<CellState, Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_intersections_tag>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<Delaunay>;

void add(Windings& windings, int label, int amount) {
  const auto it = std::lower_bound(windings.begin(), windings.end(), std::pair(label, INT_MIN));
  if (it == windings.end() || it->first != label) {
    windings.insert(it, {label, amount});
  } else if ((it->second += amount) == 0) {
    windings.erase(it);
  }
}

class Sweep {
 public:
  Sweep(const std::vector<Vec2>& points, const std::vector<OverlayEdge>& edges) : edges_(edges) {
    std::vector<Triangulation::Vertex_handle> handles;
    Triangulation::Face_handle hint;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto handle = triangulation_.insert(Kernel::Point_2(points[i].x(), points[i].y()), hint);
      handle->info().value = static_cast<int>(i);
      hint = handle->face();
      handles.push_back(handle);
    }
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto id = triangulation_.insert_constraint(handles[edges[e].a], handles[edges[e].b]);
      edge_of_[id.vl_ptr()] = e;
    }
  }

  Overlay run(std::vector<Vec2> points) {
    spread();
    Overlay result{std::move(points), {}};
    for (const auto face : triangulation_.finite_face_handles()) {
      OverlayCell cell;
      for (const auto& [label, winding] : face->info().windings)
        if (winding > 0) cell.labels.push_back(label);
      if (cell.labels.empty()) continue;
      for (int k = 0; k < 3; ++k) {
        int& index = face->vertex(k)->info().value;
        if (index < 0) {
          index = static_cast<int>(result.points.size());
          // exact(): a lazy number's own conversion is only good to five digits.
          const auto& p = CGAL::exact(face->vertex(k)->point());
          result.points.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()));
        }
        cell.point[k] = index;
      }
      result.cells.push_back(std::move(cell));
    }
    return result;
  }

 private:
  void spread() {
    std::deque<Triangulation::Face_handle> queue{triangulation_.infinite_face()};
    queue.front()->info().reached = true;
    while (!queue.empty()) {
      const auto face = queue.front();
      queue.pop_front();
      for (int k = 0; k < 3; ++k) {
        const auto next = face->neighbor(k);
        if (next->info().reached) continue;
        next->info().reached = true;
        next->info().windings = face->info().windings;
        if (face->is_constrained(k)) cross(face, k, next->info().windings);
        queue.push_back(next);
      }
    }
  }

  /// From `face` across its side k: the neighbour is to the left of from -> to.
  void cross(Triangulation::Face_handle face, int k, Windings& windings) {
    const auto from = face->vertex(Triangulation::cw(k)), to = face->vertex(Triangulation::ccw(k));
    for (auto context : triangulation_.contexts(from, to)) {  // id() is not const
      const int sign = *context.current() == from ? 1 : -1;
      for (const auto& [label, winding] : edges_[edge_of_.at(context.id().vl_ptr())].winding)
        add(windings, label, sign * winding);
    }
  }

  const std::vector<OverlayEdge>& edges_;
  Triangulation triangulation_;
  std::map<const void*, std::size_t> edge_of_;
};

}  // namespace

Overlay overlay(std::vector<Vec2> points, const std::vector<OverlayEdge>& edges) {
  Sweep sweep(points, edges);
  return sweep.run(std::move(points));
}

}  // namespace scintray::contact
