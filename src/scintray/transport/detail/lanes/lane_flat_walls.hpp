#pragma once
/// The walls of a region that is bounded by planes, for LanePropagation.

#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/lanes/lane_planes.hpp"

namespace scintray::transport {
namespace {

template <typename Real>
class LaneFlatWalls {
  using Vector = core::Triple<Real>;

 public:
  using Number = Real;
  using Region = LanePlanes;
  using Ahead = LaneAhead<Real>;
  explicit LaneFlatWalls(const LanePlanes& planes) : planes_(planes) {}

  // Planes have no state in a lane.
  void set(std::size_t, const LaneWork&) {}
  void get(std::size_t, LaneWork&) const {}
  void copy(std::size_t, std::size_t) {}
  void leave(const LaneAhead<Real>&) {}
  void leave(const LaneAhead<Real>&, const typename Real::Mask&) {}

  LaneAhead<Real> nearest(const Vector& local, const Vector& direction) const {
    LaneAhead<Real> ahead;
    const auto take = [&](std::uint32_t i, const Real& second_mm) {
      const double* const p = planes_.plane(i);
      ahead.take({Real(p[0]), Real(p[1]), Real(p[2])}, Real(p[3]), second_mm, local, direction, i);
    };
    for (std::uint32_t i = 0; i < planes_.opposite; i += 2) take(i, Real(planes_.plane(i + 1)[3]));
    for (std::uint32_t i = planes_.opposite; i < planes_.count; ++i)
      take(i, Real(std::numeric_limits<double>::infinity()));
    return ahead;
  }
  /// Whether a lane's ray leaves through no wall: never, as the planes enclose the region.
  typename Real::Mask none(const LaneAhead<Real>& ahead) const { return ahead.cosine < Real(0.0); }
  LaneIncidence<Real> arrive(const LaneNumbers<Real>& faces, const LaneAhead<Real>& ahead, const Vector&,
                             const Vector&, Vector&) const {
    LaneNumbers3<Real> normals;
    for (std::size_t lane = 0; lane < Real::kWidth; ++lane)
      normals.set(lane, planes_.plane(static_cast<std::size_t>(faces.of[lane])));
    return {normals.load(), ahead.cosine};
  }

 private:
  const LanePlanes& planes_;
};

}  // namespace
}  // namespace scintray::transport
