#pragma once
/// Tracing of a point: photons in fixed blocks over threads.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "scintray/core/lane_width.hpp"
#include "scintray/source/light_source.hpp"
#include "scintray/tally/block_tally.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/transport/batch.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::simulation {

class MappedResponse;

struct RunSettings {
  std::uint64_t seed = 1;
  std::uint32_t point = 0;                      ///< sweep point: each has its own random streams
  std::uint64_t max_interactions = 100'000;     ///< boundary interactions after which a photon is cut
  std::optional<double> max_time_ns;            ///< time after which a photon is cut
  int threads = 0;                              ///< 0: all cores
  int lane_width = core::default_lane_width();  ///< of core::lane_widths(); no result depends on it
  /// Photons whose conversion draw is not below this are not traced: no sensor would convert them. The
  /// detected photons are the same for any value that no efficiency exceeds.
  double birth_efficiency = 1.0;
};

/// Callbacks during a run. Any may be empty. All are called from one thread at a time.
struct RunHooks {
  /// Photons traced so far, or events of an event source.
  std::function<void(std::uint64_t done)> progress;
  std::function<void(const std::vector<tally::DetectedPhoton>&)> detected;  ///< in the order of photons
  std::function<void(const tally::PhotonHistories&)> histories;        ///< of the detected, in the same order
  std::function<void(const std::vector<tally::EventRecord>&)> events;  ///< of an event source, in order
  /// Called after each block with the present range of blocks; true ends it.
  std::function<bool(const tally::BlockRange& present)> range_ends;
  /// Sums over a range, after all else of its blocks. The ranges of a run follow each other without a gap.
  std::function<void(const tally::BlockRange& range, tally::PointSums sums)> range;
  /// Called after each block, and after range(): true ends the run there. Blocks traced beyond it are
  /// dropped.
  std::function<bool()> enough;
  const std::atomic<bool>* stop = nullptr;  ///< set from outside: finish the current blocks and return
};

/// The random stream of one photon of a run.
core::Rng photon_stream(const RunSettings& settings, std::uint64_t event, std::uint64_t photon);
/// The random stream of an event before its first photon.
core::Rng event_stream(const RunSettings& settings, std::uint64_t event);

/// The random stream of the noise of a sensor and its electronics in an event.
core::Rng sensor_stream(const RunSettings& settings, std::uint64_t event, std::uint32_t channel);

/// True when a wavelength shifter of a medium may re-emit several photons for one.
bool multiplies_light(const scene::Scene& scene);

/// An upper bound of the efficiency of every sensor of a scene for its light; 1 where that is 0 or there is
/// no sensor, and where light multiplies: a photon that no sensor would convert may then be re-emitted as
/// one that is converted.
double efficiency_bound(const scene::Scene& scene);

/// The random numbers of a run's photons: quickest for one event after the other.
class PhotonStreams {
 public:
  explicit PhotonStreams(const RunSettings& settings)
      : seed_(settings.seed), point_(settings.point), of_event_(family(0)) {}
  core::Rng stream(std::uint64_t event, std::uint64_t photon) { return of(event).at(photon); }
  /// Uniform on [0, 1). It is known before the photon is traced, and no part of its stream.
  double conversion_draw(std::uint64_t event, std::uint64_t photon) {
    return core::uniform_of<double>(of(event).bits_at(photon));
  }

 private:
  core::StreamFamily family(std::uint64_t event) const {
    return {seed_, core::StreamKind::photon, event, point_};
  }
  const core::StreamFamily& of(std::uint64_t event) {
    if (event != event_) of_event_ = family(event_ = event);
    return of_event_;
  }

  std::uint64_t seed_, point_, event_ = 0;
  core::StreamFamily of_event_;
};

/// The limits of a run, at which photons are cut.
inline transport::PropagationLimits limits_of(const RunSettings& settings) {
  transport::PropagationLimits limits;
  limits.interactions = settings.max_interactions;
  if (settings.max_time_ns) limits.time_ns = *settings.max_time_ns;
  return limits;
}

/// How a run of this source traces several photons at once: settings.lane_width of them where light starts in
/// regions that gain by it and nothing is recorded of a photon but its end, else 1. No result depends on it.
std::unique_ptr<const transport::LanePlan> lane_plan_of(const scene::Scene& scene,
                                                        const source::LightSource& source,
                                                        const tally::TallyPlan& plan,
                                                        const RunSettings& settings);

/// A point as it is traced.
struct TracedPoint {
  const scene::Scene& scene;
  const source::LightSource& source;
  const tally::TallyPlan& plan;
  const transport::LanePlan& lanes;  ///< lane_plan_of() these
};

/// Traces some blocks of a source's photons: the ranges passed to hooks.range, from `blocks.first` on without
/// a gap. One range unless hooks.range_ends divides them; fewer blocks after a stop, or when they are enough.
/// @return the blocks traced
/// @throws InternalError when a photon has no fate
tally::BlockRange trace_blocks(const TracedPoint& point, const RunSettings& settings,
                               tally::BlockRange blocks, const RunHooks& hooks);

/// Result of all photons of a source. It does not depend on the number of threads, to the last
/// bit: every photon has its own random stream, blocks are passed on in order, and sums over them are exact.
/// A stopped run contains the photons of the blocks before the stop, with `complete = false`.
/// @throws InternalError when a photon has no fate.
tally::PointResult run_point(const TracedPoint& point, const RunSettings& settings,
                             const RunHooks& hooks = {});

/// Identifies a photon of a run: its event, and its index within the event.
struct PhotonNumber {
  std::uint64_t event = 0, photon = 0;
};

/// One photon as it starts. Throws InputError when there is no such photon.
source::Photon start_of_photon(const scene::Scene& scene, const source::LightSource& source,
                               const RunSettings& settings, const PhotonNumber& number);

/// Replays one photon; `visit` is called for every step, each total reflection included. Returns the photon
/// as it ended. A photon that the run did not trace is followed all the same: no sensor converts it.
/// Throws InputError when there is no such photon.
source::Photon replay(const scene::Scene& scene, const source::LightSource& source,
                      const RunSettings& settings, const PhotonNumber& number, transport::StepVisitor visit);

/// Events of an event source: the same deposits and numbers of photons, to the last bit, as run_point
/// produces with this seed. The number of them that each channel detects is multinomial with the map's
/// probabilities at each deposit; times are the sum of the decay time and a delay of the map. With a readout,
/// photons arrive anywhere on the sensor's face. The result does not depend on the number of threads.
///
/// @return a result with events and without photons, since none was traced
/// @param plan  of the same scene, without tallies
/// @throws InputError when energy is deposited in a scintillator that the map does not cover
tally::PointResult run_mapped(const scene::Scene& scene, const source::LightSource& source,
                              const tally::TallyPlan& plan, const MappedResponse& response,
                              const RunSettings& settings, const RunHooks& hooks = {});

}  // namespace scintray::simulation
