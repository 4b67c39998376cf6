#pragma once
/// Digitised waveforms, and what is measured on them.

#include <optional>
#include <span>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/detector/readout_spec.hpp"

namespace scintray::detector {

/// Adds white noise to each sample and rounds to the codes of the converter, as far as the readout has them.
/// Beyond the range of codes samples stay at its ends.
/// @param waveform  photoelectrons
std::vector<float> digitize(std::span<const double> waveform, const ReadoutSpec& readout, core::Rng& rng);

struct PulseMeasurement {
  double charge = 0.0;            ///< sum over the gate times the period over the area of the pulse of 1
  double amplitude = 0.0;         ///< largest sample
  std::optional<double> time_ns;  ///< nothing when no sample rises through the threshold in the window
};

/// Measures a waveform whose first sample is at -before_ns.
///
/// Times are linear between samples. leading_edge: the first rise through the threshold. peak_fraction: the
/// last rise through the fraction of the largest sample before that sample. cfd: where
/// v(t - delay) - fraction v(t) goes from negative to positive, at the threshold's first rise or next to it
/// (D. A. Gedcke and W. J. McDonald 1968, Nucl. Instrum. Methods 58, 253); its constant offset from the
/// start of the pulse stays in.
///
/// @param pulse_area_ns  PulseShape::area_ns()
PulseMeasurement measure(std::span<const float> waveform, const ReadoutSpec& readout, double pulse_area_ns);

}  // namespace scintray::detector
