#pragma once
/// Propagation of several photons at once, in the lanes of vector registers, through convex regions that are
/// bounded by planes, or by planes and quadrics of revolution.
///
/// This header has only plain data: it is included by files that are compiled for instruction sets which not
/// every processor has, and a function of a common header compiled there could be the one that the linker
/// keeps for all files.

#include <cstddef>
#include <cstdint>

namespace scintray::transport {

/// The end of a photon's propagation through its region.
enum class LaneEnd : std::uint32_t {
  bulk,        ///< the next event is in the medium; the photon is where its last segment began
  boundary,    ///< the photon is on a face at which no total reflection follows
  total,       ///< it was totally reflected, and the limits are reached
  unclear,     ///< the next face leads to several regions; the photon is where its last segment began
  unfinished,  ///< the photon was totally reflected, and is to be propagated on beside others
};

/// Planes around one shape of region, in the region's frame (mm).
struct LanePlanes {
  /// Of each plane four numbers: its normal, of unit length and out of the region, and the product of normal
  /// and any point of the plane.
  const double* first = nullptr;
  std::size_t stride = 4;  ///< from one plane to the next
  std::uint32_t count = 0;
  std::uint32_t opposite = 0;  ///< of these, the first: two by two with opposite normals
  bool box = false;            ///< as scene::Boundary::is_box

  /// Always inlined, as no function of this header may be left to the linker.
  [[gnu::always_inline]] const double* plane(std::size_t i) const { return first + i * stride; }
};

/// Faces around one shape of region that is one convex body, in the region's frame (mm): planes, and after
/// them quadrics of revolution (mesh/quadric_laws.hpp). Face i is face i of LaneWork.
struct LaneBody {
  /// A face as it is loaded: four numbers at a time.
  struct Face {
    double origin[3], axial;  ///< of a plane 0
    double axis[3], slope;    ///< of a plane its normal, of unit length and out of the region; 0
    double radius2;
    double outwards;        ///< 1: normals of the quadric point out of the region, -1: into it; of a plane 1
    double inverse_radius;  ///< of a cylinder, 1/mm; else 0
    double offset;          ///< of a plane: the product of normal and any point of it
  };
  const Face* faces = nullptr;
  std::uint32_t planes = 0, count = 0;
  bool cylinders = false;  ///< all quadrics are cylinders
};

/// Values of LaneWork::least_sin2 above every sine squared.
inline constexpr double kNoTotalReflection = 2.0;  ///< a face without total reflection, or that is not smooth
inline constexpr double kManyRegions = 4.0;        ///< a face that leads to several regions

/// Of LaneWork::left.
inline constexpr double kNoFace = -1.0;

/// A photon to be propagated through its region, whose frame must not be rotated. Rows of four numbers are
/// loaded and stored at once.
struct LaneWork {
  double position[3], path_mm;  ///< world, mm; these and the next two rows as of source::Photon
  double direction[3], time_ns;
  double polarisation[3], depth_left;
  double index, index_there;  ///< refractive indices of the region and behind the face that it is at
  std::uint64_t stream[2];    ///< of random numbers: core::Rng::State
  double group_index, attenuation_per_mm;  ///< absorption and scattering together
  double interactions;                     ///< boundary interactions so far: a whole number
  double cosine;     ///< a result: of incidence on the face, at a boundary and at a total reflection
  double centre[3];  ///< origin of the region's frame
  double left;       ///< of a body: face at which the photon is, as it was reflected there; kNoFace: at none
  const double* least_sin2;  ///< per face: sine squared of the angle from which light is totally reflected
  /// Per face: refractive index behind it, where Fresnel's equations alone decide what light does there and
  /// it is flat; else 0.
  const double* index_behind;
  // Results.
  std::uint32_t face;      ///< reached, or unclear; not for LaneEnd::bulk and unfinished
  std::uint32_t segments;  ///< straight segments; the last of an unclear end is not counted
  LaneEnd end;
  std::uint32_t transmitted;  ///< of RefractLanes: 1 when light is transmitted, and not reflected
};

/// Normal of a flat face, of unit length and out of the region.
struct LaneNormal {
  double of[4];  ///< the fourth is not used
};

/// Limits as of PropagationLimits.
struct LaneLimits {
  double interactions, time_ns;
};

/// Propagates each of `count` photons, one or more, wherever they are, to its end, exactly as propagate()
/// does it one by one; of more than fill the lanes the last ones may be left unfinished, so that lanes are
/// not empty.
using PropagateLanes = void (*)(const LanePlanes& planes, const LaneLimits& limits, LaneWork* const* photons,
                                std::size_t count);

using PropagateLanesInBody = void (*)(const LaneBody& body, const LaneLimits& limits,
                                      LaneWork* const* photons, std::size_t count);

/// Reflects or refracts each of `count` photons, one or more, at its face, as optics::interact_at_facet.
/// @param normals  of the faces
using RefractLanes = void (*)(const LaneNormal* normals, LaneWork* const* photons, std::size_t count);

// One for each width that this build has; defined where its instruction set is compiled.
void propagate_lanes_2(const LanePlanes&, const LaneLimits&, LaneWork* const*, std::size_t);
void propagate_lanes_4(const LanePlanes&, const LaneLimits&, LaneWork* const*, std::size_t);
void propagate_lanes_8(const LanePlanes&, const LaneLimits&, LaneWork* const*, std::size_t);
void propagate_lanes_in_body_2(const LaneBody&, const LaneLimits&, LaneWork* const*, std::size_t);
void propagate_lanes_in_body_4(const LaneBody&, const LaneLimits&, LaneWork* const*, std::size_t);
void propagate_lanes_in_body_8(const LaneBody&, const LaneLimits&, LaneWork* const*, std::size_t);

void refract_lanes_4(const LaneNormal*, LaneWork* const*, std::size_t);
void refract_lanes_8(const LaneNormal*, LaneWork* const*, std::size_t);

}  // namespace scintray::transport
