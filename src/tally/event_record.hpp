#pragma once
/// What an event left behind: energy, place, and what each readout channel saw.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace scintray {

/// What one readout channel saw of an event.
struct ChannelRecord {
  std::uint32_t detected = 0;                                ///< photons
  float first_ns = std::numeric_limits<float>::quiet_NaN();  ///< time of the first detected photon; NaN: none
  float charge = 0;     ///< photoelectrons, after the sensor's response; NaN without [readout]
  float amplitude = 0;  ///< of the waveform; NaN without [readout]
  float time_ns = std::numeric_limits<float>::quiet_NaN();  ///< by the readout's time pick-off; NaN: none
};

struct EventRecord {
  std::uint32_t point = 0;
  std::uint64_t event = 0;
  float energy_keV = 0, escaped_keV = 0, unseen_keV = 0;  ///< deposited in scintillators
  std::array<float, 3> position_mm{};                     ///< energy-weighted mean of the deposits
  std::uint32_t region_part = 0;                          ///< part of the largest deposit
  std::uint64_t emitted = 0, detected = 0;
  std::vector<ChannelRecord> channels;
};

}  // namespace scintray
