#include "scintray/report/text/result_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "scintray/analysis/analysis_fields.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/report/text/omissions.hpp"
#include "scintray/report/text/sweep_view.hpp"

namespace scintray::report {

namespace {

using Json = nlohmann::ordered_json;

std::string json_dump(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace); }

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json estimate_json(const core::Estimate& estimate) {
  return {{"value", number_json(estimate.value)}, {"error", number_json(estimate.error)}};
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
    Json list = Json::array();
    for (const double value : values) list.push_back(number_json(value));
    set(field, std::move(list));
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
    const core::Estimate fraction = point.fraction(fate);
    fates[core::fate_name(fate)] = {{"photons", point.count(fate)},
                                    {"fraction", number_json(fraction.value)},
                                    {"error", number_json(fraction.error)}};
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
  return json_dump(json) + "\n";
}

std::string omissions_json(const std::optional<std::vector<tally::OmittedEffect>>& effects) {
  return json_dump(omitted_json(effects));
}

}  // namespace scintray::report
