#include "scintray/trace/run.hpp"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "scintray/trace/step.hpp"

namespace scintray {

namespace {

/// Photons traced as one piece of work; part of what makes results reproducible.
constexpr std::uint64_t kBlockPhotons = 1024;
/// Blocks in flight for each thread.
constexpr std::size_t kBlocksPerThread = 4;

std::optional<Fate> limit_reached(const Photon& photon, const RunSettings& settings) {
  if (photon.interactions >= settings.max_interactions) return Fate::cut_interactions;
  if (settings.max_time_ns && photon.time_ns > *settings.max_time_ns) return Fate::cut_time;
  return std::nullopt;
}

void trace_photon(const Scene& scene, const PhotonSource& source, const RunSettings& settings,
                  std::uint64_t event, std::uint64_t number, BlockTally& tally) {
  Rng rng = photon_stream(settings, event, number);
  Photon photon = source.emit(scene, rng);
  tally.start(photon, event, number);
  for (;;) {
    const Step taken = step(scene, photon, rng);
    if (is_end(taken.kind)) return tally.end(photon, taken, settings.point);
    tally.record(photon, taken);
    if (const auto fate = limit_reached(photon, settings)) return tally.cut(photon, *fate);
  }
}

std::unique_ptr<BlockTally> trace_block(const Scene& scene, const PhotonSource& source, const TallyPlan& plan,
                                        const RunSettings& settings, std::uint64_t block) {
  auto tally = std::make_unique<BlockTally>(scene, plan);
  const std::uint64_t first = block * kBlockPhotons;
  const std::uint64_t last = std::min(source.photons(), first + kBlockPhotons);
  for (std::uint64_t i = first; i < last; ++i)
    trace_photon(scene, source, settings, i / source.photons_per_event(), i % source.photons_per_event(),
                 *tally);
  return tally;
}

void check_every_photon_has_a_fate(PointResult& result, std::uint64_t traced) {
  std::uint64_t ended = 0;
  for (const std::uint64_t count : result.fates) ended += count;
  result.lost = traced - ended;
  if (result.lost != 0)
    throw InternalError(std::to_string(result.lost) + " of " + std::to_string(traced) +
                        " photons have no fate");
}

}  // namespace

Rng photon_stream(const RunSettings& settings, std::uint64_t event, std::uint64_t photon) {
  return Rng(settings.seed, StreamKind::photon, event, photon, settings.point);
}

PointResult run_point(const Scene& scene, const PhotonSource& source, const TallyPlan& plan,
                      const RunSettings& settings, const RunHooks& hooks) {
  const auto start = std::chrono::steady_clock::now();
  PointResult total = empty_result(scene, plan);
  total.photons_requested = source.photons();
  const std::uint64_t blocks = (source.photons() + kBlockPhotons - 1) / kBlockPhotons;
  std::uint64_t next_block = 0, traced = 0;

  const auto give_block = [&](tbb::flow_control& control) -> std::uint64_t {
    if (next_block == blocks || (hooks.stop && hooks.stop->load())) {
      control.stop();
      return 0;
    }
    return next_block++;
  };
  const auto trace = [&](std::uint64_t block) {
    return std::shared_ptr<BlockTally>(trace_block(scene, source, plan, settings, block));
  };
  const auto collect = [&](const std::shared_ptr<BlockTally>& block) {
    block->add_to(total);
    traced = std::min(source.photons(), traced + kBlockPhotons);
    if (hooks.detected && !block->photons().empty()) hooks.detected(block->photons());
    if (hooks.progress) hooks.progress(traced);
  };

  tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    const std::size_t in_flight = kBlocksPerThread * static_cast<std::size_t>(arena.max_concurrency());
    tbb::parallel_pipeline(
        in_flight,
        tbb::make_filter<void, std::uint64_t>(tbb::filter_mode::serial_in_order, give_block) &
            tbb::make_filter<std::uint64_t, std::shared_ptr<BlockTally>>(tbb::filter_mode::parallel, trace) &
            tbb::make_filter<std::shared_ptr<BlockTally>, void>(tbb::filter_mode::serial_in_order, collect));
  });

  check_every_photon_has_a_fate(total, traced);
  total.complete = traced == source.photons();
  total.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return total;
}

Photon replay(const Scene& scene, const PhotonSource& source, const RunSettings& settings,
              std::uint64_t event, std::uint64_t number,
              const std::function<void(const Photon&, const Step&)>& visit) {
  Rng rng = photon_stream(settings, event, number);
  Photon photon = source.emit(scene, rng);
  for (;;) {
    const Step taken = step(scene, photon, rng);
    visit(photon, taken);
    if (is_end(taken.kind) || limit_reached(photon, settings)) return photon;
  }
}

}  // namespace scintray
