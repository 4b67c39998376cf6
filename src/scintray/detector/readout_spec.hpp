#pragma once
/// The readout electronics of every sensor, as a scene file specifies them (docs/readout.md).

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "scintray/core/error.hpp"

namespace scintray::detector {

enum class TimePickoff {
  leading_edge,   ///< first rise through the threshold
  peak_fraction,  ///< rise through a fraction of the largest sample
  cfd,            ///< constant fraction discriminator: v(t - delay) overtakes fraction * v(t)
};

/// Most samples of a waveform that a scene may request.
inline constexpr std::uint64_t kMostSamples = 1'000'000;

/// Settings of the readout electronics. Times count from the start of the event. Amplitudes are in
/// photoelectrons: a single full avalanche has a peak of 1.
struct ReadoutSpec {
  double period_ns = 1.0;                          ///< between samples
  double before_ns = 0.0;                          ///< from the first sample to the start of the event
  double window_ns = 0.0;                          ///< length of the waveform
  std::optional<std::array<double, 2>> gate_ns{};  ///< interval of the charge integral; nothing: the window
  std::vector<double> shaping_ns{};                ///< time constants of the low-pass stages of the shaper
  double noise = 0.0;                              ///< standard deviation of each sample, photoelectrons
  int adc_bits = 0;                                ///< 0: samples are not rounded
  std::array<double, 2> adc_range{0.0, 0.0};       ///< first and last code, photoelectrons
  TimePickoff time_pickoff = TimePickoff::leading_edge;
  double threshold = 0.5;                     ///< photoelectrons; a pulse below it has no time
  double fraction = 0.0;                      ///< of peak_fraction and cfd
  double delay_ns = 0.0;                      ///< of cfd
  bool pulses = false;                        ///< keep waveforms
  std::vector<std::uint64_t> photon_order{};  ///< n of the n-th photon times, from 1
  core::FileLocation where{};

  std::uint64_t samples() const { return static_cast<std::uint64_t>(std::llround(window_ns / period_ns)); }
  bool operator==(const ReadoutSpec&) const = default;
};

}  // namespace scintray::detector
