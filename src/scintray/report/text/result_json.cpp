#include "scintray/report/text/result_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scintray/analysis/analysis_fields.hpp"
#include "scintray/analysis/light_analysis.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/report/acceptance.hpp"
#include "scintray/report/text/detail/json_text.hpp"
#include "scintray/report/text/omissions.hpp"
#include "scintray/report/text/sweep_view.hpp"
#include "scintray/scene_file/tally.hpp"

namespace scintray::report {

namespace {

using Json = nlohmann::ordered_json;

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json estimate_json(const core::Estimate& estimate) {
  return {{"value", number_json(estimate.value)}, {"error", number_json(estimate.error)}};
}

Json numbers_json(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number_json(value));
  return list;
}

/// Photons of one kind, and their share of the emitted ones.
Json photons_json(std::uint64_t photons, const core::Estimate& share) {
  return {{"photons", photons}, {"fraction", number_json(share.value)}, {"error", number_json(share.error)}};
}

/// Fields of an analysis as members of objects.
class JsonSink : public analysis::FieldSink {
 public:
  explicit JsonSink(Json& root) : open_{&root} {}

  void begin_group(const std::string& name, const std::string& /*description*/) override {
    open_.push_back(&((*open_.back())[name] = Json::object()));
  }
  void end_group() override { open_.pop_back(); }
  void number(const analysis::FieldMeaning& field, double value) override { set(field, number_json(value)); }
  void count(const analysis::FieldMeaning& field, std::int64_t value) override { set(field, value); }
  void text(const analysis::FieldMeaning& field, const std::string& value) override { set(field, value); }
  void numbers(const analysis::FieldMeaning& field, const std::vector<double>& values) override {
    set(field, numbers_json(values));
  }
  void counts(const analysis::FieldMeaning& field, const std::vector<std::int64_t>& values) override {
    set(field, values);
  }
  void texts(const analysis::FieldMeaning& field, const std::vector<std::string>& values) override {
    set(field, values);
  }

 private:
  void set(const analysis::FieldMeaning& field, Json value) {
    (*open_.back())[field.name] = std::move(value);
  }

  std::vector<Json*> open_;  ///< objects from the outermost to the one that is being filled
};

Json omitted_json(const std::optional<std::vector<tally::OmittedEffect>>& effects) {
  if (!effects) return nullptr;
  Json list = Json::array();
  for (const tally::OmittedEffect& effect : *effects) {
    Json figures = Json::array();
    if (effect.in_resolution) figures.push_back(figure_name(Figure::resolution));
    if (effect.in_timing) figures.push_back(figure_name(Figure::timing));
    if (effect.in_fraction) figures.push_back(figure_name(Figure::fraction));
    list.push_back({{"effect", effect.effect},
                    {"subject", effect.subject},
                    {"changes", figures},
                    {"remedy", effect.remedy}});
  }
  return list;
}

Json fates_json(const tally::PointResult& point) {
  Json fates = Json::object();
  for (int i = 0; i < core::kFateCount; ++i) {
    const core::Fate fate = core::fate_at(i);
    fates[core::fate_name(fate)] = photons_json(point.count(fate), point.fraction(fate));
  }
  return fates;
}

Json energy_json(const tally::EnergyBalance& energy) {
  return {{"events", energy.events},
          {"silent", energy.silent},
          {"started_keV", number_json(energy.started)},
          {"deposited_keV", number_json(energy.deposited)},
          {"escaped_keV", number_json(energy.escaped)},
          {"non_scintillating_keV", number_json(energy.non_scintillating)},
          {"detected_per_event", estimate_json(energy.detected.mean())}};
}

Json until_json(const tally::UntilResult& until) {
  Json conditions = Json::array();
  for (const tally::UntilCondition& condition : until.conditions)
    conditions.push_back({{"condition", condition.quantity},
                          {"goal", number_json(condition.goal)},
                          {"reached", number_json(condition.reached)},
                          {"met", condition.met}});
  Json json = {
      {"ended", until.ended()}, {"reproducible", until.is_reproducible()}, {"conditions", conditions}};
  if (until.of.empty()) {
    json["share_of"] = core::fate_name(until.fate);
  } else {
    json["error_of"] = until.of;
    json["absolute_error_unit"] = until.unit;
  }
  return json;
}

Json sensors_json(const tally::RunResult& run, const tally::PointResult& point) {
  Json sensors = Json::array();
  for (const tally::SensorFaceCount& count : point.sensor_faces)
    sensors.push_back({{"sensor", run.header.parts.at(count.part)},
                       {"face", run.header.faces.at(count.face)},
                       {"detected", count.detected},
                       {"not_detected", count.not_detected}});
  return sensors;
}

template <typename Id>
Json absorbed_json(const tally::PointResult& point, const core::IdVector<Id, std::string>& names,
                   const core::IdVector<Id, std::uint64_t>& counts) {
  Json absorbed = Json::object();
  for (std::uint32_t i = 0; i < counts.size(); ++i)
    absorbed[names[Id(i)]] = photons_json(counts[Id(i)], point.absorbed_fraction(Id(i)));
  return absorbed;
}

Json axis_json(const tally::TallyAxis& axis) {
  Json json = {{"variable", axis.variable}, {"unit", axis.unit}};
  if (axis.names.empty())
    json["edges"] = numbers_json(axis.edges);
  else
    json["names"] = axis.names;
  return json;
}

/// What is computed from all bins of a tally together; nothing where nothing was counted.
void add_derived(const tally::TallyResult& tally, Json& json) {
  if (std::all_of(tally.sum.begin(), tally.sum.end(), [](double sum) { return sum == 0.0; })) return;
  const auto is_position = [](const tally::TallyAxis& axis) { return axis.variable == "position"; };
  if (tally.type == "etendue" && tally.index > 0.0) {
    try {
      json["etendue_mm2_sr"] = estimate_json(analysis::read_etendue(tally).filled_mm2_sr);
    } catch (const core::InputError& error) {
      json["etendue_not_available"] = error.problems().front().what;
    }
  } else if (tally.axes.size() == 2 && is_position(tally.axes[0]) && is_position(tally.axes[1])) {
    const analysis::LightSpread spread = analysis::light_spread(tally);
    json["light_spread"] = {
        {"centre_mm", numbers_json({spread.centre_mm[0], spread.centre_mm[1]})},
        {"centre_error_mm", numbers_json({spread.centre_error_mm[0], spread.centre_error_mm[1]})},
        {"rms_mm", numbers_json({spread.rms_mm[0], spread.rms_mm[1]})},
        {"fwhm_mm", numbers_json({spread.fwhm_mm[0], spread.fwhm_mm[1]})}};
  }
}

Json tally_json(const tally::PointResult& point, const tally::TallyResult& tally) {
  Json axes = Json::array();
  for (const tally::TallyAxis& axis : tally.axes) axes.push_back(axis_json(axis));
  std::vector<double> errors;
  for (std::size_t bin = 0; bin < tally.sum.size(); ++bin)
    errors.push_back(tally.at(bin, point.photons).error);
  Json json = {{"name", tally.name},
               {"type", tally.type},
               {"score", tally.score},
               {"unit", tally.unit},
               {"axes", axes},
               {"sum", numbers_json(tally.sum)},
               {"error", numbers_json(errors)},
               {"outside", number_json(tally.outside)}};
  add_derived(tally, json);
  return json;
}

/// Crossings of a face in equal bins of 0 to 90 deg, and the angles that contain them.
Json crossings_json(const std::vector<std::uint64_t>& counts, const std::vector<double>& groups) {
  const analysis::Divergence divergence = analysis::divergence(counts, groups);
  std::vector<double> edges;
  for (std::size_t i = 0; i <= counts.size(); ++i)
    edges.push_back(0.5 * core::kPi * static_cast<double>(i) / static_cast<double>(counts.size()));
  return {{"half_rad", estimate_json(divergence.half_rad)},
          {"ninety_rad", estimate_json(divergence.ninety_rad)},
          {"mean_cosine", estimate_json(divergence.mean_cosine)},
          {"edges_rad", numbers_json(edges)},
          {"counts", counts}};
}

Json exit_angles_json(const tally::PointResult& point) {
  Json list = Json::array();
  for (const analysis::CrossingAngles& angles : analysis::crossing_angles(point))
    list.push_back({{"name", angles.name},
                    {"face", angles.face},
                    {"detected_only", angles.detected_only},
                    {"inside", crossings_json(angles.inside, angles.inside_groups)},
                    {"outside", crossings_json(angles.outside, angles.outside_groups)}});
  return list;
}

void add_light(const tally::RunResult& run, const tally::PointResult& point, Json& json) {
  json["absorbed_in_medium"] = absorbed_json(point, run.header.media, point.absorbed_in_medium);
  json["absorbed_at_surface"] = absorbed_json(point, run.header.surfaces, point.absorbed_at_surface);
  json["interactions"] = estimate_json(point.interactions.mean());
  json["detected_interactions"] = estimate_json(point.detected_interactions.mean());
  json["detected_path_mm"] = estimate_json(point.detected_path_mm.mean());
  json["detected_time_ns"] = estimate_json(point.detected_time_ns.mean());
  json["tallies"] = Json::array();
  for (const tally::TallyResult& tally : point.tallies)
    if (tally.type != scene_file::kExitAngle && tally.type != scene_file::kExitAngleBeyond)
      json["tallies"].push_back(tally_json(point, tally));
  json["exit_angles"] = exit_angles_json(point);
}

Json criteria_json(const std::vector<Evaluation>& evaluations) {
  Json list = Json::array();
  for (const Evaluation& evaluation : evaluations) {
    const scene_file::CriterionSpec& criterion = evaluation.criterion;
    const auto bound = [](const std::optional<double>& limit) {
      return limit ? number_json(*limit) : Json(nullptr);
    };
    Json json = {{"claim", criterion.text},
                 {"at_least", bound(criterion.at_least)},
                 {"at_most", bound(criterion.at_most)},
                 {"published", criterion.published}};
    if (evaluation.not_available.empty()) {
      json["value"] = number_json(evaluation.ours.value);
      json["error"] = number_json(evaluation.ours.error);
      json["agrees"] = evaluation.agrees;
      json["certain"] = evaluation.certain;
    } else {
      json["not_available"] = evaluation.not_available;
    }
    list.push_back(std::move(json));
  }
  return list;
}

Json point_json(const tally::RunResult& run, const tally::PointResult& point) {
  Json parameters = Json::object();
  for (std::size_t i = 0; i < run.header.sweep_keys.size(); ++i)
    parameters[run.header.sweep_keys[i]] = point.parameters.at(i);
  Json json = {{"parameters", parameters}, {"complete", point.complete}};
  if (run.traced_photons()) {
    json["photons"] = point.emitted;
    json["photons_traced"] = point.photons;
    json["birth_efficiency"] = point.birth_efficiency;
    json["lost"] = point.lost;
    json["cut_bias_bound"] = number_json(point.cut_bias_bound());
    json["fates"] = fates_json(point);
    json["sensors"] = sensors_json(run, point);
    add_light(run, point, json);
  }
  json["not_included"] = omitted_json(point.omitted);
  if (point.until) json["until"] = until_json(*point.until);
  if (point.energy.events_requested > 0) json["energy"] = energy_json(point.energy);
  return json;
}

}  // namespace

std::string result_json(const tally::RunResult& run, const RunAnalysis& analyses) {
  const tally::RunHeader& header = run.header;
  Json json = {{"title", header.title},      {"scintray", header.version},
               {"scene", header.scene_file}, {"seed", header.seed},
               {"complete", run.complete()}, {"partial_reason", run.partial_reason},
               {"warnings", header.note},    {"points", Json::array()}};
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    Json point = point_json(run, run.points[i]);
    if (i < analyses.points.size()) {
      JsonSink sink(point["analysis"] = Json::object());
      analysis::list_fields(analyses.points[i], header.parts, sink);
    }
    json["points"].push_back(std::move(point));
  }
  if (!analyses.criteria.empty()) json["claims"] = criteria_json(evaluate(run, analyses));
  return json_text(json) + "\n";
}

std::string omissions_json(const std::optional<std::vector<tally::OmittedEffect>>& effects) {
  return json_text(omitted_json(effects));
}

}  // namespace scintray::report
