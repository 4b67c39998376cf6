#include "scintray/simulation/run_point.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "scintray/core/in_order.hpp"
#include "scintray/simulation/detail/block_pieces.hpp"
#include "scintray/simulation/detail/block_tracer.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::simulation {

namespace {

/// True when light may be re-emitted at another wavelength.
bool shifts_light(const scene::Scene& scene) {
  return std::any_of(scene.optics.media.begin(), scene.optics.media.end(),
                     [](const scene::MediumRecord& medium) { return medium.shifts; }) ||
         std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                     [](const optics::Surface& surface) { return surface.shifts(); });
}

void check_every_photon_has_a_fate(const tally::PointResult& traced, std::uint64_t started) {
  std::uint64_t ended = 0;
  for (const std::uint64_t count : traced.fates) ended += count;
  if (ended != started)
    throw core::InternalError(std::to_string(started - ended) + " of " + std::to_string(started) +
                              " photons have no fate");
}

/// Collects blocks in their order into ranges. Of an event source a block is an event.
class RangeCollector {
 public:
  /// @param empty  returns sums over no blocks
  RangeCollector(std::function<tally::PointSums()> empty, std::uint64_t first, const RunHooks& hooks)
      : empty_(std::move(empty)), present_{first, first}, hooks_(hooks) {}

  void add(const TracedBlock& block) {
    if (present_.count() == 0) sums_ = empty_();
    block.photons.add_to(sums_, !block.events.events().empty());
    block.events.add_to(sums_.energy);
    sums_.counts.emitted += block.emitted + block.additional;
    traced_ += block.traced + block.additional;
    ++present_.last;
    if (hooks_.detected && !block.photons.photons().empty()) hooks_.detected(block.photons.photons());
    if (hooks_.histories && block.photons.histories()) hooks_.histories(*block.photons.histories());
    if (hooks_.events && !block.events.events().empty()) hooks_.events(block.events.events());
    if (hooks_.range_ends && hooks_.range_ends(present_)) end_range();
  }

  /// Ends the present range, unless it is empty.
  void end_range() {
    if (present_.count() == 0) return;
    check_every_photon_has_a_fate(sums_.counts, traced_);
    const auto now = std::chrono::steady_clock::now();
    sums_.counts.wall_seconds = std::chrono::duration<double>(now - start_).count();
    if (hooks_.range) hooks_.range(present_, std::move(sums_));
    present_.first = present_.last;
    traced_ = 0;
    start_ = now;
  }

 private:
  std::function<tally::PointSums()> empty_;
  tally::PointSums sums_;  ///< over the present range
  tally::BlockRange present_;
  std::uint64_t traced_ = 0;  ///< photons of the present range
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const RunHooks& hooks_;
};

}  // namespace

bool multiplies_light(const scene::Scene& scene) {
  return std::any_of(scene.media.begin(), scene.media.end(), [](const scene::SceneMedium& medium) {
    return medium.medium().shifter && medium.medium().shifter->multiplies();
  });
}

double efficiency_bound(const scene::Scene& scene) {
  if (multiplies_light(scene)) return 1.0;
  double bound = 0.0;
  for (const detector::Sensor& sensor : scene.sensors)
    bound = std::max(bound, sensor.conversion_bound(scene.low_nm, scene.high_nm));
  return bound > 0.0 ? bound : 1.0;
}

core::Rng photon_stream(const RunSettings& settings, std::uint64_t event, std::uint64_t photon) {
  return PhotonStreams(settings).stream(event, photon);
}

core::Rng event_stream(const RunSettings& settings, std::uint64_t event) {
  return core::Rng(settings.seed, core::StreamKind::event, event, 0, settings.point);
}

core::Rng sensor_stream(const RunSettings& settings, std::uint64_t event, std::uint32_t channel) {
  return core::Rng(settings.seed, core::StreamKind::sensor, event, channel, settings.point);
}

std::unique_ptr<const transport::LanePlan> lane_plan_of(const scene::Scene& scene,
                                                        const source::LightSource& source,
                                                        const tally::TallyPlan& plan,
                                                        const RunSettings& settings) {
  const bool ends_only = plan.counts.empty() && !plan.history && !shifts_light(scene);
  if (ends_only && settings.lane_width > 1) {
    // Where light starts in none of the lanes' regions each photon is traced alone, which is then faster.
    transport::LaneKinds kinds = transport::lane_kinds(scene, settings.lane_width);
    const std::vector<core::RegionId> regions = source.regions();
    if (std::any_of(regions.begin(), regions.end(),
                    [&](core::RegionId region) { return kinds[region] != transport::LaneKind::none; }))
      return std::make_unique<const transport::LanePlan>(scene, settings.lane_width, std::move(kinds));
  }
  return std::make_unique<const transport::LanePlan>(scene, 1);
}

tally::BlockRange trace_blocks(const TracedPoint& point, const RunSettings& settings,
                               tally::BlockRange blocks, const RunHooks& hooks) {
  const BlockTracer tracer(point, settings);
  RangeCollector collector([&] { return tally::empty_sums(point.scene, point.plan); }, blocks.first, hooks);
  const bool energy = point.source.has_energy();
  std::uint64_t done = 0, kept = 0;
  bool is_enough = false;
  std::atomic<bool> ended{false};  // by a stop or because it is enough, where hooks decide that
  const BlockPieces pieces = tracer.pieces(blocks, hooks.enough != nullptr);
  const auto trace = [&](std::uint64_t piece) {
    if (hooks.enough && hooks.stop && hooks.stop->load()) ended = true;
    return tracer.trace(pieces.at(piece));
  };
  const auto collect = [&](std::uint64_t, const std::vector<TracedBlock>& traced) {
    for (const TracedBlock& block : traced) {
      if (is_enough) return;
      done += energy ? block.events.events().size() : block.emitted;
      ++kept;
      collector.add(block);
      if (hooks.progress) hooks.progress(done);
      if (!hooks.enough || !hooks.enough()) continue;
      is_enough = true;
      ended = true;
    }
  };
  core::work_in_order(pieces.count(), settings.threads, hooks.enough ? &ended : hooks.stop, trace, collect);
  collector.end_range();
  return {blocks.first, blocks.first + kept};
}

tally::PointResult run_point(const TracedPoint& point, const RunSettings& settings, const RunHooks& hooks) {
  const source::LightSource& source = point.source;
  const bool energy = source.has_energy();
  tally::PointSums sums = tally::empty_sums(point.scene, point.plan);
  RunHooks collecting = hooks;
  collecting.range = [&](const tally::BlockRange& range, tally::PointSums more) {
    sums.merge(more);
    if (hooks.range) hooks.range(range, std::move(more));
  };
  const tally::BlockRange all{0, source.blocks()};
  const tally::BlockRange traced = trace_blocks(point, settings, all, collecting);
  tally::PointResult total = sums.result();
  total.birth_efficiency = settings.birth_efficiency;
  total.complete = traced == all;
  total.photons_requested = energy ? total.emitted : source.photons();
  total.energy.events_requested = energy ? source.events() : 0;
  return total;
}

namespace {

/// A photon of an event as it starts.
/// @param rng  becomes its random stream
source::Photon emitted(const scene::Scene& scene, const source::LightSource& source,
                       const RunSettings& settings, const PhotonNumber& number, core::Rng& rng) {
  const auto [event, photon] = number;
  source::EventLight light;
  if (event < source.events()) {
    core::Rng event_rng = event_stream(settings, event);
    source.begin(scene, event, event_rng, light);
  }
  if (photon >= light.photons)
    throw core::InputError(core::Problem{
        {},
        "there is no photon " + std::to_string(photon) + " of event " + std::to_string(event) + ": " +
            (event < source.events() ? "that event has " + std::to_string(light.photons) + " photons"
                                     : "there are " + std::to_string(source.events()) + " events"),
        "both count from 0"});
  rng = photon_stream(settings, event, photon);
  source::Photon start = source.emit(scene, light, photon, rng);
  start.conversion_draw = PhotonStreams(settings).conversion_draw(event, photon);
  return start;
}

}  // namespace

source::Photon start_of_photon(const scene::Scene& scene, const source::LightSource& source,
                               const RunSettings& settings, const PhotonNumber& number) {
  core::Rng rng = photon_stream(settings, number.event, number.photon);
  return emitted(scene, source, settings, number, rng);
}

source::Photon replay(const scene::Scene& scene, const source::LightSource& source,
                      const RunSettings& settings, const PhotonNumber& number, transport::StepVisitor visit) {
  core::Rng rng = photon_stream(settings, number.event, number.photon);
  source::Photon photon = emitted(scene, source, settings, number, rng);
  transport::PropagationLimits limits = limits_of(settings);
  limits.passed = visit;
  for (;;) {
    const transport::Step taken = transport::step(scene, photon, rng, limits);
    visit(photon, taken);
    if (core::is_final(taken.event) || limits.reached(photon)) return photon;
  }
}

}  // namespace scintray::simulation
