#pragma once
/// The walls of a region that is one convex body of planes and quadrics, for LanePropagation: for each lane
/// the numbers that ExactBodies::nearest and CurvedPropagation (propagation_states.hpp) have for one photon,
/// in the same order.

#include "scintray/core/lanes/lane_fours.hpp"
#include "scintray/mesh/cylinder_arrival.hpp"
#include "scintray/mesh/quadric_laws.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_kernel_of.hpp"
#include "scintray/transport/detail/lanes/lane_numbers.hpp"
#include "scintray/transport/detail/lanes/lane_planes.hpp"

namespace scintray::transport {
namespace {

using core::LaneFours;

/// @tparam kShape  of all quadrics
template <typename Real, mesh::QuadricShape kShape>
class LaneBodyWalls {
  using Quadric = mesh::QuadricOf<Real, kShape>;
  using Mask = typename Real::Mask;
  using Vector = core::Triple<Real>;

 public:
  using Number = Real;
  static constexpr bool kEncloses = false;  ///< rounding may lead past all walls
  using Region = LaneBody;
  /// The nearest face so far.
  struct Ahead {
    Real distance_mm{std::numeric_limits<double>::infinity()}, plane{0.0};
    Vector normal{Real(0.0), Real(0.0), Real(0.0)};  ///< of a plane
  };
  explicit LaneBodyWalls(const LaneBody& body) : body_(body) {}

  void set(std::size_t lane, const LaneWork& photon) {
    left_.of[lane] = photon.left;
    least_sin2_[lane] = photon.least_sin2;
  }
  void get(std::size_t lane, LaneWork& photon) const { photon.left = left_.of[lane]; }
  void leave(const Ahead& ahead) { left_.store(ahead.plane); }
  void leave(const Ahead& ahead, const Mask& stays) { left_.store(select(stays, left_.load(), ahead.plane)); }

  Ahead nearest(const Vector& local, const Vector& direction) const {
    const Real zero(0.0);
    Ahead ahead;
    const auto take = [&ahead](const Mask& closer, const Real& distance_mm, const Real& face) {
      ahead.distance_mm = select(closer, distance_mm, ahead.distance_mm);
      ahead.plane = select(closer, face, ahead.plane);
    };
    for (std::uint32_t i = 0; i < body_.planes; ++i) {
      const Vector normal = vector_of(body_.faces[i].axis);
      const Real along = dot(normal, direction);
      const Real distance = core::greatest((Real(body_.faces[i].offset) - dot(normal, local)) / along, zero);
      const Mask closer = (along > zero) & (distance < ahead.distance_mm);
      take(closer, distance, Real(static_cast<double>(i)));
      ahead.normal = select(closer, normal, ahead.normal);
    }
    for (std::uint32_t i = body_.planes; i < body_.count; ++i) {
      mesh::QuadricOnRayOf<Real> on_ray = quadric(body_.faces[i]).on_ray(local, direction);
      const Real number(static_cast<double>(i));
      on_ray.c = select(left_.load() == number, zero, on_ray.c);
      const Real distance = mesh::distance_out(on_ray);
      take(distance < ahead.distance_mm, distance, number);
    }
    return ahead;
  }
  /// Whether a lane's ray leaves through no face.
  Mask none(const Ahead& ahead) const {
    return ahead.distance_mm == Real(std::numeric_limits<double>::infinity());
  }
  /// Moves the point `there` (world) onto the face.
  LaneArrival<Real> arrive(const Ahead& ahead, const Vector& direction, const Vector& centre,
                           Vector& there) const {
    const Real zero(0.0);
    LaneNumbers<Real> faces;
    faces.store(ahead.plane);
    const double* least_sin2[Real::kWidth];
    for (std::size_t lane = 0; lane < Real::kWidth; ++lane)
      least_sin2[lane] = least_sin2_[lane] + static_cast<std::uint32_t>(faces.of[lane]);
    const Mask flat = ahead.plane < Real(static_cast<double>(body_.planes));
    const Wall wall = body_.count - body_.planes == 1 ? only_wall() : walls_at(faces);
    const mesh::FootOf<Real> round = foot(wall, there - centre);
    there = there + select(flat, Vector{zero, zero, zero}, round.step);
    const Vector normal = select(flat, ahead.normal, wall.outwards * round.normal);
    return {normal, dot(direction, normal), load_each<Real>(least_sin2)};
  }
  /// optics::reflect.
  static optics::LightRay<Real> reflected(const Ahead&, const LaneArrival<Real>& at,
                                          const optics::LightRay<Real>& light) {
    return {core::mirrored(light.direction, at.normal, at.cosine),
            -core::mirrored(light.polarisation, at.normal)};
  }

 private:
  /// A quadric, and numbers of LaneBody::Face; of a plane any numbers.
  struct Wall {
    Quadric quadric;
    Real outwards, inverse_radius;
  };
  /// As Accelerator::nearest_at.
  static mesh::FootOf<Real> foot(const Wall& wall, const Vector& point) {
    if constexpr (kShape == mesh::QuadricShape::cylinder)
      return mesh::arrival_on_cylinder(wall.quadric, wall.inverse_radius, point);
    else
      return wall.quadric.nearest(point);
  }
  Wall only_wall() const {
    const LaneBody::Face& face = body_.faces[body_.planes];
    return {quadric(face), Real(face.outwards), Real(face.inverse_radius)};
  }
  Wall walls_at(const LaneNumbers<Real>& faces) const {
    const double *first[Real::kWidth], *second[Real::kWidth], *third[Real::kWidth];
    for (std::size_t lane = 0; lane < Real::kWidth; ++lane) {
      const LaneBody::Face& face = body_.faces[static_cast<std::uint32_t>(faces.of[lane])];
      first[lane] = face.origin, second[lane] = face.axis, third[lane] = &face.radius2;
    }
    LaneFours<Real> a, b, c;
    load_fours(first, a);
    load_fours(second, b);
    load_fours(third, c);
    return {{{a.of[0], a.of[1], a.of[2]}, {b.of[0], b.of[1], b.of[2]}, a.of[3], b.of[3], c.of[0]},
            c.of[1],
            c.of[2]};
  }
  static Quadric quadric(const LaneBody::Face& face) {
    return {vector_of(face.origin), vector_of(face.axis), Real(face.axial), Real(face.slope),
            Real(face.radius2)};
  }
  static Vector vector_of(const double (&of)[3]) { return {Real(of[0]), Real(of[1]), Real(of[2])}; }

  const LaneBody& body_;
  LaneNumbers<Real> left_;
  const double* least_sin2_[Real::kWidth];
};

/// Inlined, so that a profile has the time under the name of the kernel, which is known outside its file.
template <typename Real>
[[gnu::always_inline]] inline void propagate_in_body(const LaneBody& body, const LaneLimits& limits,
                                                     LaneWork* const* photons, std::size_t count) {
  using mesh::QuadricShape;
  if (body.cylinders)
    LanePropagation<LaneSet<LaneBodyWalls<Real, QuadricShape::cylinder>>>::run(body, limits, photons, count);
  else
    LanePropagation<LaneSet<LaneBodyWalls<Real, QuadricShape::any>>>::run(body, limits, photons, count);
}

}  // namespace
}  // namespace scintray::transport
