#pragma once
/// Total reflections of light in a box along the axes, many at once, for one photon and for one in each lane
/// of a vector. No Eigen: the files of the lanes are compiled for instruction sets of their own.
///
/// A total reflection at a face of a box changes the sign of one component of the direction. The magnitudes
/// stay, and with them the angle of incidence on every face, so that it is known beforehand which faces
/// reflect a photon totally. Across each axis it moves back and forth as if it were alone there: it arrives
/// at the face ahead after some path, and from then on at the one and the other face in turn after equal
/// paths. (In the mirror images of the box beside each other the photon flies straight on.)

#include <limits>

#include "scintray/optics/fresnel_laws.hpp"
#include "scintray/transport/detail/propagation_laws.hpp"

namespace scintray::transport {

// For double; numbers in lanes have their own.
using core::bits_of;
using core::greatest;
using core::least;
using core::magnitude;
using core::number_of;
using core::select;
using core::whole_part;

/// What of a photon matters to its total reflections.
template <typename Real>
struct BoxFlight {
  Real depth_left, attenuation_per_mm;
  Real time_left_ns, time_ns_per_mm;
  Real interactions_left;  ///< that it may have, at most
};

/// The movement of a photon across one axis of a box.
template <typename Real>
class BoxAxis {
  using Mask = core::MaskOf<Real>;

 public:
  /// Of an axis. A face at its lower end comes second.
  struct Faces {
    Real first_mm, second_mm;  ///< place of each along its normal, from the middle of the region's frame
    Real per_length;           ///< 1 / distance of the two, 1/mm
    Real least_sin2_first, least_sin2_second;  ///< as of LaneWork
  };

  /// @param from     coordinate of the photon in the region's frame, mm
  /// @param towards  component of its direction
  BoxAxis(const Faces& faces, const Real& from, const Real& towards)
      : towards_(towards), first_mm_(faces.first_mm), second_mm_(faces.second_mm) {
    const Real speed = magnitude(towards);
    per_speed_ = Real(1.0) / speed;
    const Mask ahead_is_second = towards < Real(0.0);
    const Real room = select(ahead_is_second, faces.second_mm + from, faces.first_mm - from);
    arrival_mm_ = greatest(room, Real(0.0)) * per_speed_;
    period_mm_ = (faces.first_mm + faces.second_mm) * per_speed_;
    per_mm_ = speed * faces.per_length;
    const Real least_ahead = select(ahead_is_second, faces.least_sin2_second, faces.least_sin2_first);
    const Real least_behind = select(ahead_is_second, faces.least_sin2_first, faces.least_sin2_second);
    const Real never(std::numeric_limits<double>::infinity());
    const Real to_second = select(totally_reflected(speed, least_behind), never, arrival_mm_ + period_mm_);
    end_mm_ = select(totally_reflected(speed, least_ahead), to_second, arrival_mm_);
  }

  /// Path (mm) to the first face that does not reflect the photon totally. No number, which is not below
  /// others, of a photon that is on such a face and flies along it.
  const Real& end_mm() const { return end_mm_; }
  /// 1 / magnitude of the component of the direction.
  const Real& per_speed() const { return per_speed_; }
  /// Reflections per path while there is no such face, 1/mm.
  const Real& per_mm() const { return per_mm_; }

  /// Counts the total reflections within a path below end_mm().
  /// @return the path to the last of them, 0 without any
  Real pass(const Real& path_mm) {
    // Not more than a whole number of few bits: the others remain for another time.
    constexpr double kMost = 0x1.0p30;
    const Real none(0.0);
    const Real whole = whole_part(greatest(least((path_mm - arrival_mm_) * per_mm_, Real(kMost)), none));
    some_ = path_mm > arrival_mm_;
    count_ = select(some_, whole + Real(1.0), none);
    last_mm_ = select(some_, arrival_mm_ + whole * period_mm_, none);
    return last_mm_;
  }
  const Real& count() const { return count_; }
  /// The sign bit after an odd number of reflections.
  core::BitsOf<Real> sign() const { return core::whole_bits_of<Real>(count_) << 63; }
  Real direction() const { return number_of(bits_of(towards_) ^ sign()); }
  /// Coordinate after the path that pass() is about, where it is the last of those of all axes.
  /// @param at         coordinate before, mm
  /// @param centre     of the region's frame, in that of `at`
  /// @param passed_mm  that path
  Real coordinate(const Real& at, const Real& centre, const Real& passed_mm) const {
    const Real ahead = direction();
    const Real face = select(ahead < Real(0.0), first_mm_, -second_mm_);
    return select(some_, centre + face, at) + (passed_mm - last_mm_) * ahead;
  }

 private:
  Real towards_, first_mm_, second_mm_, per_speed_, arrival_mm_, period_mm_, per_mm_, end_mm_;
  Real count_, last_mm_;
  Mask some_;
};

/// The total reflections of a photon in a box up to one shortly before it arrives at a face that does not
/// reflect it totally, reaches its event in the medium, or one of the limits: all of them but for one or few,
/// which are treated one by one, as what follows is.
template <typename Real>
class BoxReflections {
  using Axis = BoxAxis<Real>;
  using Light = optics::LightRay<Real>;
  using Vector = core::Triple<Real>;

 public:
  Real path_mm;  ///< to the last of them; 0 without any
  Real count;

  /// @param faces  across x, y and z
  /// @param from   place of the photon in the region's frame, mm
  /// @param light  in the directions of that frame
  BoxReflections(const typename Axis::Faces (&faces)[3], const Vector& from, const Light& light,
                 const BoxFlight<Real>& flight)
      : x_(faces[0], from.x, light.direction.x),
        y_(faces[1], from.y, light.direction.y),
        z_(faces[2], from.z, light.direction.z),
        polarisation_(light.polarisation) {
    // Rounding, which is some 1e-16 of the path, must not take the photon past its end.
    constexpr double kBefore = 1.0 - 0x1.0p-40;
    // As many more as there are axes may be within a path.
    const Real most_mm = (flight.interactions_left - Real(4.0)) / (x_.per_mm() + y_.per_mm() + z_.per_mm());
    Real end = least(flight.depth_left / flight.attenuation_per_mm, most_mm);
    end = least(flight.time_left_ns / flight.time_ns_per_mm, end);
    end = least(x_.end_mm(), least(y_.end_mm(), least(z_.end_mm(), end)));
    const Real path = Real(kBefore) * end;
    path_mm = greatest(x_.pass(path), greatest(y_.pass(path), z_.pass(path)));
    count = x_.count() + y_.count() + z_.count();
  }

  /// Place after the last of them.
  /// @param at      place before, mm
  /// @param centre  of the region's frame, in that of `at`
  Vector position(const Vector& at, const Vector& centre) const {
    return {x_.coordinate(at.x, centre.x, path_mm), y_.coordinate(at.y, centre.y, path_mm),
            z_.coordinate(at.z, centre.z, path_mm)};
  }
  /// Each reflection changes the signs of those components of the polarisation that are along the face.
  Light light() const {
    const core::BitsOf<Real> all = core::whole_bits_of<Real>(count) << 63;
    const auto turned = [&all](const Real& component, const Axis& axis) {
      return number_of(bits_of(component) ^ axis.sign() ^ all);
    };
    return {{x_.direction(), y_.direction(), z_.direction()},
            {turned(polarisation_.x, x_), turned(polarisation_.y, y_), turned(polarisation_.z, z_)}};
  }
  /// 1 / magnitudes of the components of the direction.
  Vector per_speed() const { return {x_.per_speed(), y_.per_speed(), z_.per_speed()}; }

 private:
  Axis x_, y_, z_;
  Vector polarisation_;
};

}  // namespace scintray::transport
