#include "scintray/report/acceptance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/plots/detail/light_curves.hpp"
#include "scintray/report/surface_acceptance.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/sweep_view.hpp"

namespace scintray::report {

namespace {

/// Distance of a value from a bound, in standard errors, from which the evaluation counts as certain.
constexpr double kCertain = 2.0;

core::Estimate ratio_of(const core::Estimate& a, const core::Estimate& b) {
  const double r = a.value / b.value;
  return {r, std::abs(r) * std::hypot(a.error / a.value, b.error / b.value)};
}

const SweepSeries& named_series(const SweepView& view, const config::NameRef& name) {
  std::vector<std::string> labels;
  for (const SweepSeries& one : view.series) {
    if (one.label == name.name) return one;
    labels.push_back(one.label);
  }
  throw core::unknown_name(name.where, "curve", name.name, labels);
}

/// A value that is not available in the run.
struct NotAvailable {
  std::string why;
};

class CurveEvaluator {
 public:
  CurveEvaluator(const tally::RunResult& run, const std::vector<analysis::EventAnalysis>& analyses,
                 const SweepView& view)
      : run_(run), analyses_(analyses), view_(view) {}

  core::Estimate value(const scene_file::CriterionSpec& criterion) const {
    const SweepSeries& curve = series(criterion.curve);
    switch (criterion.quantity) {
      case scene_file::CriterionQuantity::range:
        return range(curve);
      case scene_file::CriterionQuantity::fall:
        return fall(curve);
      case scene_file::CriterionQuantity::fall_difference: {
        const core::Estimate a = fall(curve), b = fall(series(criterion.over));
        return {a.value - b.value, std::hypot(a.error, b.error)};
      }
      case scene_file::CriterionQuantity::light:
        return light(curve.points.front());
      case scene_file::CriterionQuantity::maximum_ratio:
        return ratio_of(maximum(curve), maximum(series(criterion.over)));
      case scene_file::CriterionQuantity::resolution:
        return resolution(curve);
      case scene_file::CriterionQuantity::time_ratio:
        return {time_per_photon(curve) / time_per_photon(series(criterion.over)), 0.0};
      default:
        throw core::InternalError("a criterion about a surface was evaluated as one about curves");
    }
  }

 private:
  const SweepSeries& series(const config::NameRef& name) const { return named_series(view_, name); }

  core::Estimate light(std::size_t point) const {
    return analyses_.empty() ? run_.points[point].fraction(core::Fate::detected) : light_of(analyses_[point]);
  }

  std::vector<core::Estimate> lights(const SweepSeries& curve) const {
    std::vector<core::Estimate> values;
    for (const std::size_t point : curve.points) values.push_back(light(point));
    return values;
  }

  core::Estimate maximum(const SweepSeries& curve) const {
    const std::vector<core::Estimate> values = lights(curve);
    return *std::max_element(
        values.begin(), values.end(),
        [](const core::Estimate& a, const core::Estimate& b) { return a.value < b.value; });
  }

  core::Estimate range(const SweepSeries& curve) const {
    const std::vector<core::Estimate> values = lights(curve);
    const auto [low, high] = std::minmax_element(
        values.begin(), values.end(),
        [](const core::Estimate& a, const core::Estimate& b) { return a.value < b.value; });
    double mean = 0.0;
    for (const core::Estimate& one : values) mean += one.value / static_cast<double>(values.size());
    return {(high->value - low->value) / mean, std::hypot(high->error, low->error) / mean};
  }

  core::Estimate fall(const SweepSeries& curve) const {
    const core::Estimate kept = ratio_of(light(curve.points.back()), light(curve.points.front()));
    return {1.0 - kept.value, kept.error};
  }

  core::Estimate resolution(const SweepSeries& curve) const {
    const std::size_t point = curve.points.front();
    if (analyses_.empty()) throw NotAvailable{"a run of photons has no photopeak"};
    if (!analyses_[point].peak.has_numbers()) throw NotAvailable{analyses_[point].peak.reason};
    return analyses_[point].peak.fit.relative_fwhm;
  }

  double time_per_photon(const SweepSeries& curve) const {
    double seconds = 0.0, photons = 0.0;
    for (const std::size_t point : curve.points) {
      seconds += run_.points[point].wall_seconds;
      photons += static_cast<double>(run_.points[point].photons);
    }
    return seconds / photons;
  }

  const tally::RunResult& run_;
  const std::vector<analysis::EventAnalysis>& analyses_;
  const SweepView& view_;
};

bool within(const scene_file::CriterionSpec& criterion, double value) {
  return (!criterion.at_least || value >= *criterion.at_least) &&
         (!criterion.at_most || value <= *criterion.at_most);
}

/// A number as it is printed, angles in deg.
std::string number_of(const scene_file::CriterionSpec& criterion, double value) {
  return scene_file::is_angle(criterion.quantity) ? compact(value / core::kDegree, 4) + " deg"
                                                  : compact(value, 4);
}

std::string bounds(const scene_file::CriterionSpec& criterion) {
  if (criterion.at_least && criterion.at_most)
    return number_of(criterion, *criterion.at_least) + " to " + number_of(criterion, *criterion.at_most);
  return criterion.at_least ? "at least " + number_of(criterion, *criterion.at_least)
                            : "at most " + number_of(criterion, *criterion.at_most);
}

bool is_about_curves(const scene_file::CriterionSpec& criterion) {
  return !scene_file::is_of_surface(criterion.quantity);
}

Evaluation evaluation_of(const scene_file::CriterionSpec& criterion, const core::Estimate& ours) {
  Evaluation evaluation{criterion, {}, ours, within(criterion, ours.value), false};
  const double margin = kCertain * ours.error;
  evaluation.certain = within(criterion, ours.value - margin) == evaluation.agrees &&
                       within(criterion, ours.value + margin) == evaluation.agrees;
  return evaluation;
}

SweepView view_of(const tally::RunResult& run, const core::FileLocation& where) {
  auto view = view_sweep(run);
  if (!view)
    throw core::InputError(
        {where,
         "acceptance criteria and a reference are about curves, but this scene has no sweep over a number",
         "sweep one, as source.region.slab_z.center"});
  return std::move(*view);
}

std::string ours(const Evaluation& evaluation) {
  if (!evaluation.not_available.empty()) return evaluation.not_available;
  if (!(evaluation.ours.error > 0.0)) return number_of(evaluation.criterion, evaluation.ours.value);
  if (!scene_file::is_angle(evaluation.criterion.quantity)) return with_error(evaluation.ours);
  return with_error({evaluation.ours.value / core::kDegree, evaluation.ours.error / core::kDegree}) + " deg";
}

std::string words(const Evaluation& evaluation) {
  if (!evaluation.not_available.empty()) return "not available";
  return std::string(evaluation.agrees ? "agrees" : "differs") +
         (evaluation.certain ? "" : ", within two errors of the bound");
}

std::string subject(const scene_file::CriterionSpec& criterion) {
  if (scene_file::is_of_surface(criterion.quantity))
    return criterion.surface.name + " to " + criterion.outside.name + " at " +
           compact(criterion.incidence_rad / core::kDegree, 4) + " deg";
  return criterion.curve.name + (criterion.over.empty() ? "" : " over " + criterion.over.name);
}

}  // namespace

void check_curves(const tally::RunResult& run, const config::NameRef& reference,
                  const std::vector<scene_file::CriterionSpec>& criteria) {
  const auto about_curves = std::find_if(criteria.begin(), criteria.end(), is_about_curves);
  if (about_curves == criteria.end() && reference.empty()) return;
  core::Problems problems;
  const SweepView view = view_of(run, about_curves == criteria.end() ? reference.where : about_curves->where);
  const auto check = [&](const config::NameRef& name) {
    try {
      if (!name.empty()) named_series(view, name);
    } catch (const core::InputError& error) {
      problems.add(error);
    }
  };
  check(reference);
  for (const scene_file::CriterionSpec& criterion : criteria) {
    check(criterion.curve);
    check(criterion.over);
  }
  problems.throw_if_any();
}

std::vector<Evaluation> evaluate(const tally::RunResult& run, const RunAnalysis& analyses) {
  std::vector<Evaluation> evaluations;
  if (run.points.empty()) return evaluations;
  const auto about_curves = std::find_if(analyses.criteria.begin(), analyses.criteria.end(), is_about_curves);
  std::optional<SweepView> view;
  if (about_curves != analyses.criteria.end()) view = view_of(run, about_curves->where);
  for (const scene_file::CriterionSpec& criterion : analyses.criteria) {
    try {
      evaluations.push_back(evaluation_of(
          criterion, is_about_curves(criterion) ? CurveEvaluator(run, analyses.points, *view).value(criterion)
                                                : surface_value(criterion, analyses.surfaces)));
    } catch (const NotAvailable& not_available) {
      evaluations.push_back({criterion, not_available.why, {}, false, false});
    }
  }
  return evaluations;
}

std::string criterion_section(const std::vector<Evaluation>& evaluations) {
  if (evaluations.empty()) return "";
  std::string rows;
  for (const Evaluation& evaluation : evaluations)
    rows += "<tr>" + cell(evaluation.criterion.text, "th") + cell(subject(evaluation.criterion)) +
            cell(evaluation.criterion.published) + cell(bounds(evaluation.criterion)) +
            cell(ours(evaluation)) + cell(words(evaluation)) + cell(evaluation.criterion.note) + "</tr>\n";
  return section(
      "What was expected",
      "<div class=\"claims\">" +
          table({"criterion", "of", "published", "expected here", "ours", "evaluation", "note"}, rows, 7) +
          "</div>\n");
}

std::string criterion_lines(const std::vector<Evaluation>& evaluations) {
  std::string lines;
  for (const Evaluation& evaluation : evaluations)
    lines += (!evaluation.not_available.empty() ? "NOT AVAILABLE "
              : evaluation.agrees               ? "agrees   "
                                                : "DIFFERS  ") +
             evaluation.criterion.text + " [" + subject(evaluation.criterion) + "]: " + ours(evaluation) +
             " (expected " + bounds(evaluation.criterion) +
             (evaluation.criterion.published.empty() ? "" : "; published " + evaluation.criterion.published) +
             ")\n";
  return lines;
}

}  // namespace scintray::report
