#pragma once
/// Photons traced together, several at once in lanes where the regions allow it.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scintray/core/function_ref.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::transport {

class LaneScene;

/// The kernels that trace photons in each region of a scene at a width of lane_widths(): those of
/// scene::Region::lanes, where the width has them. No result depends on them.
using scene::LaneKind;
using LaneKinds = core::IdVector<core::RegionId, LaneKind>;
/// @throws InternalError for another width
LaneKinds lane_kinds(const scene::Scene& scene, int lane_width);

/// A number of lanes, kernels for the regions of a scene, and what they need of the scene. Serves any number
/// of threads.
class LanePlan {
 public:
  /// @param lane_width  of lane_widths(). @throws InternalError for another
  /// @param kinds       of the scene at that width
  LanePlan(const scene::Scene& scene, int lane_width, LaneKinds kinds);
  /// With the fastest kernels.
  LanePlan(const scene::Scene& scene, int lane_width)
      : LanePlan(scene, lane_width, lane_kinds(scene, lane_width)) {}
  ~LanePlan();

  int width() const { return width_; }
  LaneKind kind(core::RegionId region) const { return kinds_[region]; }
  /// The regions of LaneKind::surfaces.
  const LaneScene& scene() const { return *scene_; }

 private:
  int width_;
  LaneKinds kinds_;
  std::unique_ptr<const LaneScene> scene_;
};

/// The end of a photon.
struct TracedPhoton {
  source::Photon photon;              ///< its final state
  Step last;                          ///< its last step, unless it was cut
  std::optional<core::Fate> cut;      ///< the fate by a limit that ended it; none: last.event is its fate
  std::uint64_t segments_before = 0;  ///< of all steps but the last
  std::uint64_t resolved_before = 0;  ///< ray queries of those steps that the exact query resolved
};

/// Photons propagated through smooth regions in lanes, and the groups in which they were: those in regions of
/// one shape at a time.
struct BatchCounts {
  std::uint64_t grouped = 0, groups = 0;
};

/// Traces photons without a record of their steps, bit-identically to step() one by one, for any width of the
/// lanes. Photons in smooth regions that are bounded by planes, or by a convex
/// body of planes and quadrics, are propagated in lanes (lane_kernel.hpp); in those with rough faces and
/// reflectors they stay in lanes through interactions at their surfaces (lane_pool.hpp); everything else is
/// done for each photon separately.
class Batch {
 public:
  /// @param limits  without `passed`
  /// @param lanes   of the scene; has to outlive the batch
  Batch(const scene::Scene& scene, const PropagationLimits& limits, const LanePlan& lanes);
  ~Batch();

  /// Sets the states in which photons start, and their random streams: those with successive numbers from
  /// `first`, at most kTogether.
  using Emit = core::FunctionRef<void(std::uint64_t first, std::span<source::EmittedPhoton* const> photons)>;
  static constexpr std::size_t kTogether = 8;

  /// Receives the end of photon number i.
  using End = core::FunctionRef<void(std::uint64_t i, const TracedPhoton& end)>;

  /// Traces photons 0 to count - 1. Their ends are handed over in the order of their numbers, as soon as
  /// those of all before are known. The lanes are full until the last photons are under way: the more
  /// photons, the better.
  void trace(std::uint64_t count, Emit emit, End end);
  /// Of the last call.
  const BatchCounts& counts() const;

 private:
  class EndsInOrder;
  class Tracing;
  std::unique_ptr<Tracing> tracing_;
};

}  // namespace scintray::transport
