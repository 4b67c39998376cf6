#pragma once
/// Records of events: energies, photons and readout signals.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "scintray/core/ids.hpp"

namespace scintray::tally {

/// Signal of one readout channel in an event. A channel is a part that is a sensor, or a face that is one.
struct ChannelRecord {
  std::uint32_t detected = 0;                                 ///< photons
  float first_ns = std::numeric_limits<float>::quiet_NaN();   ///< first detected photon, behind a readout
                                                              ///< with the sensor's spread; NaN: none
  float charge = std::numeric_limits<float>::quiet_NaN();     ///< photoelectrons, after the sensor's
                                                              ///< response; NaN without [readout]
  float amplitude = std::numeric_limits<float>::quiet_NaN();  ///< photoelectrons; NaN without [readout]
  float time_ns = std::numeric_limits<float>::quiet_NaN();    ///< by the readout's pick-off; NaN: none
  std::vector<float> order_ns;  ///< times of the n-th photons of ReadoutSpec::photon_order; NaN: fewer
  std::vector<float> waveform;  ///< photoelectrons, when ReadoutSpec::pulses
};

/// Light of a channel: its charge with a readout, else its number of photons.
inline double light_of(const ChannelRecord& channel, bool readout) {
  return readout ? static_cast<double>(channel.charge) : static_cast<double>(channel.detected);
}

/// One event of an event source.
struct EventRecord {
  std::uint32_t point = 0;  ///< of the sweep
  std::uint64_t event = 0;
  float energy_keV = 0.0f;                  ///< deposited in scintillators
  float escaped_keV = 0.0f;                 ///< carried out of the scene
  float non_scintillating_keV = 0.0f;       ///< in non-scintillating parts
  std::array<float, 3> position_mm{};       ///< mean of the deposits, weighted by energy; zero without any
  core::PartId part;                        ///< of the largest deposit; none without any
  std::uint64_t emitted = 0, detected = 0;  ///< photons
  std::vector<ChannelRecord> channels;
};

}  // namespace scintray::tally
