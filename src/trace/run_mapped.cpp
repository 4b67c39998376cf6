#include "scintray/trace/run_mapped.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "scintray/core/count_sampling.hpp"
#include "scintray/tally/event_tally.hpp"
#include "scintray/trace/in_order.hpp"

namespace scintray {

namespace {

/// Events made by one thread before it takes the next: many where they are made in no time, so that threads
/// seldom wait for each other; few where they have waveforms, which fill memory.
constexpr std::uint64_t kQuickEvents = 2048, kReadOutEvents = 256;

/// Makes events of one point.
class EventMaker {
 public:
  EventMaker(const Scene& scene, const LightSource& source, const TallyPlan& plan,
             const MappedResponse& response, const RunSettings& settings)
      : scene_(scene), source_(source), plan_(plan), response_(response), settings_(settings) {}

  std::uint64_t pieces() const { return (source_.events() + events_a_piece() - 1) / events_a_piece(); }

  EventTally make(std::uint64_t piece) const {
    EventTally tally(scene_, plan_);
    EventLight light;
    std::vector<PlaceResponse> seen;
    const std::uint64_t first = piece * events_a_piece();
    const std::uint64_t last = std::min(first + events_a_piece(), source_.events());
    for (std::uint64_t event = first; event < last; ++event) {
      Rng rng = event_stream(settings_, event);
      source_.begin(scene_, event, rng, light);
      tally.begin(event, settings_.point, light);
      Rng own(settings_.seed, StreamKind::mapped, event, 0, settings_.point);
      for (std::size_t i = 0; i < light.event.deposits.size(); ++i) {
        const std::uint64_t before = i == 0 ? 0 : light.deposits[i - 1].all;
        light_of(light.event.deposits[i], light.deposits[i].all - before, seen, own, tally);
      }
      tally.end([&](std::uint32_t channel) { return sensor_stream(settings_, event, channel); });
    }
    return tally;
  }

 private:
  std::uint64_t events_a_piece() const { return plan_.readout.empty() ? kQuickEvents : kReadOutEvents; }

  void light_of(const Deposit& deposit, std::uint64_t photons, std::vector<PlaceResponse>& seen, Rng& rng,
                EventTally& tally) const {
    if (photons == 0) return;
    if (!response_.covers(deposit.region))
      throw InputError({{},
                        "energy is left in \"" + scene_.region_names[deposit.region] +
                            "\", which the response map does not cover",
                        "build a map with all parts that scintillate"});
    response_.at(deposit.position, deposit.region, seen);
    double share = 1.0;  // of the photons that channels so far have not detected
    for (std::uint32_t channel = 0; channel < seen.size(); ++channel) {
      const double probability = seen[channel].probability();
      if (probability <= 0.0) continue;
      const std::uint64_t detected = sample_binomial(photons, probability / share, rng);
      photons -= detected;
      share -= probability;
      if (detected > 0) times_of(deposit, channel, detected, seen[channel], rng, tally);
    }
  }

  void times_of(const Deposit& deposit, std::uint32_t channel, std::uint64_t detected,
                const PlaceResponse& seen, Rng& rng, EventTally& tally) const {
    const std::vector<DecayComponent>& decay =
        scene_.media[scene_.regions[deposit.region].medium].medium().decay;
    if (!tally.wants_arrivals())
      return tally.detected(channel, detected, deposit.time_ns + sample_first(detected, decay, seen, rng));
    double first = std::numeric_limits<double>::infinity();
    for (std::uint64_t i = 0; i < detected; ++i) {
      const double time = deposit.time_ns + sample_decay(decay, rng) + seen.sample_delay(rng);
      first = std::min(first, time);
      tally.arrived(channel, {time});
    }
    tally.detected(channel, detected, first);
  }

  const Scene& scene_;
  const LightSource& source_;
  const TallyPlan& plan_;
  const MappedResponse& response_;
  const RunSettings& settings_;
};

}  // namespace

PointResult run_mapped(const Scene& scene, const LightSource& source, const TallyPlan& plan,
                       const MappedResponse& response, const RunSettings& settings, const RunHooks& hooks) {
  if (!source.has_energy()) throw InternalError("a response map was given a source of photons");
  const auto start = std::chrono::steady_clock::now();
  PointResult total = empty_result(scene, plan);
  const EventMaker maker(scene, source, plan, response, settings);
  const auto make = [&](std::uint64_t piece) { return maker.make(piece); };
  const auto collect = [&](std::uint64_t, const EventTally& tally) {
    tally.add_to(total.energy);
    if (hooks.events) hooks.events(tally.events());
    if (hooks.progress) hooks.progress(total.energy.events);
  };
  total.complete =
      work_in_order(maker.pieces(), settings.threads, hooks.stop, make, collect) == maker.pieces();
  total.energy.events_requested = source.events();
  total.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return total;
}

}  // namespace scintray
