#include "scintray/simulation/run_point.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "scintray/core/in_order.hpp"
#include "scintray/tally/block_tally.hpp"
#include "scintray/tally/event_tally.hpp"
#include "scintray/transport/batch.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::simulation {

namespace {

/// Result of one block.
struct Block {
  Block(const scene::Scene& scene, const tally::TallyPlan& plan)
      : photons(scene, plan), events(scene, plan) {}
  tally::BlockTally photons;
  tally::EventTally events;
  std::uint64_t emitted = 0;     ///< photons
  std::uint64_t traced = 0;      ///< of them, those that were traced
  std::uint64_t additional = 0;  ///< re-emitted beyond one photon for each absorbed; all are traced
};

/// Photons of which the ends are held at once, so that an event of any energy takes bounded memory.
constexpr std::size_t kMostTogether = 8192;
/// Photons re-emitted in addition to one photon, above which the multiplication is taken as endless.
constexpr std::uint64_t kMostAdditional = 1'000'000;

/// True when light may be re-emitted at another wavelength.
bool shifts_light(const scene::Scene& scene) {
  return std::any_of(scene.optics.media.begin(), scene.optics.media.end(),
                     [](const scene::MediumRecord& medium) { return medium.shifts; }) ||
         std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                     [](const optics::Surface& surface) { return surface.shifts(); });
}

/// True when light starts where photons are propagated in lanes. Elsewhere each is traced alone, which is
/// then faster.
bool starts_in_lanes(const scene::Scene& scene, const source::LightSource& source, int lane_width) {
  const std::vector<core::RegionId> regions = source.regions();
  return std::any_of(regions.begin(), regions.end(), [&](core::RegionId region) {
    return transport::lane_kind(scene, region, lane_width) != transport::LaneKind::none;
  });
}

/// Batches that no thread is using. What a batch has made of the scene serves the next blocks.
class FreeBatches {
 public:
  /// Null when there is none.
  std::unique_ptr<transport::Batch> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return nullptr;
    std::unique_ptr<transport::Batch> batch = std::move(free_.back());
    free_.pop_back();
    return batch;
  }
  void put(std::unique_ptr<transport::Batch> batch) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(batch));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<transport::Batch>> free_;
};

/// Traces the blocks of one point.
class BlockTracer {
 public:
  BlockTracer(const scene::Scene& scene, const source::LightSource& source, const tally::TallyPlan& plan,
              const RunSettings& settings)
      : scene_(scene),
        source_(source),
        plan_(plan),
        settings_(settings),
        energy_(source.has_energy()),
        lane_width_(lane_width_of(scene, source, plan, settings)),
        lane_kinds_(transport::lane_kinds(scene, lane_width_)) {}

  /// Blocks traced together at best, of a number of them. The lanes are full until the last photons of all
  /// are under way, and no result depends on it; threads need pieces of work, and several each.
  std::uint64_t together(std::uint64_t blocks) const {
    constexpr std::uint64_t kMost = 8, kPiecesPerThread = 16;
    if (lane_width_ == 1 || energy_) return 1;
    const std::uint64_t threads = settings_.threads > 0 ? static_cast<std::uint64_t>(settings_.threads)
                                                        : std::thread::hardware_concurrency();
    return std::clamp<std::uint64_t>(blocks / (kPiecesPerThread * std::max<std::uint64_t>(threads, 1)), 1,
                                     kMost);
  }

  /// Traces successive blocks.
  std::vector<Block> trace(const tally::BlockRange& numbers) const {
    std::vector<Block> blocks;
    blocks.reserve(numbers.count());
    while (blocks.size() < numbers.count()) blocks.emplace_back(scene_, plan_);
    if (lane_width_ > 1)
      trace_together(numbers.first, blocks);
    else
      for (std::size_t i = 0; i < blocks.size(); ++i) trace_alone(numbers.first + i, blocks[i]);
    return blocks;
  }

 private:
  /// A photon of a block.
  struct Address {
    std::uint64_t event = 0, photon = 0;
    double conversion_draw = 0.0;
    std::size_t block = 0;  ///< of those traced together
  };

  /// Traces the photons of a block one after another, with all that is recorded of them on their way.
  void trace_alone(std::uint64_t number, Block& block) const {
    const auto pass = [&](const source::Photon& photon, const transport::Step& passed) {
      block.photons.pass(photon, passed);
    };
    transport::PropagationLimits limits = limits_of(settings_);
    if (block.photons.wants_reflections()) limits.passed = pass;
    source::EventLight light;
    ConversionDraws draws(settings_);
    for (const source::PhotonSpan& span : source_.block(number)) {
      core::Rng rng = event_stream(settings_, span.event);
      source_.begin(scene_, span.event, rng, light);
      if (energy_) block.events.begin(span.event, settings_.point, light);
      const std::uint64_t count = std::min(span.count, light.photons - span.first);
      for (std::uint64_t i = span.first; i < span.first + count; ++i) {
        const double draw = draws.at(span.event, i);
        if (draw >= settings_.birth_efficiency) continue;
        trace_photon(light, {span.event, i, draw}, limits, block);
        ++block.traced;
      }
      block.emitted += count;
      if (energy_) end_event(span.event, block);
    }
  }

  void end_event(std::uint64_t event, Block& block) const {
    block.events.end([&](std::uint32_t channel) { return sensor_stream(settings_, event, channel); });
  }

  /// Traces photons of which only the ends are recorded. One event of energy is traced after another.
  void trace_together(std::uint64_t first, std::vector<Block>& blocks) const {
    std::unique_ptr<transport::Batch> batch = batches_.take();
    if (!batch)
      batch = std::make_unique<transport::Batch>(scene_, limits_of(settings_), lane_width_, lane_kinds_);
    source::EventLight light;
    ConversionDraws draws(settings_);
    std::vector<Address> photons;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      Block& block = blocks[b];
      for (const source::PhotonSpan& span : source_.block(first + b)) {
        core::Rng rng = event_stream(settings_, span.event);
        source_.begin(scene_, span.event, rng, light);
        if (energy_) block.events.begin(span.event, settings_.point, light);
        const std::uint64_t count = std::min(span.count, light.photons - span.first);
        block.emitted += count;
        for (std::uint64_t i = span.first; i < span.first + count; ++i) {
          const double draw = draws.at(span.event, i);
          if (draw >= settings_.birth_efficiency) continue;
          photons.push_back({span.event, i, draw, b});
          if (photons.size() == kMostTogether) trace_together(photons, light, *batch, blocks);
        }
        if (!energy_) continue;
        trace_together(photons, light, *batch, blocks);
        end_event(span.event, block);
      }
    }
    trace_together(photons, light, *batch, blocks);
    batches_.put(std::move(batch));
  }

  /// Traces the photons, and removes them from the list.
  /// @param light  of their event; for a source of photons of any event
  void trace_together(std::vector<Address>& photons, const source::EventLight& light, transport::Batch& batch,
                      std::vector<Block>& blocks) const {
    const auto stream = [&](std::uint64_t i) {
      return photon_stream(settings_, photons[i].event, photons[i].photon);
    };
    const auto emit = [&](std::uint64_t i, core::Rng& rng) {
      source::Photon photon = source_.emit(scene_, light, photons[i].photon, rng);
      photon.conversion_draw = photons[i].conversion_draw;
      return photon;
    };
    const auto end = [&](std::uint64_t i, const transport::TracedPhoton& traced) {
      Block& block = blocks[photons[i].block];
      tally::BlockTally& tally = block.photons;
      ++block.traced;
      tally.start(photons[i].event, photons[i].photon);
      tally.count_steps(traced.segments_before, traced.resolved_before);
      if (traced.cut) return tally.cut(traced.photon, *traced.cut);
      tally.end(traced.photon, traced.last, settings_.point);
      if (energy_ && traced.last.event == core::StepEvent::detected)
        block.events.detected(plan_.channels.at(traced.last), traced.photon);
    };
    batch.trace(photons.size(), stream, emit, end);
    photons.clear();
  }

  /// Traces a photon, then those that wavelength shifters re-emitted in addition to it, with its stream.
  void trace_photon(const source::EventLight& light, const Address& address,
                    const transport::PropagationLimits& limits, Block& block) const {
    core::Rng rng = photon_stream(settings_, address.event, address.photon);
    source::Photon photon = source_.emit(scene_, light, address.photon, rng);
    photon.conversion_draw = address.conversion_draw;
    follow(photon, address, rng, limits, block);
    std::vector<source::Photon> waiting = block.photons.records().take_additional();
    for (std::uint64_t additional = 0; !waiting.empty(); ++additional) {
      if (additional == kMostAdditional)
        throw core::InputError(core::Problem{{},
                                             "one photon was re-emitted as more than " +
                                                 std::to_string(kMostAdditional) + " by wavelength shifters",
                                             "a quantum yield above 1 in a medium that absorbs its own "
                                             "emission multiplies light without end"});
      photon = waiting.back();
      waiting.pop_back();
      ++block.additional;
      follow(photon, address, rng, limits, block);
      for (const source::Photon& more : block.photons.records().take_additional()) waiting.push_back(more);
    }
  }

  /// Traces one photon to its end.
  void follow(source::Photon& photon, const Address& address, core::Rng& rng,
              const transport::PropagationLimits& limits, Block& block) const {
    tally::BlockTally& tally = block.photons;
    tally.start(photon, address.event, address.photon);
    for (;;) {
      const transport::Step taken = transport::step(scene_, photon, rng, limits, &tally.records());
      if (core::is_final(taken.event)) {
        tally.end(photon, taken, settings_.point);
        if (energy_ && taken.event == core::StepEvent::detected)
          block.events.detected(plan_.channels.at(taken), photon);
        return;
      }
      tally.record(photon, taken);
      if (const auto fate = limits.reached(photon)) return tally.cut(photon, *fate);
    }
  }

  const scene::Scene& scene_;
  const source::LightSource& source_;
  const tally::TallyPlan& plan_;
  const RunSettings& settings_;
  bool energy_;
  int lane_width_;
  transport::LaneKinds lane_kinds_;
  mutable FreeBatches batches_;
};

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

  void add(const Block& block) {
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

double ConversionDraws::at(std::uint64_t event, std::uint64_t photon) {
  constexpr std::uint64_t kNumbers = std::tuple_size_v<decltype(numbers_)>;
  const std::uint64_t block = photon / kNumbers;
  if (!has_numbers_ || event_ != event || block_ != block) {
    core::Rng rng(seed_, core::StreamKind::conversion, event, block, point_);
    for (std::uint64_t& number : numbers_) number = rng.bits();
    event_ = event;
    block_ = block;
    has_numbers_ = true;
  }
  return core::Rng::to_uniform(numbers_[photon % kNumbers]);
}

core::Rng photon_stream(const RunSettings& settings, std::uint64_t event, std::uint64_t photon) {
  return core::Rng(settings.seed, core::StreamKind::photon, event, photon, settings.point);
}

core::Rng event_stream(const RunSettings& settings, std::uint64_t event) {
  return core::Rng(settings.seed, core::StreamKind::event, event, 0, settings.point);
}

core::Rng sensor_stream(const RunSettings& settings, std::uint64_t event, std::uint32_t channel) {
  return core::Rng(settings.seed, core::StreamKind::sensor, event, channel, settings.point);
}

int lane_width_of(const scene::Scene& scene, const source::LightSource& source, const tally::TallyPlan& plan,
                  const RunSettings& settings) {
  const bool ends_only = plan.counts.empty() && !plan.history && !shifts_light(scene);
  return ends_only && starts_in_lanes(scene, source, settings.lane_width) ? settings.lane_width : 1;
}

tally::BlockRange trace_blocks(const scene::Scene& scene, const source::LightSource& source,
                               const tally::TallyPlan& plan, const RunSettings& settings,
                               tally::BlockRange blocks, const RunHooks& hooks) {
  const BlockTracer tracer(scene, source, plan, settings);
  RangeCollector collector([&] { return tally::empty_sums(scene, plan); }, blocks.first, hooks);
  const bool energy = source.has_energy();
  std::uint64_t done = 0, kept = 0;
  bool is_enough = false;
  std::atomic<bool> ended{false};  // by a stop or because it is enough, where hooks decide that
  const std::uint64_t together = tracer.together(blocks.count());
  const auto trace = [&](std::uint64_t piece) {
    if (hooks.enough && hooks.stop && hooks.stop->load()) ended = true;
    const std::uint64_t first = blocks.first + piece * together;
    return tracer.trace({first, std::min(first + together, blocks.last)});
  };
  const auto collect = [&](std::uint64_t, const std::vector<Block>& traced) {
    for (const Block& block : traced) {
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
  const std::uint64_t pieces = (blocks.count() + together - 1) / together;
  core::work_in_order(pieces, settings.threads, hooks.enough ? &ended : hooks.stop, trace, collect);
  collector.end_range();
  return {blocks.first, blocks.first + kept};
}

tally::PointResult run_point(const scene::Scene& scene, const source::LightSource& source,
                             const tally::TallyPlan& plan, const RunSettings& settings,
                             const RunHooks& hooks) {
  const bool energy = source.has_energy();
  tally::PointSums sums = tally::empty_sums(scene, plan);
  RunHooks collecting = hooks;
  collecting.range = [&](const tally::BlockRange& range, tally::PointSums more) {
    sums.merge(more);
    if (hooks.range) hooks.range(range, std::move(more));
  };
  const tally::BlockRange all{0, source.blocks()};
  const tally::BlockRange traced = trace_blocks(scene, source, plan, settings, all, collecting);
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
  start.conversion_draw = ConversionDraws(settings).at(event, photon);
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
