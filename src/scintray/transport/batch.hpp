#pragma once
/// Photons traced together, several at once in lanes where the regions allow it.

#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/core/function_ref.hpp"
#include "scintray/transport/detail/lane_faces.hpp"
#include "scintray/transport/detail/surface_lanes.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::transport {

/// Which kernel traces photons in a region.
enum class LaneKind {
  none,      ///< photons are traced one by one
  smooth,    ///< they are propagated in lanes, through total reflections (lane_kernel.hpp)
  surfaces,  ///< they stay in lanes at rough faces and reflectors too (lane_pool.hpp)
};

/// The fastest for a region at a width of lane_widths(). No result depends on it.
LaneKind lane_kind(const scene::Scene& scene, core::RegionId region, int lane_width);

/// Of all regions of a scene.
using LaneKinds = core::IdVector<core::RegionId, LaneKind>;
LaneKinds lane_kinds(const scene::Scene& scene, int lane_width);

/// The end of a photon.
struct TracedPhoton {
  source::Photon photon;          ///< as it ended
  Step last;                      ///< its last step, unless it was cut
  std::optional<core::Fate> cut;  ///< the fate by a limit that ended it; none: last.event is its fate
};

/// Counts of all steps of a batch but the photons' last ones.
struct BatchCounts {
  std::uint64_t segments = 0;
  std::uint64_t resolved = 0;  ///< ray queries resolved by the exact query
};

/// Traces photons that need no record of their steps: the same photons, to the last bit, as step() does one
/// by one, for any width of the lanes. Photons in smooth regions that are bounded by planes, or by a convex
/// body of planes and quadrics, are propagated in lanes (lane_kernel.hpp); in those with rough faces and
/// reflectors they stay in lanes through what happens at their surfaces (lane_pool.hpp); everything else is
/// done for each alone.
class Batch {
 public:
  /// @param limits      without `passed`
  /// @param lane_width  of lane_widths(). @throws InternalError for another
  /// @param kinds       the scene's, at that width
  Batch(const scene::Scene& scene, const PropagationLimits& limits, int lane_width, const LaneKinds& kinds);

  /// The state in which photon number i starts, and its random stream.
  using Emit = core::FunctionRef<source::Photon(std::uint64_t i, core::Rng& rng)>;
  /// The stream of photon number i.
  using Stream = core::FunctionRef<core::Rng(std::uint64_t i)>;

  /// Traces photons 0 to count - 1. @return their ends, by number; valid until the next call
  const std::vector<TracedPhoton>& trace(std::uint64_t count, Stream stream, Emit emit);
  const BatchCounts& counts() const { return counts_; }

 private:
  /// A photon on its way.
  struct Traveller {
    source::Photon photon;
    core::Rng rng{0, core::StreamKind::photon, 0};
    std::uint64_t number = 0;
    std::uint32_t segments = 0;  ///< of the present step so far
    core::RegionId angles_of;    ///< region and wavelength of its least_sin2_; none: not set
    double angles_nm = 0.0;
  };
  /// A photon to be propagated in lanes.
  struct Waiting {
    core::AcceleratorId accelerator;
    std::uint32_t traveller = 0;
  };

  void enqueue(std::uint32_t traveller);
  void trace_in_surface_lanes();
  void trace_alone(std::uint32_t traveller);
  void trace_in_lanes();
  void propagate(const Waiting* first, const Waiting* last);
  /// All of `work` but the results, in its place: copies of what was just written wait for it.
  void set_work(std::uint32_t traveller, const LaneFaces& faces, LaneWork& work);
  void set_critical_angles(Traveller& traveller, const LaneFaces& faces, double* least_sin2) const;
  void finish(const LaneWork& work, const LaneFaces& faces, std::uint32_t traveller);
  /// True when the photon goes on after the step; else its end is noted, and the next photon takes its place.
  bool goes_on(Traveller& traveller, const Step& taken);
  void replace(std::uint32_t traveller);

  const scene::Scene& scene_;
  PropagationLimits limits_;
  const LaneKinds& kinds_;
  PropagateLanes propagate_;  ///< null: no lanes
  PropagateLanesInBody propagate_in_body_;
  SurfaceLanes surface_lanes_;
  core::IdVector<core::AcceleratorId, LaneFaces> faces_;  ///< of those of LaneKind::smooth
  std::size_t most_faces_ = 0;
  std::vector<Traveller> travellers_;
  std::vector<double> least_sin2_;  ///< per traveller and face: critical angles, most_faces_ each
  std::vector<std::uint32_t> alone_, for_surface_lanes_;
  std::vector<Waiting> waiting_, in_lanes_;
  std::vector<LaneWork> work_;
  std::vector<TracedPhoton> traced_;
  BatchCounts counts_;
  std::uint64_t next_ = 0;  ///< number of the next photon to start
  Stream stream_;
  Emit emit_;
};

}  // namespace scintray::transport
