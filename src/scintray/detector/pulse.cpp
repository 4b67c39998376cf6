#include "scintray/detector/pulse.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "scintray/core/error.hpp"

namespace scintray::detector {

namespace {

constexpr double kInstantaneous = 1e-4;  ///< of a period
constexpr double kTail = 1e-4;           ///< of the area
constexpr std::size_t kGrid = 64;
constexpr double kLongestPulse = 1e6;  ///< periods
/// Series are cut in pieces whose first weight, exp(-kLongestPiece), is far from underflow.
constexpr double kLongestPiece = 50.0;

/// Place of the largest value of a function with one peak in [0, high], by golden sections.
template <class Function>
double peak_of(const Function& f, double high) {
  constexpr double kGolden = 0.6180339887498949;
  double low = 0.0;
  while (high - low > 1e-12 * high) {
    const double step = kGolden * (high - low);
    const double left = high - step, right = low + step;
    if (left <= low || right >= high) break;
    if (f(left) < f(right))
      low = left;
    else
      high = right;
  }
  return 0.5 * (low + high);
}

}  // namespace

PulseShape::PulseShape(const std::vector<double>& time_constants_ns, double period_ns)
    : period_ns_(period_ns) {
  double mean_ns = 0.0, squares = 0.0;
  for (const double tau : time_constants_ns) {
    if (tau < kInstantaneous * period_ns) continue;
    rate_per_ns_.push_back(1.0 / tau);
    mean_ns += tau;
    squares += tau * tau;
  }
  check_stages(mean_ns, squares);
  tabulate();
  // A sum of exponential delays has a density with one peak (its logarithm is concave), within sqrt(3)
  // standard deviations of the mean.
  const double last_ns = mean_ns + std::sqrt(3.0 * squares);
  const double peak_ns =
      rate_per_ns_.size() == 1 ? 0.0 : peak_of([this](double t) { return value(t); }, last_ns);
  scale_ = 1.0 / value(peak_ns);
}

void PulseShape::check_stages(double mean_ns, double squares) {
  if (rate_per_ns_.empty())
    throw core::InputError({{},
                            "neither the sensor nor the electronics gives a pulse a duration",
                            "give the sensor [single_electron] decay, or [readout] shaping"});
  if (rate_per_ns_.size() > kMostStages)
    throw core::InternalError("a pulse of more stages than there is room for");
  const auto [slowest, fastest] = std::minmax_element(rate_per_ns_.begin(), rate_per_ns_.end());
  fastest_per_ns_ = *fastest;
  for (std::size_t i = 0; i < rate_per_ns_.size(); ++i)
    share_of_fastest_[i] = rate_per_ns_[i] / fastest_per_ns_;
  // The tail falls no slower than its longest stage; each stage delays it by no more than a few times its
  // own.
  duration_ns_ = mean_ns - std::log(kTail) / *slowest + 3.0 * std::sqrt(squares);
  if (duration_ns_ > kLongestPulse * period_ns_)
    throw core::InputError(
        {{},
         "a pulse of " + std::to_string(duration_ns_) + " ns, which is more than 10^6 samples",
         "check the units of the time constants of the sensor and the shaper, or sample less often"});
}

void PulseShape::tabulate() {
  State<> state = impulse();
  for (std::size_t i = 0; i < kGrid; ++i) {
    grid_.push_back(state);
    pass(state, period_ns_ / kGrid);
  }
  for (std::size_t i = 0; i < rate_per_ns_.size(); ++i) {
    per_step_[i][i] = 1.0;
    pass(per_step_[i], period_ns_);
  }
}

PulseShape::State<> PulseShape::impulse() const {
  State<> state{};
  state[0] = rate_per_ns_[0];
  return state;
}

template <class Act>
void PulseShape::for_stages(const Act& act) const {
  switch (rate_per_ns_.size()) {
    case 1:
      return act(std::integral_constant<std::size_t, 1>());
    case 2:
      return act(std::integral_constant<std::size_t, 2>());
    case 3:
      return act(std::integral_constant<std::size_t, 3>());
    case 4:
      return act(std::integral_constant<std::size_t, 4>());
    case 5:
      return act(std::integral_constant<std::size_t, 5>());
    case 6:
      return act(std::integral_constant<std::size_t, 6>());
    default:
      return act(std::integral_constant<std::size_t, kMostStages>());
  }
}

/// Multiplies the state with exp(A t), whose generator is bidiagonal: d state_i / dt = rate_i (state_(i-1)
/// - state_i). With the fastest rate r and P = 1 + A / r, which has no negative entry, the exponential is
/// the sum over m of exp(-r t) (r t)^m / m! P^m.
template <std::size_t kStages>
void PulseShape::pass(State<kStages>& state, double time_ns) const {
  for (double left = fastest_per_ns_ * time_ns; left > 0.0;) {
    const double piece = std::min(left, kLongestPiece);
    left -= piece;
    State<kStages> term = state, sum{};
    double weight = std::exp(-piece);
    for (double m = 1.0; weight > 1e-20 || m < piece; m += 1.0) {
      for (std::size_t i = 0; i < kStages; ++i) sum[i] += weight * term[i];
      for (std::size_t i = kStages; i-- > 0;)
        term[i] += share_of_fastest_[i] * ((i > 0 ? term[i - 1] : 0.0) - term[i]);
      weight *= piece / m;
    }
    state = sum;
  }
}

template <std::size_t kStages>
void PulseShape::step(State<kStages>& state) const {
  // The last stage first: each depends on those before it alone.
  for (std::size_t to = kStages; to-- > 0;) {
    double passed = 0.0;
    for (std::size_t from = 0; from <= to; ++from) passed += state[from] * per_step_[from][to];
    state[to] = passed;
  }
}

template <std::size_t kStages>
PulseShape::State<kStages> PulseShape::after(double time_ns) const {
  const double periods = std::floor(time_ns / period_ns_);
  const double rest_ns = std::max(0.0, time_ns - periods * period_ns_);
  const auto before = std::min(static_cast<std::size_t>(rest_ns / period_ns_ * kGrid), kGrid - 1);
  State<kStages> state;
  std::copy_n(grid_[before].begin(), kStages, state.begin());
  pass(state, rest_ns - static_cast<double>(before) * period_ns_ / kGrid);
  const auto steps = static_cast<std::uint64_t>(periods);
  for (std::uint64_t i = 0; i < steps; ++i) step(state);
  return state;
}

double PulseShape::value(double time_ns) const {
  if (time_ns < 0.0) return 0.0;
  double last = 0.0;
  for_stages([&](auto stages) { last = after<stages>(time_ns)[rate_per_ns_.size() - 1]; });
  return scale_ * last;
}

/// Charge in the stages, which is still to come out: each holds its output over its rate.
double PulseShape::held(std::span<const double> state) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < rate_per_ns_.size(); ++i) sum += state[i] / rate_per_ns_[i];
  return sum;
}

std::vector<double> PulseShape::waveform(std::span<const Avalanche> avalanches, double start_ns,
                                         std::size_t samples) const {
  GateIntegral none;
  return waveform(avalanches, start_ns, samples, none);
}

std::vector<double> PulseShape::waveform(std::span<const Avalanche> avalanches, double start_ns,
                                         std::size_t samples, GateIntegral& gate) const {
  std::vector<double> waveform(samples, 0.0);
  for_stages([&](auto stages) { add_pulses<stages>(avalanches, start_ns, waveform, gate); });
  return waveform;
}

template <std::size_t kStages>
void PulseShape::add_pulses(std::span<const Avalanche> avalanches, double start_ns,
                            std::span<double> waveform, GateIntegral& gate) const {
  const auto samples = static_cast<std::ptrdiff_t>(waveform.size());
  State<kStages> state{};
  auto next = std::lower_bound(avalanches.begin(), avalanches.end(), start_ns - duration_ns_,
                               [](const Avalanche& a, double time_ns) { return a.time_ns < time_ns; });
  const double early_ns = next == avalanches.end() ? 0.0 : std::max(0.0, start_ns - next->time_ns);
  const auto early = static_cast<std::ptrdiff_t>(std::ceil(early_ns / period_ns_));
  const auto first = static_cast<std::ptrdiff_t>(gate.first), past = static_cast<std::ptrdiff_t>(gate.past);
  // One step beyond the last sample ends the period of that sample.
  const std::ptrdiff_t end = std::max(samples, past + 1);
  bool silent = true;    // nothing is in the stages yet
  double arrived = 0.0;  // charge up to the present sample, the charge held at the gate's start included
  for (std::ptrdiff_t i = -early; i < end; ++i) {
    if (!silent) step(state);
    const double now_ns = start_ns + static_cast<double>(i) * period_ns_;
    for (; next != avalanches.end() && next->time_ns <= now_ns; ++next) {
      const State<kStages> pulse = after<kStages>(now_ns - next->time_ns);
      for (std::size_t stage = 0; stage < kStages; ++stage) state[stage] += next->charge * pulse[stage];
      arrived += next->charge;
      silent = false;
    }
    if (i == first) arrived = held(state);
    if (i == past) gate.integral_ns = scale_ * (arrived - held(state));
    if (i >= 0 && i < samples)
      waveform[static_cast<std::size_t>(i)] = scale_ * state[rate_per_ns_.size() - 1];
  }
}

}  // namespace scintray::detector
