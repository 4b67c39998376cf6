#include "scintray/simulation/detail/run_mapped.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "scintray/core/count_sampling.hpp"
#include "scintray/tally/event_tally.hpp"
#include "scintray/transport/in_order.hpp"

namespace scintray::simulation {

namespace {

/// Events made by one thread before it takes the next: many where they are made in no time, so that threads
/// seldom wait for each other; few where they have waveforms, which fill memory.
constexpr std::uint64_t kQuickEvents = 2048, kReadOutEvents = 256;

/// Makes events of one point.
class EventMaker {
 public:
  EventMaker(const scene::Scene& scene, const source::LightSource& source, const tally::TallyPlan& plan,
             const MappedResponse& response, const RunSettings& settings)
      : scene_(scene), source_(source), plan_(plan), response_(response), settings_(settings) {}

  std::uint64_t pieces() const { return (source_.events() + events_a_piece() - 1) / events_a_piece(); }

  tally::EventTally make(std::uint64_t piece) const {
    tally::EventTally tally(scene_, plan_);
    source::EventLight light;
    std::vector<PlaceResponse> seen;
    const std::uint64_t first = piece * events_a_piece();
    const std::uint64_t last = std::min(first + events_a_piece(), source_.events());
    for (std::uint64_t event = first; event < last; ++event) {
      core::Rng rng = event_stream(settings_, event);
      source_.begin(scene_, event, rng, light);
      tally.begin(event, settings_.point, light);
      core::Rng own(settings_.seed, core::StreamKind::mapped, event, 0, settings_.point);
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

  void light_of(const source::Deposit& deposit, std::uint64_t photons, std::vector<PlaceResponse>& seen,
                core::Rng& rng, tally::EventTally& tally) const {
    if (photons == 0) return;
    if (!response_.covers(deposit.region))
      throw core::InputError({{},
                              "energy is left in \"" + scene_.region_names[deposit.region] +
                                  "\", which the response map does not cover",
                              "build a map with all parts that scintillate"});
    response_.at(deposit.position, deposit.region, seen);
    double share = 1.0;  // of the photons that channels so far have not detected
    for (std::uint32_t channel = 0; channel < seen.size(); ++channel) {
      const double probability = seen[channel].probability();
      if (probability <= 0.0) continue;
      const std::uint64_t detected = core::sample_binomial(photons, probability / share, rng);
      photons -= detected;
      share -= probability;
      if (detected > 0) times_of(deposit, channel, detected, seen[channel], rng, tally);
    }
  }

  void times_of(const source::Deposit& deposit, std::uint32_t channel, std::uint64_t detected,
                const PlaceResponse& seen, core::Rng& rng, tally::EventTally& tally) const {
    const std::vector<optics::DecayComponent>& decay =
        scene_.media[scene_.regions[deposit.region].medium].medium().decay;
    if (!tally.wants_arrivals())
      return tally.detected(channel, detected, deposit.time_ns + sample_first(detected, decay, seen, rng));
    double first = std::numeric_limits<double>::infinity();
    for (std::uint64_t i = 0; i < detected; ++i) {
      const double time = deposit.time_ns + optics::sample_decay(decay, rng) + seen.sample_delay(rng);
      first = std::min(first, time);
      tally.arrived(channel, {time});
    }
    tally.detected(channel, detected, first);
  }

  const scene::Scene& scene_;
  const source::LightSource& source_;
  const tally::TallyPlan& plan_;
  const MappedResponse& response_;
  const RunSettings& settings_;
};

}  // namespace

tally::PointResult run_mapped(const scene::Scene& scene, const source::LightSource& source,
                              const tally::TallyPlan& plan, const MappedResponse& response,
                              const RunSettings& settings, const RunHooks& hooks) {
  if (!source.has_energy()) throw core::InternalError("a response map was given a source of photons");
  const auto start = std::chrono::steady_clock::now();
  tally::PointResult total = tally::empty_result(scene, plan);
  const EventMaker maker(scene, source, plan, response, settings);
  const auto make = [&](std::uint64_t piece) { return maker.make(piece); };
  const auto collect = [&](std::uint64_t, const tally::EventTally& tally) {
    tally.add_to(total.energy);
    if (hooks.events) hooks.events(tally.events());
    if (hooks.progress) hooks.progress(total.energy.events);
  };
  total.complete =
      transport::work_in_order(maker.pieces(), settings.threads, hooks.stop, make, collect) == maker.pieces();
  total.energy.events_requested = source.events();
  total.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return total;
}

}  // namespace scintray::simulation
