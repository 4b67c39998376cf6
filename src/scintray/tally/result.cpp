#include "scintray/tally/result.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/scene_file/tally.hpp"

namespace scintray::tally {

std::size_t TallyResult::bins() const {
  std::size_t bins = 1;
  for (const TallyAxis& axis : axes) bins *= axis.bins();
  return bins;
}

bool TallyResult::is_grouped() const {
  if (score != scene_file::kPhotonScore) return false;
  const auto is_position = [](const TallyAxis& axis) { return axis.variable == "position"; };
  return type == scene_file::kExitAngle || type == scene_file::kExitAngleBeyond ||
         type == scene_file::kCrosstalk || type == scene_file::kCrosstalkEmitted ||
         type == scene_file::kEtendue ||
         (axes.size() == 2 && std::all_of(axes.begin(), axes.end(), is_position));
}

namespace {

/// Standard error of a ratio of sums over events: the root of the sum of squared residuals, by the number of
/// degrees of freedom, over the denominator (W. G. Cochran 1977, Sampling Techniques, 3rd edition, section
/// 6.4, as analysis/ratio.hpp; derived in docs/physics.md).
double ratio_error(double residual_squares, std::uint64_t events, double denominator) {
  const auto count = static_cast<double>(events);
  return std::sqrt(std::max(0.0, residual_squares) * count / (count - 1.0)) / denominator;
}

}  // namespace

core::Estimate PhotonMoments::mean() const {
  const core::Estimate of_photons = core::Moments::mean();
  if (of_events.events < 2) return of_photons;
  const double r = of_photons.value;
  const double residual =
      of_events.squares - 2.0 * r * of_events.products + r * r * static_cast<double>(of_events.count_squares);
  return {r, ratio_error(residual, of_events.events, static_cast<double>(count))};
}

core::Estimate TallyResult::at(std::size_t bin, std::uint64_t photons) const {
  if (photons == 0) return {};
  if (!event_squares.empty() && events.all >= 2) {
    const auto count = static_cast<double>(events.all);
    const double error = ratio_error(event_squares[bin] - sum[bin] * sum[bin] / count, events.all, 1.0);
    return {sum[bin], score == scene_file::kPhotonScore && sum[bin] == 0.0 ? 1.0 : error};
  }
  const double n = static_cast<double>(photons);
  // Sum of n independent scores: n times their variance, which is at least that of one count.
  const double variance = std::max(sum_of_squares[bin] - sum[bin] * sum[bin] / n, 0.0);
  const bool counts = score == scene_file::kPhotonScore && sum[bin] == 0.0;
  return {sum[bin], counts ? 1.0 : std::sqrt(variance)};
}

core::Estimate TallyResult::per_photon(std::size_t bin, std::uint64_t photons) const {
  const core::Estimate total = at(bin, photons);
  const double n = std::max(1.0, static_cast<double>(photons));
  const bool nothing = score == scene_file::kPhotonScore && sum[bin] == 0.0;
  if (event_squares.empty() || events.with_photons < 2 || photons == 0 || nothing)
    return {total.value / n, total.error / n};
  const double r = sum[bin] / n;
  const double residual = event_squares[bin] - 2.0 * r * event_products[bin] + r * r * events.photon_squares;
  return {r, ratio_error(residual, events.with_photons, n)};
}

optics::ShiftCount PointResult::shifted() const {
  optics::ShiftCount total;
  for (const optics::ShiftCount& count : shifted_in_medium) total += count;
  for (const optics::ShiftCount& count : shifted_at_surface) total += count;
  return total;
}

core::Estimate PointResult::detected_fraction(std::uint64_t detected) const {
  const core::Estimate share = core::binomial_estimate(detected, photons);
  return {birth_efficiency * share.value, birth_efficiency * share.error};
}

core::Estimate PointResult::not_detected_fraction(std::uint64_t not_detected, std::uint64_t detected) const {
  if (birth_efficiency == 1.0 || photons == 0) return core::binomial_estimate(not_detected, photons);
  // The mean over the traced photons of 1 for a photon that is not detected and 1 - b for one that is.
  const double n = static_cast<double>(photons), weight = 1.0 - birth_efficiency;
  const double whole = static_cast<double>(not_detected), partial = static_cast<double>(detected);
  const double mean = (whole + weight * partial) / n;
  const double square = (whole + weight * weight * partial) / n;
  return {mean, std::sqrt(std::max(1.0 / n, square - mean * mean) / n)};
}

core::Estimate PointResult::share_of(std::uint64_t count, const EventShare& events) const {
  const core::Estimate share = core::binomial_estimate(count, photons);
  if (event_fates.events < 2 || events.squares == 0) return share;
  const double residual = static_cast<double>(events.squares) -
                          2.0 * share.value * static_cast<double>(events.products) +
                          share.value * share.value * event_fates.photon_squares();
  return {share.value, ratio_error(residual, event_fates.events, static_cast<double>(photons))};
}

core::Estimate PointResult::absorbed_fraction(core::MediumId medium) const {
  const bool has_events = events_in_medium.contains(medium);
  return share_of(absorbed_in_medium.contains(medium) ? absorbed_in_medium[medium] : 0,
                  has_events ? events_in_medium[medium] : EventShare());
}

core::Estimate PointResult::absorbed_fraction(core::SurfaceId surface) const {
  const bool has_events = events_at_surface.contains(surface);
  return share_of(absorbed_at_surface.contains(surface) ? absorbed_at_surface[surface] : 0,
                  has_events ? events_at_surface[surface] : EventShare());
}

core::Estimate PointResult::detected_fraction(const SensorFaceCount& at) const {
  const core::Estimate share = share_of(at.detected, at.events_detected);
  return {birth_efficiency * share.value, birth_efficiency * share.error};
}

core::Estimate PointResult::not_detected_fraction(const SensorFaceCount& at) const {
  const core::Estimate share = not_detected_fraction(at.not_detected, at.detected);
  if (event_fates.events < 2 || at.events_detected.squares + at.events_not_detected.squares == 0)
    return share;
  // Of each event the photons that are not detected, and of those detected the part that represents such.
  const double weight = 1.0 - birth_efficiency;
  const double squares = static_cast<double>(at.events_not_detected.squares) +
                         2.0 * weight * static_cast<double>(at.events_both) +
                         weight * weight * static_cast<double>(at.events_detected.squares);
  const double products = static_cast<double>(at.events_not_detected.products) +
                          weight * static_cast<double>(at.events_detected.products);
  const double residual =
      squares - 2.0 * share.value * products + share.value * share.value * event_fates.photon_squares();
  const double error = ratio_error(residual, event_fates.events, static_cast<double>(photons));
  return {share.value, share.value == 0.0 ? std::max(error, share.error) : error};
}

bool UntilResult::ended() const {
  return std::any_of(conditions.begin(), conditions.end(),
                     [](const UntilCondition& condition) { return condition.met; });
}

bool UntilResult::is_reproducible() const {
  return std::none_of(conditions.begin(), conditions.end(), [](const UntilCondition& condition) {
    return condition.met && condition.quantity == "wall_time";
  });
}

void EventFates::add(const std::array<std::uint64_t, core::kFateCount>& fates) {
  std::uint64_t photons = 0;
  for (const std::uint64_t count : fates) photons += count;
  if (photons == 0) return;
  ++events;
  for (std::size_t i = 0; i < fates.size(); ++i)
    for (std::size_t k = 0; k < fates.size(); ++k) products[i][k] += fates[i] * fates[k];
}

EventFates& EventFates::operator+=(const EventFates& other) {
  events += other.events;
  for (std::size_t i = 0; i < products.size(); ++i)
    for (std::size_t k = 0; k < products.size(); ++k) products[i][k] += other.products[i][k];
  return *this;
}

double EventFates::photon_squares() const {
  double sum = 0.0;
  for (const auto& row : products)
    for (const std::uint64_t product : row) sum += static_cast<double>(product);
  return sum;
}

EventCounts PointResult::event_counts() const {
  if (event_fates.events == 0) return {};
  return {std::max(energy.events, event_fates.events), event_fates.events, event_fates.photon_squares()};
}

core::Estimate PointResult::fraction(core::Fate fate) const {
  core::Estimate share = core::binomial_estimate(count(fate), photons);
  if (fate == core::Fate::detected) share = detected_fraction(count(fate));
  if (fate == core::Fate::not_detected)
    share = not_detected_fraction(count(fate), count(core::Fate::detected));
  if (event_fates.events < 2 || photons == 0) return share;
  // The share is the ratio of two sums over the events, of the weights of their photons and of the photons.
  std::array<double, core::kFateCount> weights{};
  weights[core::fate_index(fate)] = fate == core::Fate::detected ? birth_efficiency : 1.0;
  if (fate == core::Fate::not_detected)
    weights[core::fate_index(core::Fate::detected)] = 1.0 - birth_efficiency;
  double residual = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (std::size_t k = 0; k < weights.size(); ++k)
      residual += (weights[i] - share.value) * (weights[k] - share.value) *
                  static_cast<double>(event_fates.products[i][k]);
  const double n = static_cast<double>(photons);
  const bool none_or_all = count(fate) == 0 || count(fate) == photons;
  const double error = ratio_error(residual, event_fates.events, n);
  return {share.value, none_or_all ? std::max(error, share.error) : error};
}

double PointResult::cut_bias_bound() const {
  if (photons == 0) return 0.0;
  const std::uint64_t cut = count(core::Fate::cut_interactions) + count(core::Fate::cut_time);
  return static_cast<double>(cut) / static_cast<double>(photons);
}

bool RunResult::traced_photons() const {
  return std::any_of(points.begin(), points.end(),
                     [](const PointResult& point) { return point.photons > 0; });
}

bool RunResult::complete() const {
  return partial_reason.empty() && !points.empty() &&
         std::all_of(points.begin(), points.end(), [](const PointResult& point) { return point.complete; });
}

}  // namespace scintray::tally
