#pragma once
/// The blocks of a run's photons, traced one photon after another or together in lanes.

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "scintray/simulation/detail/block_pieces.hpp"
#include "scintray/simulation/run_point.hpp"
#include "scintray/tally/block_tally.hpp"
#include "scintray/tally/event_tally.hpp"
#include "scintray/transport/batch.hpp"

namespace scintray::simulation {

/// Result of one block.
struct TracedBlock {
  TracedBlock(const scene::Scene& scene, const tally::TallyPlan& plan)
      : photons(scene, plan), events(scene, plan) {}
  tally::BlockTally photons;
  tally::EventTally events;
  std::uint64_t emitted = 0;     ///< photons
  std::uint64_t traced = 0;      ///< of them, those that were traced
  std::uint64_t additional = 0;  ///< re-emitted beyond one photon for each absorbed; all are traced
};

/// Batches that no thread is using. What a batch has made of the scene serves the next blocks.
class FreeBatches {
 public:
  /// Null when there is none.
  std::unique_ptr<transport::Batch> take();
  void put(std::unique_ptr<transport::Batch> batch);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<transport::Batch>> free_;
};

/// Traces the blocks of one point, on any thread.
class BlockTracer {
 public:
  /// The arguments have to outlive the tracer.
  BlockTracer(const TracedPoint& point, const RunSettings& settings);

  /// Pieces of work that these blocks are best traced in.
  /// @param may_have_enough  the run may end before the last block
  BlockPieces pieces(const tally::BlockRange& blocks, bool may_have_enough) const;

  /// Traces successive blocks.
  std::vector<TracedBlock> trace(const tally::BlockRange& numbers) const;

 private:
  /// A photon of a block.
  struct Address {
    std::uint64_t event = 0, photon = 0;
    double conversion_draw = 0.0;
    std::size_t block = 0;  ///< of those traced together
  };

  /// Traces the photons of a block one after another, with all that is recorded of them on their way.
  void trace_alone(std::uint64_t number, TracedBlock& block) const;
  void end_event(std::uint64_t event, TracedBlock& block) const;
  /// Traces photons of which only the ends are recorded. One event of energy is traced after another.
  void trace_together(std::uint64_t first, std::vector<TracedBlock>& blocks) const;
  /// Traces the photons, and removes them from the list.
  /// @param light  of their event; for a source of photons of any event
  void trace_photons(std::vector<Address>& photons, const source::EventLight& light, transport::Batch& batch,
                     std::vector<TracedBlock>& blocks) const;
  /// Traces a photon, then those that wavelength shifters re-emitted in addition to it, with its stream.
  void trace_photon(const source::EventLight& light, const Address& address,
                    const transport::PropagationLimits& limits, TracedBlock& block) const;
  /// Traces one photon to its end.
  void follow(source::Photon& photon, const Address& address, core::Rng& rng,
              const transport::PropagationLimits& limits, TracedBlock& block) const;

  const scene::Scene& scene_;
  const source::LightSource& source_;
  const tally::TallyPlan& plan_;
  const RunSettings& settings_;
  bool energy_;
  const transport::LanePlan& lanes_;
  mutable FreeBatches batches_;
};

}  // namespace scintray::simulation
