#pragma once
/// The pulse of one avalanche after the shaper, waveforms as sums of such pulses, and their measured
/// quantities.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/detector/avalanche.hpp"
#include "scintray/detector/readout_spec.hpp"

namespace scintray::detector {

/// A range of samples of a waveform, and the integral from the first to the end of the period of the last.
struct GateIntegral {
  std::size_t first = 0, past = 0;  ///< `past` follows the last sample; equal: no sample
  double integral_ns = 0.0;         ///< photoelectrons times ns
};

/// Pulse shape of a chain of low-pass stages 1 / (1 + s tau), which comprises the usual pulses: with two
/// different time constants (exp(-t/a) - exp(-t/b)) / (a - b), with n + 1 equal ones the CR-RC^n response to
/// a charge, t^n exp(-t/tau) / (n! tau^(n+1)) (G. F. Knoll, Radiation Detection and Measurement, 4th ed.,
/// chapter 17), and any convolution of these. Scaled so that the peak of a charge of 1 is 1.
///
/// The outputs of all stages are carried from sample to sample, so that a waveform costs one small matrix
/// product a sample and one short series an avalanche. The series (uniformisation: A. Jensen 1953, Skand.
/// Aktuarietidskr. 36, 87) has positive terms only, so that equal and nearly equal time constants are as
/// exact as others.
class PulseShape {
 public:
  static constexpr std::size_t kMostStages = 16;

  /// @param time_constants_ns  of at most kMostStages stages; those below 1e-4 of a period (chosen) are
  ///        taken as 0
  /// @param period_ns  sampling period
  /// Throws InputError when no stage of non-zero duration is left, or when the pulse is longer than 10^6
  /// periods.
  PulseShape(const std::vector<double>& time_constants_ns, double period_ns);

  /// Amplitude of the pulse at a time after its avalanche, photoelectrons; 0 before.
  double value(double time_ns) const;
  /// Integral of the pulse, photoelectrons times ns.
  double area_ns() const { return scale_; }
  /// Time after which less than 1e-4 of the pulse's area is left (chosen). Channels draw dark counts
  /// from this time before a waveform on.
  double duration_ns() const { return duration_ns_; }

  /// Waveform of avalanches (photoelectrons), sampled at start_ns, start_ns + period...
  /// @param avalanches  sorted by time; of those before the start the tails contribute
  std::vector<double> waveform(std::span<const Avalanche> avalanches, double start_ns,
                               std::size_t samples) const;
  /// The same; sets the integral of the gate from the charge that arrives in it and the charge that the
  /// stages hold at its ends, whatever the period. A sum of samples is the integral only of pulses that rise
  /// slowly: of one without rise it depends on where between two samples the avalanches lie.
  /// @param gate  its samples are within the waveform
  std::vector<double> waveform(std::span<const Avalanche> avalanches, double start_ns, std::size_t samples,
                               GateIntegral& gate) const;

 private:
  /// Outputs of the stages, or of so many that they are among them: those beyond are 0.
  template <std::size_t kStages = kMostStages>
  using State = std::array<double, kStages>;
  void check_stages(double mean_ns, double squares);
  void tabulate();
  State<> impulse() const;
  template <std::size_t kStages>
  void pass(State<kStages>& state, double time_ns) const;
  template <std::size_t kStages>
  void step(State<kStages>& state) const;  ///< by one period
  template <std::size_t kStages>
  State<kStages> after(double time_ns) const;
  template <std::size_t kStages>
  void add_pulses(std::span<const Avalanche> avalanches, double start_ns, std::span<double> waveform,
                  GateIntegral& gate) const;
  /// Calls act(constant), of the usual number of stages or of the most there can be: loops of known length.
  template <class Act>
  void for_stages(const Act& act) const;
  double held(std::span<const double> state) const;

  std::vector<double> rate_per_ns_;  ///< of each stage
  State<> share_of_fastest_{};       ///< likewise, over the greatest of them; 0 beyond the last
  double fastest_per_ns_ = 0.0;
  double period_ns_, scale_ = 1.0, duration_ns_ = 0.0;
  std::vector<State<>> grid_;                    ///< an avalanche's state at equal fractions of a period
  std::array<State<>, kMostStages> per_step_{};  ///< state one period after stage i alone was 1
};

/// Digitised waveform (photoelectrons): white noise is added to each sample, and samples are rounded to the
/// codes of the converter, where the readout defines these. Samples beyond the range of codes saturate at its
/// ends.
/// @param waveform  photoelectrons
std::vector<float> digitize(std::span<const double> waveform, const ReadoutSpec& readout, core::Rng& rng);

/// The samples in the gate of a readout, of a waveform of so many samples that starts before_ns before the
/// event. Its integral is not set.
GateIntegral gate_of(const ReadoutSpec& readout, std::size_t samples);

struct PulseMeasurement {
  double charge = 0.0;            ///< photoelectrons: sum over the gate times the period over pulse_area_ns
  double amplitude = 0.0;         ///< largest sample, photoelectrons
  std::optional<double> time_ns;  ///< nothing when no sample rises through the threshold in the window
};

/// Charge, amplitude and time of the pulse in a waveform whose first sample is at -before_ns.
///
/// Times are interpolated linearly between samples. leading_edge: the first rise through the threshold.
/// peak_fraction: the last rise through the fraction of the largest sample before that sample. cfd: where
/// v(t - delay) - fraction v(t) goes from negative to positive, at the threshold's first rise or next to it
/// (D. A. Gedcke and W. J. McDonald 1968, Nucl. Instrum. Methods 58, 253); its constant offset from the start
/// of the pulse is not subtracted.
///
/// @param pulse_area_ns  PulseShape::area_ns()
PulseMeasurement measure(std::span<const float> waveform, const ReadoutSpec& readout, double pulse_area_ns);

}  // namespace scintray::detector
