#pragma once
/// Photons that stay in the lanes of vector registers through interactions at the surfaces of regions bounded
/// by planes.
///
/// This header has only plain data: it is included by files that are compiled for instruction sets which not
/// every processor has, and a function of a common header compiled there could be the one that the linker
/// keeps for all files.

#include <cstddef>
#include <cstdint>

#include "scintray/optics/table_laws.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"

namespace scintray::transport {

/// The next stage of a photon of the pool. Floating-point numbers, as they are compared in lanes.
namespace lane_state {
inline constexpr double kEmpty = 0.0;
inline constexpr double kPropagate = 1.0;  ///< along its direction to the next plane
inline constexpr double kAcross = 2.0;     ///< across a thin gap, from the face that it is on
inline constexpr double kSmooth = 3.0;     ///< Fresnel's equations at the mean normal
inline constexpr double kFacets = 4.0;     ///< a facet is drawn, then Fresnel's equations
inline constexpr double kTable = 5.0;      ///< a surface table
inline constexpr double kReflector = 6.0;  ///< the reflector behind the microsurface
inline constexpr double kPolarise = 7.0;   ///< a polarisation is drawn; LanePhoton::next follows
// Two that are left at once.
inline constexpr double kReflected = 8.0;  ///< back in its region
inline constexpr double kThrough = 9.0;    ///< through its surface into the region behind
// From here on the photon waits for the scalar code.
inline constexpr double kFirstWaiting = 16.0;
inline constexpr double kBulk = 16.0;      ///< an event in the medium; the photon is where its segment began
inline constexpr double kBoundary = 17.0;  ///< at a boundary whose surface is not one for lanes
inline constexpr double kUnclear = 18.0;   ///< the next face is not known to lanes; as for kBulk
inline constexpr double kCrossed = 19.0;   ///< through its surface into a region that is not in lanes
inline constexpr double kAbsorbed = 20.0;  ///< by the surface
inline constexpr double kCut = 21.0;       ///< the limits are reached
// As places in LanePool::in_state: those in which photons are between passes, and those that wait.
inline constexpr std::size_t kFirstStage = 1, kEndOfStages = 8, kFirstOfWaiting = 16, kCount = 22;
}  // namespace lane_state

/// One or two parallel planes around a region, in the region's frame (mm). Number 2 i and 2 i + 1 of its
/// planes: the first one's normal is `normal`, the second one's the opposite.
struct PlanePair {
  double normal[3];  ///< of unit length, out of the region
  double first_mm;   ///< product of `normal` and a point of the first plane
  double second_mm;  ///< product of the opposite and a point of the second plane; infinite: none
  double padding[3] = {0, 0, 0};
};
static_assert(sizeof(PlanePair) == 64);

/// A box along the axes of its frame, as scene::Boundary::is_box: of the faces across x, y and z with the
/// normal along the axis, and of those opposite, the product of the normal and a point (mm). Four numbers are
/// loaded at once.
struct alignas(32) LaneBoxPlaces {
  double first_mm[4], second_mm[4];
  double per_length[4];  ///< 1 / distance of the two, 1/mm
};

/// A surface table between two of its wavelengths.
struct LaneTable {
  /// Of a slice, for light from the photon's region and from beyond, and of the next.
  optics::TableView view[4];
};

/// The surface at a face and what is behind it, for one wavelength. Four numbers are loaded at once.
struct alignas(32) LaneFaceOptics {
  double index_behind;  ///< of the medium behind the microsurface
  double least_sin2;    ///< of a smooth surface: sine squared from which light is totally reflected
  double counted;       ///< 1 when reaching it counts as an interaction
  double reflector;     ///< 1: behind the microsurface is a reflector; 0: the next region

  union {
    double sigma_rad;  ///< of facets
    double to_next;    ///< of a table: probability of its next slice; negative: there is one
  };
  double widest_rad;              ///< facets beyond this angle are drawn again
  double sin_widest, cos_widest;  ///< of facets weighted by area: greatest_facing() needs them

  double by_area;         ///< 1: facets are weighted by projected area
  double reflectance;     ///< of the reflector
  double specular_share;  ///< of the reflector
  const LaneTable* table = nullptr;
};
static_assert(sizeof(LaneFaceOptics) == 96);

/// A medium at one wavelength. The four numbers are loaded at once.
struct alignas(32) LaneMedium {
  double index, group_index;
  double attenuation_per_mm;  ///< absorption and scattering together
  double padding = 0.0;
};

/// All that depends on the wavelength: records of four numbers, those of media and after them those of faces,
/// found by their places in this list.
struct alignas(32) LaneRecord {
  double of[4];
};
static_assert(sizeof(LaneMedium) == sizeof(LaneRecord) && sizeof(LaneFaceOptics) == 3 * sizeof(LaneRecord));

/// A gap, as scene::ThinGap, in the region's frame (mm). Four numbers are loaded at once.
struct alignas(32) LaneGap {
  double normal[3], offset_mm;  ///< of the face beyond
  double x[3], low_x;
  double y[3], low_y;
  double high_x, high_y, beyond;  ///< number of the face beyond
  double padding = 0.0;
};

struct LaneRegion;

/// A flat face of a region. Four numbers are loaded at once.
struct alignas(64) LaneFace {
  double normal[3];  ///< of unit length, out of the region
  double kind;       ///< kSmooth, kFacets, kTable, kReflector; kBoundary, kUnclear: for the scalar code

  LaneFaceOptics at_one;  ///< in a scene of one wavelength

  double behind_centre[3];  ///< LaneRegion::centre of the region behind
  double behind_face;       ///< number of this face there

  const LaneRegion* behind = nullptr;  ///< null: light that crosses the face leaves the lanes
  const LaneGap* gap = nullptr;        ///< the first in front of the face; one without a point: there is none
  std::size_t optics = 0;  ///< in another scene: place of its LaneFaceOptics in LanePhoton::optics
};
static_assert(sizeof(LaneFace) == 192);

/// A region: bounded by planes, or one in which photons cross gaps.
struct LaneRegion {
  const PlanePair* planes = nullptr;   ///< where photons cross gaps any
  const LaneBoxPlaces* box = nullptr;  ///< the same, where they are a box
  const LaneFace* faces = nullptr;     ///< two per PlanePair; where photons cross gaps those at gaps
  std::uint32_t count = 0;             ///< of planes
  std::uint32_t has_gaps = 0;          ///< 1: photons cross gaps
  std::uint32_t number = 0;            ///< scene::Scene::regions
  std::uint32_t medium = 0;            ///< place of its LaneMedium in LanePhoton::optics
  std::uint32_t unfolds = 0;           ///< 1: as scene::Region::unfolds
  std::uint32_t mirrors = 0;  ///< where it unfolds: place of two records there, of LaneFaceOptics::least_sin2
                              ///< of the six faces in turn
};

/// A photon of the pool. Rows of four numbers are loaded and stored at once.
struct alignas(64) LanePhoton {
  double position[3], path_mm;
  double direction[3], time_ns;
  double polarisation[3], depth_left;
  double interactions, segments;  ///< whole numbers; segments since the photon was entered
  double plane;                   ///< number of the face that was last reached
  double cos_before;              ///< |cosine| to the normal of the plane, on arrival
  double centre[3];               ///< origin of the region's frame
  double attenuation_per_mm;      ///< of the region's medium, as the indices
  double index, group_index, padding[2];
  double side;              ///< at a microsurface: 1 in the photon's region, -1 beyond
  double next;              ///< state after kPolarise
  std::uint64_t stream[2];  ///< of random numbers: core::Rng::State
  const LaneRecord* optics;
  LaneRegion region;
};

/// The photons, and those in each state.
struct LanePool {
  static constexpr std::size_t kPhotons = 48;
  static_assert(kPhotons < 64, "a photon is a bit");

  LanePhoton photons[kPhotons + 1];            ///< the last one stands for none, in lanes that have no photon
  std::uint64_t in_state[lane_state::kCount];  ///< a bit for each photon

  double most_interactions, most_time_ns;  ///< limits as of PropagationLimits
  bool boxes;                              ///< all regions bounded by planes are as scene::Boundary::is_box
  bool one_box;                            ///< and all alike
  bool unfolds;                            ///< some region does
  bool has_gaps;                           ///< some region has
  bool has_neighbours;                     ///< some face has a region behind it
  bool one_wavelength;                     ///< all photons have it
};

/// Moves the photons of the pool until some wait for the scalar code, exactly as step() moves them one by
/// one. At least one photon is neither empty nor waiting.
using RunLanes = void (*)(LanePool& pool);

// One for each width that this build has; defined where its instruction set is compiled.
void run_lanes_4(LanePool&);
void run_lanes_8(LanePool&);

}  // namespace scintray::transport
