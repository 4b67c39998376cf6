#include "scintray/analysis/spectrum/peak_fit.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "scintray/analysis/fit/detail/gsl_errors.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::analysis {

namespace {

constexpr std::size_t kMostParameters = 5;
constexpr std::size_t kMostSteps = 200;
constexpr std::array kBackgrounds{PeakBackground::none, PeakBackground::shoulder,
                                  PeakBackground::shoulder_and_constant};
/// Lower limit of an expectation, so that its logarithm exists.
constexpr double kLeastExpected = 1e-30;

double normal_density(double u) { return std::exp(-0.5 * u * u) / std::sqrt(core::kTwoPi); }
double upper_tail(double u) { return 0.5 * std::erfc(u / std::sqrt(2.0)); }

std::size_t parameters_of(PeakBackground background) {
  return background == PeakBackground::none ? 3 : background == PeakBackground::shoulder ? 4 : 5;
}

/// Expected counts of a bin and their derivatives by position and the logarithms of sigma, events, shoulder,
/// constant.
struct BinExpectation {
  double value = 0.0;
  std::array<double, kMostParameters> slope{};
};

/// Terms of the model at an edge of a bin, which two bins share.
struct EdgeTerms {
  double u, density, tail_above, tail_below;

  EdgeTerms(const PeakModel& model, double x)
      : u((x - model.position) / model.sigma),
        density(normal_density(u)),
        tail_above(upper_tail(u)),
        tail_below(upper_tail(-u)) {}
};

BinExpectation expectation(const PeakModel& model, const EdgeTerms& a, const EdgeTerms& b, double width) {
  // The difference of the nearer tails keeps its precision on either side of the peak.
  const double share = a.u > 0.0 ? a.tail_above - b.tail_above : b.tail_below - a.tail_below;
  const double step = model.sigma * ((b.u * b.tail_above - b.density) - (a.u * a.tail_above - a.density));
  BinExpectation bin;
  bin.value = model.events * share + model.shoulder * step + model.constant * width;
  bin.slope[0] =
      model.events * (a.density - b.density) / model.sigma + model.shoulder * (a.tail_above - b.tail_above);
  bin.slope[1] = model.events * (a.u * a.density - b.u * b.density) +
                 model.shoulder * model.sigma * (a.density - b.density);
  bin.slope[2] = model.events * share;
  bin.slope[3] = model.shoulder * step;
  bin.slope[4] = model.constant * width;
  return bin;
}

/// Calls `act` with the number and the expectation of each bin, in order.
template <typename Act>
void for_each_bin(const PeakModel& model, const Histogram& histogram, Act act) {
  EdgeTerms low(model, histogram.edge(0));
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const EdgeTerms high(model, histogram.edge(i + 1));
    act(i, expectation(model, low, high, histogram.edge(i + 1) - histogram.edge(i)));
    low = high;
  }
}

/// Positions are fitted in units of the first sigma from the first position, so that the units of the
/// spectrum do not matter.
struct Task {
  const Histogram& histogram;
  PeakBackground background;
  PeakModel start;

  PeakModel model(const gsl_vector* x) const {
    PeakModel model;
    model.position = start.position + start.sigma * gsl_vector_get(x, 0);
    model.sigma = start.sigma * std::exp(gsl_vector_get(x, 1));
    model.events = std::exp(gsl_vector_get(x, 2));
    if (background != PeakBackground::none) model.shoulder = std::exp(gsl_vector_get(x, 3));
    if (background == PeakBackground::shoulder_and_constant) model.constant = std::exp(gsl_vector_get(x, 4));
    return model;
  }
};

/// Signed root of the contribution of a bin to the deviance.
double residual(double count, double expected) {
  const double term = expected - count + (count > 0.0 ? count * std::log(count / expected) : 0.0);
  return std::copysign(std::sqrt(2.0 * std::max(0.0, term)), count - expected);
}

/// Derivative of the residual by the expectation.
double residual_slope(double count, double expected) {
  const double r = residual(count, expected);
  if (std::abs(r) < 1e-5) return -1.0 / std::sqrt(expected);
  return (1.0 - count / expected) / r;
}

bool usable(const PeakModel& model) {
  return std::isfinite(model.position) && std::isfinite(model.sigma) && std::isfinite(model.events) &&
         std::isfinite(model.shoulder) && std::isfinite(model.constant) && model.sigma > 0.0;
}

int residuals(const gsl_vector* x, void* data, gsl_vector* out) {
  const Task& task = *static_cast<const Task*>(data);
  const PeakModel model = task.model(x);
  if (!usable(model)) return GSL_EDOM;
  for_each_bin(model, task.histogram, [&](std::size_t i, const BinExpectation& bin) {
    gsl_vector_set(out, i, residual(task.histogram.counts[i], std::max(kLeastExpected, bin.value)));
  });
  return GSL_SUCCESS;
}

int jacobian(const gsl_vector* x, void* data, gsl_matrix* out) {
  const Task& task = *static_cast<const Task*>(data);
  const PeakModel model = task.model(x);
  if (!usable(model)) return GSL_EDOM;
  for_each_bin(model, task.histogram, [&](std::size_t i, const BinExpectation& bin) {
    const double slope = residual_slope(task.histogram.counts[i], std::max(kLeastExpected, bin.value));
    for (std::size_t k = 0; k < out->size2; ++k)
      gsl_matrix_set(out, i, k, slope * bin.slope[k] * (k == 0 ? task.start.sigma : 1.0));
  });
  return GSL_SUCCESS;
}

struct Free {
  void operator()(gsl_multifit_nlinear_workspace* w) const { gsl_multifit_nlinear_free(w); }
};

/// Searches from `start`; true when the search converged.
bool search(Task& task, PeakModel& found) {
  const PeakModel& start = task.start;
  const std::size_t parameters = parameters_of(task.background);
  gsl_multifit_nlinear_parameters options = gsl_multifit_nlinear_default_parameters();
  options.scale = gsl_multifit_nlinear_scale_levenberg;
  const std::unique_ptr<gsl_multifit_nlinear_workspace, Free> work(gsl_multifit_nlinear_alloc(
      gsl_multifit_nlinear_trust, &options, task.histogram.counts.size(), parameters));
  if (!work) return false;
  gsl_multifit_nlinear_fdf functions{};
  functions.f = residuals;
  functions.df = jacobian;
  functions.n = task.histogram.counts.size();
  functions.p = parameters;
  functions.params = &task;
  std::array<double, kMostParameters> values{
      0.0, 0.0, std::log(start.events), std::log(std::max(start.shoulder, 1e-6 * start.events / start.sigma)),
      std::log(std::max(start.constant, 1e-6 * start.events / start.sigma))};
  const gsl_vector_view x = gsl_vector_view_array(values.data(), parameters);
  if (gsl_multifit_nlinear_init(&x.vector, &functions, work.get()) != GSL_SUCCESS) return false;
  int why = 0;
  const int status =
      gsl_multifit_nlinear_driver(kMostSteps, 1e-9, 1e-9, 0.0, nullptr, nullptr, &why, work.get());
  found = task.model(gsl_multifit_nlinear_position(work.get()));
  // At the minimum rounding may leave no further decrease: that is convergence as well.
  return usable(found) && (status == GSL_SUCCESS || status == GSL_ENOPROG);
}

double relative_fwhm(const PeakModel& model) { return core::kFwhmPerSigma * model.sigma / model.position; }

void set_errors(const Histogram& histogram, PeakFit& fit) {
  const auto parameters = static_cast<Eigen::Index>(parameters_of(fit.background));
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(parameters, parameters);
  for_each_bin(fit.model, histogram, [&](std::size_t, const BinExpectation& bin) {
    const Eigen::Map<const Eigen::VectorXd> slope(bin.slope.data(), parameters);
    information += slope * slope.transpose() / std::max(kLeastExpected, bin.value);
  });
  // A background of zero carries no information: its row would make the matrix singular.
  for (Eigen::Index k = 0; k < parameters; ++k)
    if (information(k, k) < 1e-9) information(k, k) = 1e-9;
  const Eigen::MatrixXd covariance =
      information.ldlt().solve(Eigen::MatrixXd::Identity(parameters, parameters));
  const auto error = [&](Eigen::Index k) { return std::sqrt(std::max(0.0, covariance(k, k))); };
  const PeakModel& model = fit.model;
  fit.position = {model.position, error(0)};
  fit.sigma = {model.sigma, model.sigma * error(1)};
  fit.events = {model.events, model.events * error(2)};
  const double relative = relative_fwhm(model);
  const double variance = covariance(1, 1) + covariance(0, 0) / (model.position * model.position) -
                          2.0 * covariance(0, 1) / model.position;
  fit.relative_fwhm = {relative, std::abs(relative) * std::sqrt(std::max(0.0, variance))};
}

void set_goodness(const Histogram& histogram, PeakFit& fit) {
  std::vector<std::uint64_t> observed;
  std::vector<double> expected;
  fit.deviance = 0.0;
  for_each_bin(fit.model, histogram, [&](std::size_t i, const BinExpectation& bin) {
    observed.push_back(static_cast<std::uint64_t>(histogram.counts[i]));
    expected.push_back(std::max(kLeastExpected, bin.value));
    const double r = residual(histogram.counts[i], expected.back());
    fit.deviance += r * r;
  });
  fit.goodness = core::chi_square_test(observed, expected);
  // That test subtracts one degree for a fixed total; here the total is fitted with the rest.
  fit.goodness.degrees += 1.0 - static_cast<double>(parameters_of(fit.background));
  fit.goodness.p_value = core::chi_square_p_value(fit.goodness.chi2, fit.goodness.degrees);
}

}  // namespace

double PeakModel::density(double x) const {
  const double u = (x - position) / sigma;
  return events * normal_density(u) / sigma + shoulder * upper_tail(u) + constant;
}

double PeakModel::expected(double low, double high) const {
  return expectation(*this, EdgeTerms(*this, low), EdgeTerms(*this, high), high - low).value;
}

PeakFit fit_peak(const Histogram& histogram, const PeakModel& start, PeakBackground background) {
  silence_gsl();
  PeakFit fit;
  fit.background = background;
  fit.model = start;
  const auto filled = static_cast<std::size_t>(
      std::count_if(histogram.counts.begin(), histogram.counts.end(), [](double n) { return n > 0.0; }));
  if (filled < parameters_of(background) || !(start.sigma > 0.0) || !(start.events > 0.0)) return fit;
  Task task{histogram, background, start};
  fit.converged = search(task, fit.model);
  if (!fit.converged) return fit;
  set_errors(histogram, fit);
  set_goodness(histogram, fit);
  return fit;
}

PeakFit fit_peak(const Histogram& histogram, const PeakModel& start) {
  std::vector<PeakFit> fits;
  for (const PeakBackground background : kBackgrounds)
    if (PeakFit fit = fit_peak(histogram, start, background); fit.converged) fits.push_back(fit);
  if (fits.empty()) return {};
  const double for_a_parameter = std::log(histogram.total());
  const auto criterion = [&](const PeakFit& fit) {
    return fit.deviance + for_a_parameter * static_cast<double>(parameters_of(fit.background));
  };
  const auto best = std::min_element(
      fits.begin(), fits.end(), [&](const auto& a, const auto& b) { return criterion(a) < criterion(b); });
  std::vector<double> weights;
  double sum = 0.0;
  for (const PeakFit& fit : fits)
    sum += weights.emplace_back(std::exp(0.5 * (criterion(*best) - criterion(fit))));
  PeakFit mean = *best;
  const auto average = [&](auto of) {
    double value = 0.0;
    for (std::size_t i = 0; i < fits.size(); ++i) value += weights[i] / sum * of(fits[i]);
    return value;
  };
  mean.model = {.position = average([](const PeakFit& fit) { return fit.model.position; }),
                .sigma = average([](const PeakFit& fit) { return fit.model.sigma; }),
                .events = average([](const PeakFit& fit) { return fit.model.events; }),
                .shoulder = average([](const PeakFit& fit) { return fit.model.shoulder; }),
                .constant = average([](const PeakFit& fit) { return fit.model.constant; })};
  const auto estimate = [&](core::Estimate PeakFit::*of, double value) {
    const auto squared = [&](const PeakFit& fit) {
      const core::Estimate& one = fit.*of;
      return one.error * one.error + (one.value - value) * (one.value - value);
    };
    mean.*of = {value, std::sqrt(average(squared))};
  };
  estimate(&PeakFit::position, mean.model.position);
  estimate(&PeakFit::sigma, mean.model.sigma);
  estimate(&PeakFit::events, mean.model.events);
  estimate(&PeakFit::relative_fwhm, relative_fwhm(mean.model));
  set_goodness(histogram, mean);
  return mean;
}

}  // namespace scintray::analysis
