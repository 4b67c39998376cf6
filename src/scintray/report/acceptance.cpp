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

/// Standard errors by which a number has to miss a bound for the verdict to count as certain.
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

/// A number that the run does not have.
struct Untold {
  std::string why;
};

class CurveJudge {
 public:
  CurveJudge(const tally::RunResult& run, const std::vector<analysis::EventStudy>& studies,
             const SweepView& view)
      : run_(run), studies_(studies), view_(view) {}

  core::Estimate value(const scene_file::ClaimSpec& claim) const {
    const SweepSeries& curve = series(claim.curve);
    switch (claim.quantity) {
      case scene_file::ClaimQuantity::range:
        return range(curve);
      case scene_file::ClaimQuantity::fall:
        return fall(curve);
      case scene_file::ClaimQuantity::fall_difference: {
        const core::Estimate a = fall(curve), b = fall(series(claim.over));
        return {a.value - b.value, std::hypot(a.error, b.error)};
      }
      case scene_file::ClaimQuantity::light:
        return light(curve.points.front());
      case scene_file::ClaimQuantity::maximum_ratio:
        return ratio_of(maximum(curve), maximum(series(claim.over)));
      case scene_file::ClaimQuantity::resolution:
        return resolution(curve);
      case scene_file::ClaimQuantity::time_ratio:
        return {time_per_photon(curve) / time_per_photon(series(claim.over)), 0.0};
      default:
        throw core::InternalError("a claim about a surface is judged as one about curves");
    }
  }

 private:
  const SweepSeries& series(const config::NameRef& name) const { return named_series(view_, name); }

  core::Estimate light(std::size_t point) const {
    return studies_.empty() ? run_.points[point].fraction(core::Fate::detected) : light_of(studies_[point]);
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
    if (studies_.empty()) throw Untold{"a run of photons has no photopeak"};
    if (!studies_[point].peak.has_numbers()) throw Untold{studies_[point].peak.reason};
    return studies_[point].peak.fit.relative_fwhm;
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
  const std::vector<analysis::EventStudy>& studies_;
  const SweepView& view_;
};

bool within(const scene_file::ClaimSpec& claim, double value) {
  return (!claim.at_least || value >= *claim.at_least) && (!claim.at_most || value <= *claim.at_most);
}

/// A number as it is printed, angles in deg.
std::string number_of(const scene_file::ClaimSpec& claim, double value) {
  return scene_file::is_angle(claim.quantity) ? compact(value / core::kDegree, 4) + " deg"
                                              : compact(value, 4);
}

std::string bounds(const scene_file::ClaimSpec& claim) {
  if (claim.at_least && claim.at_most)
    return number_of(claim, *claim.at_least) + " to " + number_of(claim, *claim.at_most);
  return claim.at_least ? "at least " + number_of(claim, *claim.at_least)
                        : "at most " + number_of(claim, *claim.at_most);
}

bool is_about_curves(const scene_file::ClaimSpec& claim) {
  return !scene_file::is_of_surface(claim.quantity);
}

Verdict verdict_on(const scene_file::ClaimSpec& claim, const core::Estimate& ours) {
  Verdict verdict{claim, {}, ours, within(claim, ours.value), false};
  const double margin = kCertain * ours.error;
  verdict.certain = within(claim, ours.value - margin) == verdict.agrees &&
                    within(claim, ours.value + margin) == verdict.agrees;
  return verdict;
}

SweepView view_of(const tally::RunResult& run, const core::FileLocation& where) {
  auto view = view_sweep(run);
  if (!view)
    throw core::InputError(
        {where, "claims and a reference are about curves, but this scene has no sweep over a number",
         "sweep one, as source.region.slab_z.center"});
  return std::move(*view);
}

std::string ours(const Verdict& verdict) {
  if (!verdict.untold.empty()) return verdict.untold;
  if (!(verdict.ours.error > 0.0)) return number_of(verdict.claim, verdict.ours.value);
  if (!scene_file::is_angle(verdict.claim.quantity)) return with_error(verdict.ours);
  return with_error({verdict.ours.value / core::kDegree, verdict.ours.error / core::kDegree}) + " deg";
}

std::string words(const Verdict& verdict) {
  if (!verdict.untold.empty()) return "not told";
  return std::string(verdict.agrees ? "agrees" : "differs") +
         (verdict.certain ? "" : ", within two errors of the bound");
}

std::string subject(const scene_file::ClaimSpec& claim) {
  if (scene_file::is_of_surface(claim.quantity))
    return claim.surface.name + " to " + claim.outside.name + " at " +
           compact(claim.incidence_rad / core::kDegree, 4) + " deg";
  return claim.curve.name + (claim.over.empty() ? "" : " over " + claim.over.name);
}

}  // namespace

void check_curves(const tally::RunResult& run, const config::NameRef& reference,
                  const std::vector<scene_file::ClaimSpec>& claims) {
  const auto about_curves = std::find_if(claims.begin(), claims.end(), is_about_curves);
  if (about_curves == claims.end() && reference.empty()) return;
  core::Problems problems;
  const SweepView view = view_of(run, about_curves == claims.end() ? reference.where : about_curves->where);
  const auto check = [&](const config::NameRef& name) {
    try {
      if (!name.empty()) named_series(view, name);
    } catch (const core::InputError& error) {
      problems.add(error);
    }
  };
  check(reference);
  for (const scene_file::ClaimSpec& claim : claims) {
    check(claim.curve);
    check(claim.over);
  }
  problems.throw_if_any();
}

std::vector<Verdict> judge(const tally::RunResult& run, const RunStudies& studies) {
  std::vector<Verdict> verdicts;
  if (run.points.empty()) return verdicts;
  const auto about_curves = std::find_if(studies.claims.begin(), studies.claims.end(), is_about_curves);
  std::optional<SweepView> view;
  if (about_curves != studies.claims.end()) view = view_of(run, about_curves->where);
  for (const scene_file::ClaimSpec& claim : studies.claims) {
    try {
      verdicts.push_back(verdict_on(claim, is_about_curves(claim)
                                               ? CurveJudge(run, studies.points, *view).value(claim)
                                               : surface_value(claim, studies.surfaces)));
    } catch (const Untold& untold) {
      verdicts.push_back({claim, untold.why, {}, false, false});
    }
  }
  return verdicts;
}

std::string claim_section(const std::vector<Verdict>& verdicts) {
  if (verdicts.empty()) return "";
  std::string rows;
  for (const Verdict& verdict : verdicts)
    rows += "<tr>" + cell(verdict.claim.text, "th") + cell(subject(verdict.claim)) +
            cell(verdict.claim.published) + cell(bounds(verdict.claim)) + cell(ours(verdict)) +
            cell(words(verdict)) + cell(verdict.claim.note) + "</tr>\n";
  return section(
      "What was expected",
      "<div class=\"claims\">" +
          table({"claim", "of", "published", "expected here", "ours", "verdict", "note"}, rows, 7) +
          "</div>\n");
}

std::string claim_lines(const std::vector<Verdict>& verdicts) {
  std::string lines;
  for (const Verdict& verdict : verdicts)
    lines += (!verdict.untold.empty() ? "NOT TOLD "
              : verdict.agrees        ? "agrees   "
                                      : "DIFFERS  ") +
             verdict.claim.text + " [" + subject(verdict.claim) + "]: " + ours(verdict) + " (expected " +
             bounds(verdict.claim) +
             (verdict.claim.published.empty() ? "" : "; published " + verdict.claim.published) + ")\n";
  return lines;
}

}  // namespace scintray::report
