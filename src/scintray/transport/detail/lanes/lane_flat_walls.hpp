#pragma once
/// The walls of a region that is bounded by planes, for LanePropagation.

#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/lanes/lane_planes.hpp"

namespace scintray::transport {
namespace {

/// Planes of a region up to which what is needed of the nearest one is selected with it; beyond it is loaded,
/// for each lane from a place of its own. In fewer than eight lanes, whose instruction sets have half of the
/// registers, loading is faster (1.04 by four in a polished box, before boxes had a kernel of their own).
inline constexpr std::uint32_t kFewPlanes = 8;

/// @tparam kFew  there are no more than kFewPlanes
template <typename Real, bool kFew>
class LaneFlatWalls {
  using Vector = core::Triple<Real>;
  using Mask = typename Real::Mask;

 public:
  using Number = Real;
  static constexpr bool kEncloses = true;  ///< every ray leaves through a wall
  using Region = LanePlanes;
  /// The nearest plane; where there are few with its numbers.
  struct Ahead : LaneAhead<Real> {
    Vector normal{Real(0.0), Real(0.0), Real(0.0)};
    Real least_sin2{0.0};
  };

  explicit LaneFlatWalls(const LanePlanes& planes) : planes_(planes) {}

  void set(std::size_t lane, const LaneWork& photon) {
    if constexpr (kFew)
      for (std::uint32_t i = 0; i < planes_.count; ++i) few_least_sin2_[i].of[lane] = photon.least_sin2[i];
    else
      least_sin2_[lane] = photon.least_sin2;
  }
  // Planes have no state in a lane.
  void get(std::size_t, LaneWork&) const {}
  void leave(const Ahead&) {}
  void leave(const Ahead&, const Mask&) {}

  Ahead nearest(const Vector& local, const Vector& direction) const {
    Ahead ahead;
    for (std::uint32_t i = 0; i < planes_.opposite; i += 2) take({i, i + 1}, local, direction, ahead);
    for (std::uint32_t i = planes_.opposite; i < planes_.count; ++i) take({i, i}, local, direction, ahead);
    return ahead;
  }
  LaneArrival<Real> arrive(const Ahead& ahead, const Vector&, const Vector&, Vector&) const {
    if constexpr (kFew) return {ahead.normal, ahead.cosine, ahead.least_sin2};
    LaneNumbers<Real> faces;
    faces.store(ahead.plane);
    const double *planes[Real::kWidth], *least_sin2[Real::kWidth];
    for (std::size_t lane = 0; lane < Real::kWidth; ++lane) {
      const auto face = static_cast<std::uint32_t>(faces.of[lane]);
      planes[lane] = planes_.plane(face);
      least_sin2[lane] = least_sin2_[lane] + face;
    }
    core::LaneFours<Real> normals;
    load_fours(planes, normals);
    return {{normals.of[0], normals.of[1], normals.of[2]}, ahead.cosine, load_each<Real>(least_sin2)};
  }
  /// optics::reflect.
  static optics::LightRay<Real> reflected(const Ahead&, const LaneArrival<Real>& at,
                                          const optics::LightRay<Real>& light) {
    return {core::mirrored(light.direction, at.normal, at.cosine),
            -core::mirrored(light.polarisation, at.normal)};
  }

 private:
  /// Two opposite planes, or one.
  struct Planes {
    std::uint32_t first, second;
  };
  void take(const Planes& planes, const Vector& local, const Vector& direction, Ahead& ahead) const {
    const double *const p = planes_.plane(planes.first), *const q = planes_.plane(planes.second);
    const bool paired = planes.first != planes.second;
    const Vector normal = vector_of(p);
    const LaneTaken<Real> taken =
        ahead.take(normal, Real(p[3]), Real(paired ? q[3] : std::numeric_limits<double>::infinity()), local,
                   direction, planes.first);
    if constexpr (kFew) {
      ahead.normal = select(taken.closer, select(taken.first, normal, vector_of(q)), ahead.normal);
      const Real least_sin2 =
          select(taken.first, few_least_sin2_[planes.first].load(), few_least_sin2_[planes.second].load());
      ahead.least_sin2 = select(taken.closer, least_sin2, ahead.least_sin2);
    }
  }
  static Vector vector_of(const double* plane) { return {Real(plane[0]), Real(plane[1]), Real(plane[2])}; }

  const LanePlanes& planes_;
  const double* least_sin2_[Real::kWidth];                   ///< of each lane, per face
  LaneNumbers<Real> few_least_sin2_[kFew ? kFewPlanes : 1];  ///< of each face
};

/// Inlined, so that a profile has the time under the name of the kernel, which is known outside its file.
template <typename Real>
[[gnu::always_inline]] inline void propagate_between_planes(const LanePlanes& planes,
                                                            const LaneLimits& limits,
                                                            LaneWork* const* photons, std::size_t count) {
  if constexpr (Real::kWidth >= 8)
    if (planes.count <= kFewPlanes)
      return LanePropagation<LaneSet<LaneFlatWalls<Real, true>>>::run(planes, limits, photons, count);
  LanePropagation<LaneSet<LaneFlatWalls<Real, false>>>::run(planes, limits, photons, count);
}

}  // namespace
}  // namespace scintray::transport
