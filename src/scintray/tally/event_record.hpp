#pragma once
/// What one event left and gave.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "scintray/core/ids.hpp"

namespace scintray::tally {

/// What one readout channel saw of an event. A channel is a part that is a sensor, or a face that is one.
struct ChannelRecord {
  std::uint32_t detected = 0;                                 ///< photons
  float first_ns = std::numeric_limits<float>::quiet_NaN();   ///< first detected photon, behind a readout
                                                              ///< with the sensor's spread; NaN: none
  float charge = std::numeric_limits<float>::quiet_NaN();     ///< photoelectrons, after the sensor's
                                                              ///< response; NaN without [readout]
  float amplitude = std::numeric_limits<float>::quiet_NaN();  ///< of the waveform; NaN without [readout]
  float time_ns = std::numeric_limits<float>::quiet_NaN();    ///< by the readout's pick-off; NaN: none
  std::vector<float> order_ns;  ///< n-th photons, as ReadoutSpec::photon_order requests; NaN: fewer
  std::vector<float> waveform;  ///< photoelectrons, when ReadoutSpec::pulses
};

/// Light of a channel: its charge behind a readout, else its photons.
inline double light_of(const ChannelRecord& channel, bool readout) {
  return readout ? static_cast<double>(channel.charge) : static_cast<double>(channel.detected);
}

/// One event of a source of energy.
struct EventRecord {
  std::uint32_t point = 0;  ///< of the sweep
  std::uint64_t event = 0;
  float energy_keV = 0.0f;                  ///< deposited in scintillators
  float escaped_keV = 0.0f;                 ///< carried out of the scene
  float non_scintillating_keV = 0.0f;       ///< left in what does not scintillate
  std::array<float, 3> position_mm{};       ///< mean of the deposits, weighted by energy; zero without any
  core::PartId part;                        ///< of the largest deposit; none without any
  std::uint64_t emitted = 0, detected = 0;  ///< photons
  std::vector<ChannelRecord> channels;
};

}  // namespace scintray::tally
