#pragma once
/// Events of a detector that nobody traced: 4 x 4 crystals with a channel at both ends of each.

#include <cmath>
#include <cstdint>
#include <vector>

#include "analysis/toys.hpp"
#include "scintray/analysis/event_analysis.hpp"

namespace scintray::test {

/// Crystals of 3 x 3 x 20 mm at a pitch of 3.2 mm, parts 1 to 16. Light is attenuated exponentially on its
/// way to the ends at z = 0 and 20 mm, and a fifth of it goes to the crystals' neighbours.
struct MadeUpDetector {
  static constexpr std::size_t kSide = 4;
  static constexpr double kPitch_mm = 3.2, kLength_mm = 20.0, kAttenuation_mm = 50.0;

  analysis::AnalysisSetup setup() const {
    analysis::AnalysisSetup setup;
    for (const double z : {0.0, kLength_mm})
      for (std::size_t k = 0; k < kSide * kSide; ++k) setup.channels_mm.push_back(crystal_mm(k, z));
    setup.depth = analysis::DepthAxis{core::Vec3::Zero(), core::Vec3::UnitZ()};
    return setup;
  }

  std::vector<tally::EventRecord> events(std::size_t count, bool readout) const {
    std::vector<tally::EventRecord> all;
    for (std::size_t number = 0; number < count; ++number) {
      core::Rng rng = toy_rng(60, number);
      all.push_back(event(number, readout, rng));
    }
    return all;
  }

 private:
  static core::Vec3 crystal_mm(std::size_t k, double z) {
    return {kPitch_mm * static_cast<double>(k % kSide), kPitch_mm * static_cast<double>(k / kSide), z};
  }

  static double leak(std::size_t to, std::size_t from) {
    return std::exp(-(crystal_mm(to, 0.0) - crystal_mm(from, 0.0)).norm() / kPitch_mm);
  }

  tally::EventRecord event(std::size_t number, bool readout, core::Rng& rng) const {
    tally::EventRecord event;
    event.event = number;
    const auto crystal = static_cast<std::size_t>(16.0 * rng.uniform());
    const double z = kLength_mm * rng.uniform();
    const core::Vec3 at = crystal_mm(crystal, z);
    event.position_mm = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())};
    event.part = core::PartId(crystal + 1);
    // Six in ten deposit everything, the others up to the Compton edge.
    const double energy = rng.uniform() < 0.6 ? 511.0 : 341.0 * rng.uniform();
    event.energy_keV = static_cast<float>(energy);
    event.channels.resize(2 * kSide * kSide);
    double neighbours = 0.0;
    for (std::size_t k = 0; k < kSide * kSide; ++k)
      if (k != crystal) neighbours += leak(k, crystal);
    for (std::size_t end = 0; end < 2; ++end) {
      const double way = end == 0 ? z : kLength_mm - z;
      for (std::size_t k = 0; k < kSide * kSide; ++k) {
        const double share = k == crystal ? 0.8 : 0.2 * leak(k, crystal) / neighbours;
        const double expected = 2.5 * energy * share * std::exp(-way / kAttenuation_mm);
        fill(event.channels[end * kSide * kSide + k], expected, way, readout, rng);
      }
    }
    return event;
  }

  static void fill(tally::ChannelRecord& channel, double expected, double way_mm, bool readout,
                   core::Rng& rng) {
    const float none = std::numeric_limits<float>::quiet_NaN();
    const double photons =
        std::max(0.0, std::round(expected + std::sqrt(expected) * core::sample_normal(rng)));
    channel.detected = static_cast<std::uint32_t>(photons);
    channel.charge = channel.amplitude = none;
    if (photons > 0.0)
      channel.first_ns = static_cast<float>(way_mm * 1.82 / core::kSpeedOfLight_mm_per_ns +
                                            40.0 / photons * core::sample_exponential(rng));
    if (!readout) return;
    channel.charge = static_cast<float>(photons * (1.0 + 0.02 * core::sample_normal(rng)));
    channel.amplitude = 0.01F * channel.charge;
    if (photons > 20.0)
      channel.time_ns = channel.first_ns + 0.05F * static_cast<float>(core::sample_normal(rng));
  }
};

}  // namespace scintray::test
