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
inline constexpr double kSmooth = 2.0;     ///< Fresnel's equations at the mean normal
inline constexpr double kFacets = 3.0;     ///< a facet is drawn, then Fresnel's equations
inline constexpr double kTable = 4.0;      ///< a surface table
inline constexpr double kReflector = 5.0;  ///< the reflector behind the microsurface
inline constexpr double kPolarise = 6.0;   ///< a polarisation is drawn; LanePool::next follows
inline constexpr double kReflected = 7.0;  ///< back in its region; kPropagate follows at once
// From here on the photon waits for the scalar code.
inline constexpr double kFirstWaiting = 16.0;
inline constexpr double kBulk = 16.0;      ///< an event in the medium; the photon is where its segment began
inline constexpr double kBoundary = 17.0;  ///< at a boundary whose surface is not one for lanes
inline constexpr double kUnclear = 18.0;   ///< the next plane leads to several regions; as for kBulk
inline constexpr double kCrossed = 19.0;   ///< through its surface into the region behind
inline constexpr double kAbsorbed = 20.0;  ///< by the surface
inline constexpr double kCut = 21.0;       ///< the limits are reached
// As places in LanePool::in_state: those in which photons are between passes, and those that wait.
inline constexpr std::size_t kFirstStage = 1, kEndOfStages = 7, kFirstOfWaiting = 16, kCount = 22;
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

/// A surface table between two of its wavelengths.
struct LaneTable {
  optics::TableView view[2]
                        [2];  ///< of a slice and the next, for light from the photon's region and from beyond
  bool absorbs = false;
};

/// A plane around a region, with the surface there, for one wavelength. Four numbers are loaded at once.
struct LaneFace {
  double normal[3];  ///< of unit length, out of the region
  double kind;       ///< kSmooth, kFacets, kTable, kReflector; kBoundary, kUnclear: for the scalar code

  double index_behind;  ///< of the medium behind the microsurface
  double least_sin2;    ///< of a smooth surface: sine squared from which light is totally reflected
  double counted;       ///< 1 when reaching it counts as an interaction
  double reflector;     ///< 1: behind the microsurface is a reflector; 0: the next region

  union {
    double sigma_rad;  ///< of facets
    double to_next;  ///< of a table: probability of its next slice; negative: there is one, and none is drawn
  };
  double widest_rad;              ///< facets beyond this angle are drawn again
  double sin_widest, cos_widest;  ///< of facets weighted by area: greatest_facing() needs them

  double by_area;         ///< 1: facets are weighted by projected area
  double reflectance;     ///< of the reflector
  double specular_share;  ///< of the reflector
  const LaneTable* table = nullptr;
};
static_assert(sizeof(LaneFace) == 128);

/// Planes and faces of the region of a photon.
struct LaneRegion {
  const PlanePair* planes = nullptr;
  const LaneFace* faces = nullptr;  ///< two per PlanePair
  std::size_t count = 0;            ///< of planes
};

/// A photon of the pool. Rows of four numbers are loaded and stored at once.
struct alignas(64) LanePhoton {
  /// Random numbers that are not used yet, in whole blocks of four. The first four are repeated after the
  /// last, so that any four consecutive ones can be loaded.
  static constexpr std::size_t kNumbers = 16;

  double position[3], path_mm;
  double direction[3], time_ns;
  double polarisation[3], depth_left;
  double interactions, segments;  ///< whole numbers; segments since the photon was entered
  double plane;                   ///< the last one reached
  double cos_before;              ///< |cosine| to the normal of the plane, on arrival
  double centre[3];               ///< origin of the region's frame
  double attenuation_per_mm;      ///< of the region, as the indices
  double index, group_index;
  double side;                       ///< at a microsurface: 1 in the photon's region, -1 beyond
  double next;                       ///< state after kPolarise
  std::uint64_t drawn, next_block;   ///< numbers used, and Philox's first counter: the next block to be drawn
  std::uint64_t key[2], counter[3];  ///< Philox's key, and its other counters
  std::uint64_t padding;
  std::uint64_t numbers[kNumbers + 4];
  LaneRegion region;
};

/// The photons, and those in each state.
struct LanePool {
  static constexpr std::size_t kPhotons = 48;
  static_assert(kPhotons < 64, "a photon is a bit");

  LanePhoton photons[kPhotons + 1];            ///< the last one stands for none, in lanes that have no photon
  std::uint64_t in_state[lane_state::kCount];  ///< a bit for each photon

  double most_interactions, most_time_ns;  ///< limits as of PropagationLimits
};

/// Moves the photons of the pool until some wait for the scalar code, exactly as step() moves them one by
/// one. At least one photon is neither empty nor waiting.
using RunLanes = void (*)(LanePool& pool);

// One for each width that this build has; defined where its instruction set is compiled.
void run_lanes_4(LanePool&);
void run_lanes_8(LanePool&);

}  // namespace scintray::transport
