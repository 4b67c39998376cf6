#pragma once
/// Photons traced together, several at once in lanes where the regions allow it.

#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/core/function_ref.hpp"
#include "scintray/transport/detail/lane_scene.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::transport {

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
/// by one, for any width of the lanes. Photons inside regions that are bounded by planes stay in the lanes of
/// vector registers, with all that happens at surfaces for lanes; the rest is done for each alone.
class Batch {
 public:
  /// @param limits      without `passed`
  /// @param lane_width  of lane_widths(). @throws InternalError for another
  Batch(const scene::Scene& scene, const PropagationLimits& limits, int lane_width);

  /// The state in which photon number i starts, and its random stream.
  using Emit = core::FunctionRef<source::Photon(std::uint64_t i, core::Rng& rng)>;
  /// The stream of photon number i.
  using Stream = core::FunctionRef<core::Rng(std::uint64_t i)>;

  /// Traces photons 0 to count - 1. @return their ends, by number; valid until the next call
  const std::vector<TracedPhoton>& trace(std::uint64_t count, Stream stream, Emit emit);
  const BatchCounts& counts() const { return counts_; }

 private:
  /// A photon on its way; in lanes, as it entered them.
  struct Traveller {
    source::Photon photon;
    core::Rng rng{0, core::StreamKind::photon, 0};
    std::uint64_t number = 0;
    bool has_numbers = false;  ///< numbers of its stream are in the pool
  };

  bool some_in_lanes() const;
  void start_next(std::size_t index);
  bool follow(std::size_t index);
  void go_on_after_lanes(std::size_t index);
  Step finish_step(double waiting_as, std::size_t index);
  void enter_lanes(std::size_t index);
  void leave_lanes(std::size_t index);
  void give_numbers(std::size_t index);
  void take_numbers(std::size_t index);
  bool goes_on(const Traveller& traveller, const Step& taken);

  const scene::Scene& scene_;
  PropagationLimits limits_;
  RunLanes run_lanes_;  ///< null: no lanes
  LaneScene lane_scene_;
  LanePool pool_;
  std::vector<Traveller> travellers_;  ///< by their index in the pool
  std::vector<TracedPhoton> traced_;
  BatchCounts counts_;
  std::uint64_t next_ = 0;  ///< number of the next photon to start
  Stream stream_;
  Emit emit_;
};

}  // namespace scintray::transport
