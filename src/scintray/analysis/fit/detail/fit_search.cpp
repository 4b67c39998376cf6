#include "scintray/analysis/fit/detail/fit_search.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "scintray/analysis/fit/detail/gsl_errors.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::analysis {

namespace {

using Eigen::Index;

/// Expected decrease of chi-square at which the search ends: parameters are then within a third of their
/// error.
constexpr double kRest = 0.1;
/// The same for the estimate, within which the curve is treated as linear, and its upper limit.
constexpr double kStraight = 1.0, kMostStraight = 9.0;
/// Difference spans, as shares of the range of a parameter.
constexpr double kFirstSpan = 0.05, kLeastSpan = 1e-4, kMostSpan = 0.15;
/// Target noise of a difference, relative to the difference, and the limit of its widening for that.
constexpr double kWantedNoise = 0.1, kMostWider = 5.0;
constexpr int kMostEstimates = 4, kMostRounds = 4;
/// Noise of the slopes that errors may have, as noise_share_of, and the number of sets of random numbers that
/// are used to reach it.
constexpr double kNoiseOfErrors = 0.02;
constexpr std::uint64_t kMostDraws = 5;
/// Number of shorter steps that GSL may try before the search for a decrease is abandoned.
constexpr int kMostTrials = 6;
/// Number of values that a parameter can have between its bounds, so that the conversion to the internal
/// variable and back does not change a curve by rounding.
constexpr double kGrid = 0x1.0p40;
/// Relative change of the errors below which no new search is needed.
constexpr double kSameErrors = 0.05;
/// Initial common error, relative to the root mean square of the values.
constexpr double kFirstCommonError = 0.05;

struct FreeWorkspace {
  void operator()(gsl_multifit_nlinear_workspace* w) const { gsl_multifit_nlinear_free(w); }
};

double root_mean_square(const MeasuredCurve& measured) {
  double sum = 0.0;
  for (const MeasuredCurve::Point& point : measured.points) sum += point.y.value * point.y.value;
  return std::sqrt(sum / static_cast<double>(measured.points.size()));
}

/// Updates a mean of `count` independent curves to one of `count + 1`.
void add_to_mean(ModelCurve& mean, const ModelCurve& other, std::uint64_t count) {
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; i < mean.size(); ++i) {
    core::Estimate& value = mean[i].value;
    value.error = std::hypot(n * value.error, other[i].value.error) / (n + 1.0);
    value.value = (n * value.value + other[i].value.value) / (n + 1.0);
    // Shares are equal, so those of all curves are parts of their mean.
    mean[i].parts.insert(mean[i].parts.end(), other[i].parts.begin(), other[i].parts.end());
  }
}

}  // namespace

/// Functions of the search for GSL.
struct GslFunctions {
  static int residuals(const gsl_vector* x, void* data, gsl_vector* out) {
    FitSearch& search = *static_cast<FitSearch*>(data);
    if (++search.trials_ > kMostTrials) return GSL_EFAILED;
    const auto curve = search.evaluate(search.outer(x->data));
    if (!curve) return GSL_EFAILED;
    const Eigen::VectorXd values = search.residuals_.of(*curve);
    for (Index i = 0; i < values.size(); ++i) gsl_vector_set(out, static_cast<std::size_t>(i), values[i]);
    return GSL_SUCCESS;
  }

  static int slopes(const gsl_vector* x, void* data, gsl_matrix* out) {
    FitSearch& search = *static_cast<FitSearch*>(data);
    const std::vector<double> at = search.outer(x->data);
    if (!search.find_slopes(at)) return GSL_EFAILED;
    for (std::size_t j = 0; j < at.size(); ++j)
      for (std::size_t i = 0; i < out->size1; ++i)
        gsl_matrix_set(out, i, j,
                       search.slopes_->slope(static_cast<Index>(i), static_cast<Index>(j)) *
                           search.inner_slope(j, at[j]));
    return GSL_SUCCESS;
  }
};

FitSearch::FitSearch(const MeasuredCurve& measured, const std::vector<FitParameter>& parameters,
                     const CurveModel& model, const CurveFitOptions& options)
    : parameters_(parameters),
      model_(model),
      options_(options),
      residuals_(measured, options.free_scale),
      wider_(parameters.size(), 1.0) {
  for (const FitParameter& parameter : parameters) {
    best_.push_back(snapped(best_.size(), parameter.start));
    span_.push_back(kFirstSpan * (parameter.high - parameter.low));
  }
  if (options.errors_from_scatter) {
    common_error_ = kFirstCommonError * root_mean_square(measured);
    residuals_.set_common_error(*common_error_);
  }
}

Eigen::VectorXd FitSearch::range() const {
  Eigen::VectorXd range(static_cast<Index>(parameters_.size()));
  for (std::size_t j = 0; j < parameters_.size(); ++j)
    range[static_cast<Index>(j)] = parameters_[j].high - parameters_[j].low;
  return range;
}

double FitSearch::degrees() const {
  return static_cast<double>(residuals_.size()) - static_cast<double>(parameters_.size()) -
         (options_.free_scale ? 1.0 : 0.0);
}

double FitSearch::inner(std::size_t parameter, double value) const {
  const FitParameter& p = parameters_[parameter];
  return std::asin(std::clamp(2.0 * (value - p.low) / (p.high - p.low) - 1.0, -1.0, 1.0));
}

double FitSearch::inner_slope(std::size_t parameter, double value) const {
  const FitParameter& p = parameters_[parameter];
  return 0.5 * (p.high - p.low) * std::cos(inner(parameter, value));
}

double FitSearch::snapped(std::size_t parameter, double value) const {
  const FitParameter& p = parameters_[parameter];
  const double share = std::clamp((value - p.low) / (p.high - p.low), 0.0, 1.0);
  return p.low + (p.high - p.low) * (std::round(share * kGrid) / kGrid);
}

std::vector<double> FitSearch::outer(const double* inner) const {
  std::vector<double> values;
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    const FitParameter& p = parameters_[j];
    values.push_back(snapped(j, p.low + 0.5 * (p.high - p.low) * (1.0 + std::sin(inner[j]))));
  }
  return values;
}

std::optional<ModelCurve> FitSearch::evaluate(const std::vector<double>& at) {
  if (const auto found = known_.find(at); found != known_.end()) return found->second;
  const std::optional<ModelCurve> curve = trace(at, draw_);
  if (curve) known_.emplace(at, *curve);
  return curve;
}

std::optional<ModelCurve> FitSearch::trace(const std::vector<double>& at, std::uint64_t draw) {
  if (stopped_) return std::nullopt;
  std::optional<ModelCurve> curve = model_(at, draw);
  if (!curve) {
    stopped_ = true;
    return std::nullopt;
  }
  if (curve->size() != residuals_.size())
    throw std::invalid_argument("the model returns another number of points than were measured");
  ++evaluations_;
  return curve;
}

bool FitSearch::find_slopes(const std::vector<double>& at) {
  if (at != slopes_at_ && slopes_) choose_spans();
  const std::optional<ModelCurve> centre = evaluate(at);
  std::vector<DifferencePair> pairs;
  for (std::size_t j = 0; j < at.size(); ++j) {
    const auto [low, high] = sides_of(at, j);
    const auto below = evaluate(low), above = evaluate(high);
    if (!centre || !below || !above) return false;
    pairs.push_back({*below, *above, high[j] - low[j]});
  }
  slopes_at_ = at;
  set_slopes(*centre, std::move(pairs));
  return true;
}

std::array<std::vector<double>, 2> FitSearch::sides_of(const std::vector<double>& at, std::size_t j) const {
  std::vector<double> low = at, high = at;
  low[j] = snapped(j, at[j] - span_[j]);
  high[j] = snapped(j, at[j] + span_[j]);
  return {low, high};
}

void FitSearch::set_slopes(const ModelCurve& centre, std::vector<DifferencePair> pairs) {
  slopes_ = slopes_of(residuals_, centre, pairs);
  pairs_ = std::move(pairs);
  scale_slopes_.resize(static_cast<Index>(pairs_.size()));
  for (std::size_t j = 0; j < pairs_.size(); ++j)
    scale_slopes_[static_cast<Index>(j)] =
        (residuals_.scale(pairs_[j].high) - residuals_.scale(pairs_[j].low)) / pairs_[j].span;
}

/// The inverse of an information that is known with noise is larger on average, and so would be the errors:
/// differences are repeated with other random numbers, and averaged, until little of that is left.
bool FitSearch::repeat_slopes() {
  const std::vector<double>& at = slopes_at_;
  for (std::uint64_t repeated = 1;
       repeated < kMostDraws && noise_share_of(*slopes_, range()).maxCoeff() > kNoiseOfErrors; ++repeated) {
    std::vector<DifferencePair> pairs = pairs_;
    for (std::size_t j = 0; j < at.size(); ++j) {
      const auto [low, high] = sides_of(at, j);
      const auto below = trace(low, draw_ + repeated), above = trace(high, draw_ + repeated);
      if (!below || !above) return false;
      add_to_mean(pairs[j].low, *below, repeated);
      add_to_mean(pairs[j].high, *above, repeated);
    }
    set_slopes(*curve_, std::move(pairs));
  }
  return true;
}

/// Differences over one standard error (of each parameter alone) to each side change chi-square by one: far
/// above rounding or the loss of a photon, and small enough for a linear curve. Where photons take different
/// paths on both sides, their noise grows with the root of the distance and the difference with the distance,
/// so wider differences are more precise.
void FitSearch::choose_spans() {
  const Eigen::VectorXd noise_share = noise_share_of(*slopes_, range());
  const Eigen::MatrixXd information = information_of(*slopes_, range());
  for (std::size_t j = 0; j < span_.size(); ++j) {
    const auto k = static_cast<Index>(j);
    const double whole = parameters_[j].high - parameters_[j].low;
    const double relative = noise_share[k] / (kWantedNoise * kWantedNoise);
    wider_[j] = std::clamp(wider_[j] * std::clamp(relative, 0.5, 4.0), 1.0, kMostWider);
    span_[j] = std::clamp(wider_[j] / std::sqrt(information(k, k)), kLeastSpan * whole, kMostSpan * whole);
  }
}

FitSearch::Outlook FitSearch::outlook() const {
  const Eigen::VectorXd down = -slopes_->slope.transpose() * residuals_.of(*curve_);
  const Eigen::MatrixXd information = step_information_of(*slopes_, range());
  // A parameter at a bound that would go beyond it is fixed.
  std::vector<Index> free;
  for (std::size_t j = 0; j < best_.size(); ++j) {
    const FitParameter& p = parameters_[j];
    const double margin = kAtBound * (p.high - p.low);
    const auto k = static_cast<Index>(j);
    if ((best_[j] <= p.low + margin && down[k] < 0.0) || (best_[j] >= p.high - margin && down[k] > 0.0))
      continue;
    free.push_back(k);
  }
  Outlook outlook;
  outlook.step = Eigen::VectorXd::Zero(down.size());
  if (free.empty()) return outlook;
  const Eigen::VectorXd part = down(free);
  const Eigen::MatrixXd of_free = information(free, free);
  const Eigen::VectorXd step = of_free.ldlt().solve(part);
  outlook.step(free) = step;
  outlook.fall = part.dot(step);
  return outlook;
}

void FitSearch::report_step() {
  CurveFitStep step;
  step.number = steps_++;
  step.evaluations = evaluations_;
  step.parameters = best_;
  step.scale = residuals_.scale(*curve_);
  step.chi2 = residuals_.chi2(*curve_);
  step.estimate = draw_ > 0;
  if (options_.progress) options_.progress(step);
}

void FitSearch::accept(const std::vector<double>& at) {
  best_ = at;
  curve_ = evaluate(at);
  report_step();
}

/// Minimises by GSL's trust region, from the best point so far.
void FitSearch::descend() {
  const std::size_t count = parameters_.size();
  gsl_multifit_nlinear_parameters settings = gsl_multifit_nlinear_default_parameters();
  settings.scale = gsl_multifit_nlinear_scale_levenberg;
  const std::unique_ptr<gsl_multifit_nlinear_workspace, FreeWorkspace> work(
      gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &settings, residuals_.size(), count));
  if (!work) throw core::InternalError("GSL cannot allocate a fit");
  gsl_multifit_nlinear_fdf functions{};
  functions.f = GslFunctions::residuals;
  functions.df = GslFunctions::slopes;
  functions.n = residuals_.size();
  functions.p = count;
  functions.params = this;
  std::vector<double> inside;
  for (std::size_t j = 0; j < count; ++j) inside.push_back(inner(j, best_[j]));
  const gsl_vector_view x = gsl_vector_view_array(inside.data(), count);
  trials_ = 0;
  if (gsl_multifit_nlinear_init(&x.vector, &functions, work.get()) != GSL_SUCCESS) return;
  while (steps_ <= options_.most_steps && outlook().fall > kRest) {
    // No progress is a result, too: the remaining decrease is smaller than the noise of the curve.
    trials_ = 0;
    if (gsl_multifit_nlinear_iterate(work.get()) != GSL_SUCCESS) return;
    accept(outer(gsl_multifit_nlinear_position(work.get())->data));
  }
}

void FitSearch::update_weights() {
  if (options_.errors_from_scatter && degrees() > 0.0 && steps_ > 1)
    common_error_ = residuals_.match_common_error(*curve_, degrees());
  else
    residuals_.reweight(*curve_);
}

/// After a stop within a step: the best of all curves that were traced.
void FitSearch::accept_best_known() {
  const auto chi2_of = [&](const auto& entry) { return residuals_.chi2(entry.second); };
  const auto least = std::min_element(known_.begin(), known_.end(),
                                      [&](const auto& a, const auto& b) { return chi2_of(a) < chi2_of(b); });
  if (least != known_.end() && chi2_of(*least) < residuals_.chi2(*curve_)) accept(least->first);
}

/// The curve near the best point, extrapolated by slopes.
ModelCurve FitSearch::carried_on(const std::vector<double>& to) const {
  ModelCurve curve = *curve_;
  for (std::size_t i = 0; i < curve.size(); ++i)
    for (std::size_t j = 0; j < to.size(); ++j)
      curve[i].value.value += (pairs_[j].high[i].value.value - pairs_[j].low[i].value.value) /
                              pairs_[j].span * (to[j] - best_[j]);
  return curve;
}

/// A search converges where noise happens to agree with the measurement, so that the curve found is too good.
/// New random numbers near that point are independent of it: Newton's step with them is the estimate, and its
/// residuals are those of a fit.
bool FitSearch::estimate() {
  draw_ = 1;
  known_.clear();
  for (int i = 0; i < kMostEstimates; ++i) {
    const std::optional<ModelCurve> fresh = evaluate(best_);
    if (!fresh) return false;
    curve_ = fresh;
    if (!options_.errors_from_scatter) residuals_.reweight(*curve_);
    if (!find_slopes(best_)) return false;
    Outlook next = outlook();
    const auto is_last = [&] { return next.fall < kStraight || i + 1 == kMostEstimates; };
    if (is_last()) {
      if (!repeat_slopes()) return false;
      next = outlook();
    }
    std::vector<double> at = best_;
    for (std::size_t j = 0; j < at.size(); ++j) at[j] = snapped(j, at[j] + next.step[static_cast<Index>(j)]);
    const bool last = is_last();
    curve_ = carried_on(at);
    best_ = at;
    ++estimates_;
    if (last) update_weights();
    report_step();
    if (last) {
      converged_ = next.fall < kMostStraight;
      slopes_at_ = best_;
      return true;
    }
  }
  return true;
}

FitEnd FitSearch::run() {
  silence_gsl();
  curve_ = evaluate(best_);
  if (!curve_) return FitEnd::stopped;
  start_curve_ = *curve_;
  if (std::none_of(curve_->begin(), curve_->end(), [](const ModelPoint& p) { return p.value.value > 0.0; }))
    throw core::InputError({{},
                            "at the start there is no light at any of the measured points",
                            "start nearer to the measurement, or trace more photons"});
  update_weights();
  report_step();
  for (int round = 0; round < kMostRounds && !stopped_; ++round) {
    descend();
    const Eigen::VectorXd before = residuals_.inverse_sigma();
    update_weights();
    const Eigen::ArrayXd change = residuals_.inverse_sigma().array() / before.array() - 1.0;
    if (change.abs().maxCoeff() < kSameErrors) break;
  }
  if (stopped_) accept_best_known();
  if (!stopped_ && estimate()) return converged_ ? FitEnd::converged : FitEnd::not_converged;
  slopes_.reset();
  return FitEnd::stopped;
}

}  // namespace scintray::analysis
