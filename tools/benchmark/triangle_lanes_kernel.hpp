#pragma once
/// The test of triangles, written once for all vector registers. Included by the files of one instruction set
/// each; nothing here is compiled for another one.

#include <limits>
#include <xsimd/xsimd.hpp>

#include "triangle_lanes.hpp"

namespace scintray::bench {

template <typename Lanes>
struct LaneKernel {
  using Real = typename Lanes::value_type;
  static constexpr std::size_t kWidth = Lanes::size;
  /// Barycentric distance beyond an edge that still counts as inside, so that no ray passes between
  /// triangles.
  static constexpr Real kEdge = sizeof(Real) == 8 ? Real(1e-12) : Real(1e-5);

  struct Vector {
    Lanes x, y, z;
    Lanes dot(const Vector& b) const { return x * b.x + y * b.y + z * b.z; }
  };
  struct Ray {
    Vector origin, direction;
  };
  struct Nearest {
    Lanes height = Lanes(Real(1)), along = Lanes(Real(0)), triangle = Lanes(Real(-1));
  };

  /// Takes what is nearer than before; divides only where something is.
  template <typename Number>
  static void test(const Ray& ray, Number number, const Lanes& triangle, Lanes behind, Nearest& nearest) {
    const Vector normal{number(0), number(1), number(2)};
    const Lanes along = normal.dot(ray.direction), height = number(3) - normal.dot(ray.origin);
    const auto ahead =
        (along > Lanes(Real(0))) & (height >= -behind) & (height * nearest.along < nearest.height * along);
    const Vector first{number(4), number(5), number(6)}, second{number(8), number(9), number(10)};
    const Lanes u = along * (first.dot(ray.origin) + number(7)) + height * first.dot(ray.direction);
    const Lanes v = along * (second.dot(ray.origin) + number(11)) + height * second.dot(ray.direction);
    const Lanes edge = Lanes(-kEdge) * along;
    const auto hit = ahead & (u >= edge) & (v >= edge) & (along - u - v >= edge);
    nearest.height = xsimd::select(hit, height, nearest.height);
    nearest.along = xsimd::select(hit, along, nearest.along);
    nearest.triangle = xsimd::select(hit, triangle, nearest.triangle);
  }

  static void write(Real distance, Real triangle, std::size_t ray, const TriangleTask<Real>& task) {
    task.triangle[ray] = triangle < 0 ? 0xffffffffu : static_cast<std::uint32_t>(triangle);
    task.distance_mm[ray] = static_cast<float>(distance);
  }

  /// One triangle after another with as many rays as there are lanes.
  static void trace_rays(const TriangleTask<Real>& task) {
    const Lanes behind(task.behind_mm);
    for (std::size_t first = 0; first + kWidth <= task.count; first += kWidth) {
      const auto load = [&](int k) { return Lanes::load_unaligned(task.rays[k] + first); };
      const Ray ray{{load(0), load(1), load(2)}, {load(3), load(4), load(5)}};
      Nearest nearest;
      for (std::size_t i = 0; i < task.triangles; ++i) {
        const Real* const numbers = task.tests + kTestNumbers * i;
        test(
            ray, [numbers](int k) { return Lanes(numbers[k]); }, Lanes(static_cast<Real>(i)), behind,
            nearest);
      }
      alignas(64) Real distances[kWidth], triangles[kWidth];
      (nearest.height / nearest.along).store_aligned(distances);
      nearest.triangle.store_aligned(triangles);
      for (std::size_t lane = 0; lane < kWidth; ++lane)
        write(distances[lane], triangles[lane], first + lane, task);
    }
  }

  /// One ray after another with as many triangles as there are lanes.
  static void trace_triangles(const TriangleTask<Real>& task) {
    const Lanes behind(task.behind_mm);
    alignas(64) Real counts[kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) counts[lane] = static_cast<Real>(lane);
    const Lanes lanes = Lanes::load_aligned(counts);
    for (std::size_t r = 0; r < task.count; ++r) {
      const auto all = [&](int k) { return Lanes(task.rays[k][r]); };
      const Ray ray{{all(0), all(1), all(2)}, {all(3), all(4), all(5)}};
      Nearest nearest;
      const Real* numbers = task.tests;
      for (std::size_t i = 0; i < task.triangles; i += kWidth, numbers += kTestNumbers * kWidth)
        test(
            ray,
            [numbers](int k) {
              return Lanes::load_unaligned(numbers + static_cast<std::size_t>(k) * kWidth);
            },
            lanes + Lanes(static_cast<Real>(i)), behind, nearest);
      alignas(64) Real distances[kWidth], triangles[kWidth];
      (nearest.height / nearest.along).store_aligned(distances);
      nearest.triangle.store_aligned(triangles);
      std::size_t least = 0;
      for (std::size_t lane = 1; lane < kWidth; ++lane)
        least = distances[lane] < distances[least] ? lane : least;
      write(distances[least], triangles[least], r, task);
    }
  }
};

}  // namespace scintray::bench
