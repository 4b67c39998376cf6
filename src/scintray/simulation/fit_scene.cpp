#include "scintray/simulation/fit.hpp"

#include <chrono>

#include "scintray/core/named_file.hpp"
#include "scintray/core/version.hpp"

namespace scintray::simulation {

namespace {

scene_file::FitSpec fit_of(const scene_file::SceneSpec& spec) {
  if (spec.fit) return *spec.fit;
  throw core::InputError(
      {{spec.file.string()},
       "this scene has no [fit]",
       "define in [fit] the measurement and in [[fit.parameter]] the parameters (docs/fit.md)"});
}

void check_errors(const scene_file::FitSpec& spec, const analysis::MeasuredCurve& measured) {
  if (measured.has_errors && spec.errors_from_scatter)
    throw core::InputError(
        {spec.where,
         "errors = \"from_scatter\", but " + spec.measurement.string() + " has a column of errors",
         "remove errors from [fit], or the third column from the file"});
  if (!measured.has_errors && !spec.errors_from_scatter)
    throw core::InputError(
        {spec.measurement_where, spec.measurement.string() + " has no errors: its rows are of two values",
         "add one standard deviation as a third column; or write errors = \"from_scatter\" in [fit], "
         "which assumes one unknown error for all points, from their scatter about the curve"});
}

std::vector<analysis::FitParameter> parameters_of(const scene_file::FitSpec& spec) {
  std::vector<analysis::FitParameter> parameters;
  for (const scene_file::FitParameterSpec& p : spec.parameters)
    parameters.push_back({p.label, p.start, p.low, p.high, p.variable});
  return parameters;
}

}  // namespace

analysis::FitRecord fit_scene(const scene_file::SceneFile& file, const SceneFitOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  const scene_file::SceneSpec scene = file.spec(0);
  analysis::FitRecord record;
  record.spec = fit_of(scene);
  record.measured = core::read_named_file(
      record.spec.measurement_where, [&] { return analysis::read_measured_curve(record.spec.measurement); });
  check_errors(record.spec, record.measured);
  const std::unique_ptr<FitModel> model = make_fit_model(file, record.spec, record.measured, options.model);
  record.title = scene.title;
  record.version = core::version();
  record.scene_file = scene.file.string();
  record.scene_text = file.text();
  record.seed = model->seed();
  record.traced = model->count();
  record.thing = model->thing();
  record.notes = model->notes();
  record.omitted = model->omitted();

  analysis::CurveFitOptions fit;
  fit.free_scale = record.spec.free_scale;
  fit.errors_from_scatter = record.spec.errors_from_scatter;
  fit.progress = options.step;
  record.fit = analysis::fit_curve(
      record.measured, parameters_of(record.spec),
      [&](const std::vector<double>& parameters, std::uint64_t draw) {
        return model->trace(parameters, draw);
      },
      fit);
  record.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return record;
}

}  // namespace scintray::simulation
