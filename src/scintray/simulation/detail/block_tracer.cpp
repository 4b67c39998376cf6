#include "scintray/simulation/detail/block_tracer.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "scintray/transport/step.hpp"

namespace scintray::simulation {

namespace {

/// Photons of which the ends are held at once, so that an event of any energy takes bounded memory.
constexpr std::size_t kMostTogether = 8192;
/// Blocks traced together. Of many more, photons that wait until the end keep those after them from being
/// handed over.
constexpr std::uint64_t kMostBlocksTogether = 8;
/// Photons re-emitted in addition to one photon, above which the multiplication is taken as endless.
constexpr std::uint64_t kMostAdditional = 1'000'000;

}  // namespace

std::unique_ptr<transport::Batch> FreeBatches::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return nullptr;
  std::unique_ptr<transport::Batch> batch = std::move(free_.back());
  free_.pop_back();
  return batch;
}

void FreeBatches::put(std::unique_ptr<transport::Batch> batch) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(batch));
}

BlockTracer::BlockTracer(const TracedPoint& point, const RunSettings& settings)
    : scene_(point.scene),
      source_(point.source),
      plan_(point.plan),
      settings_(settings),
      energy_(point.source.has_energy()),
      lanes_(point.lanes) {}

BlockPieces BlockTracer::pieces(const tally::BlockRange& blocks, bool may_have_enough) const {
  const bool together = lanes_.width() > 1 && !energy_;
  const auto threads = static_cast<std::uint64_t>(std::max(settings_.threads, 0));
  return {blocks, together ? kMostBlocksTogether : 1,
          threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency()), may_have_enough};
}

std::vector<TracedBlock> BlockTracer::trace(const tally::BlockRange& numbers) const {
  std::vector<TracedBlock> blocks;
  blocks.reserve(numbers.count());
  while (blocks.size() < numbers.count()) blocks.emplace_back(scene_, plan_);
  if (lanes_.width() > 1)
    trace_together(numbers.first, blocks);
  else
    for (std::size_t i = 0; i < blocks.size(); ++i) trace_alone(numbers.first + i, blocks[i]);
  return blocks;
}

void BlockTracer::trace_alone(std::uint64_t number, TracedBlock& block) const {
  const auto pass = [&](const source::Photon& photon, const transport::Step& passed) {
    block.photons.pass(photon, passed);
  };
  transport::PropagationLimits limits = limits_of(settings_);
  if (block.photons.wants_reflections()) limits.passed = pass;
  source::EventLight light;
  PhotonStreams streams(settings_);
  for (const source::PhotonSpan& span : source_.block(number)) {
    core::Rng rng = event_stream(settings_, span.event);
    source_.begin(scene_, span.event, rng, light);
    if (energy_) block.events.begin(span.event, settings_.point, light);
    const std::uint64_t count = std::min(span.count, light.photons - span.first);
    for (std::uint64_t i = span.first; i < span.first + count; ++i) {
      const double draw = streams.conversion_draw(span.event, i);
      if (draw >= settings_.birth_efficiency) continue;
      trace_photon(light, {span.event, i, draw}, limits, block);
      ++block.traced;
    }
    block.emitted += count;
    if (energy_) end_event(span.event, block);
  }
}

void BlockTracer::end_event(std::uint64_t event, TracedBlock& block) const {
  block.events.end([&](std::uint32_t channel) { return sensor_stream(settings_, event, channel); });
}

void BlockTracer::trace_together(std::uint64_t first, std::vector<TracedBlock>& blocks) const {
  std::unique_ptr<transport::Batch> batch = batches_.take();
  if (!batch) batch = std::make_unique<transport::Batch>(scene_, limits_of(settings_), lanes_);
  source::EventLight light;
  PhotonStreams streams(settings_);
  std::vector<Address> photons;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    TracedBlock& block = blocks[b];
    for (const source::PhotonSpan& span : source_.block(first + b)) {
      core::Rng rng = event_stream(settings_, span.event);
      source_.begin(scene_, span.event, rng, light);
      if (energy_) block.events.begin(span.event, settings_.point, light);
      const std::uint64_t count = std::min(span.count, light.photons - span.first);
      block.emitted += count;
      for (std::uint64_t i = span.first; i < span.first + count; ++i) {
        const double draw = streams.conversion_draw(span.event, i);
        if (draw >= settings_.birth_efficiency) continue;
        photons.push_back({span.event, i, draw, b});
        if (photons.size() == kMostTogether) trace_photons(photons, light, *batch, blocks);
      }
      if (!energy_) continue;
      trace_photons(photons, light, *batch, blocks);
      end_event(span.event, block);
    }
  }
  trace_photons(photons, light, *batch, blocks);
  batches_.put(std::move(batch));
}

void BlockTracer::trace_photons(std::vector<Address>& photons, const source::EventLight& light,
                                transport::Batch& batch, std::vector<TracedBlock>& blocks) const {
  PhotonStreams streams(settings_);
  const auto emit = [&](std::uint64_t first, std::span<source::EmittedPhoton* const> emitted) {
    for (std::size_t i = 0; i < emitted.size(); ++i) {
      emitted[i]->number = photons[first + i].photon;
      emitted[i]->rng = streams.stream(photons[first + i].event, emitted[i]->number);
    }
    source_.emit_together(scene_, light, emitted, lanes_.width());
    for (std::size_t i = 0; i < emitted.size(); ++i)
      emitted[i]->photon.conversion_draw = photons[first + i].conversion_draw;
  };
  const auto end = [&](std::uint64_t i, const transport::TracedPhoton& traced) {
    TracedBlock& block = blocks[photons[i].block];
    tally::BlockTally& tally = block.photons;
    ++block.traced;
    tally.start(photons[i].event, photons[i].photon);
    tally.count_steps(traced.segments_before, traced.resolved_before);
    if (traced.cut) return tally.cut(traced.photon, *traced.cut);
    tally.end(traced.photon, traced.last, settings_.point);
    if (energy_ && traced.last.event == core::StepEvent::detected)
      block.events.detected(plan_.channels.at(traced.last), traced.photon);
  };
  batch.trace(photons.size(), emit, end);
  photons.clear();
}

void BlockTracer::trace_photon(const source::EventLight& light, const Address& address,
                               const transport::PropagationLimits& limits, TracedBlock& block) const {
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

void BlockTracer::follow(source::Photon& photon, const Address& address, core::Rng& rng,
                         const transport::PropagationLimits& limits, TracedBlock& block) const {
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

}  // namespace scintray::simulation
