#include "scintray/simulation/fit.hpp"

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"

namespace scintray::simulation {

namespace {

constexpr const char* kFitFormat = "scintray-fit";

bool is_fit_file(const std::filesystem::path& path) {
  try {
    const core::h5::File file = core::h5::File::open(path);
    const core::h5::Group root = file.root();
    return root.has_attribute("", "format") && root.string_attribute("", "format") == kFitFormat;
  } catch (const core::Error&) {
    return false;
  }
}

/// Writes a dataset with its unit and description.
class FitTable {
 public:
  explicit FitTable(core::h5::Group group) : group_(std::move(group)) {}

  void numbers(const char* name, const std::vector<double>& values, const std::string& unit,
               const std::string& description, core::h5::Shape shape = {}) {
    if (shape.empty()) shape = {values.size()};
    group_.write(name, values, shape);
    describe(name, unit, description);
  }
  void texts(const char* name, const std::vector<std::string>& values, const std::string& description) {
    group_.write_strings(name, values);
    describe(name, "", description);
  }
  core::h5::Group& group() { return group_; }

 private:
  void describe(const char* name, const std::string& unit, const std::string& description) {
    group_.set_attribute(name, "unit", unit);
    group_.set_attribute(name, "description", description);
  }
  core::h5::Group group_;
};

template <typename Item, typename Member>
std::vector<double> gathered(const std::vector<Item>& items, Member member) {
  std::vector<double> values;
  for (const Item& item : items) values.push_back(member(item));
  return values;
}

const char* end_name(analysis::FitEnd end) {
  return end == analysis::FitEnd::converged ? "converged"
         : end == analysis::FitEnd::stopped ? "stopped"
                                            : "not_converged";
}

void put_parameters(FitTable table, const analysis::FitRecord& record) {
  std::vector<std::string> keys, labels, units, variables;
  for (const scene_file::FitParameterSpec& p : record.spec.parameters) {
    keys.push_back(p.path.key);
    labels.push_back(p.label);
    units.push_back(p.unit.empty() ? "1" : p.unit);
    variables.push_back(core::word_of(scene_file::kFitVariables, p.variable));
  }
  table.texts("key", keys, "fitted keys of the scene");
  table.texts("label", labels, "names of the parameters");
  table.texts("unit", units, "unit of each parameter's numbers; 1: a plain number");
  table.texts("variable", variables, "what is searched, in which errors are symmetrical");
  const std::vector<analysis::FittedParameter>& fitted = record.fit.parameters;
  const std::string unit = "as /parameters/unit";
  table.numbers("start", gathered(fitted, [](const auto& p) { return p.parameter.start; }), unit,
                "start of the search");
  table.numbers("low", gathered(fitted, [](const auto& p) { return p.parameter.low; }), unit, "lower bound");
  table.numbers("high", gathered(fitted, [](const auto& p) { return p.parameter.high; }), unit,
                "upper bound");
  table.numbers("value", gathered(fitted, [](const auto& p) { return p.value.value; }), unit, "fitted value");
  if (!record.fit.has_errors) return;
  table.numbers(
      "error", gathered(fitted, [](const auto& p) { return p.value.error; }), unit,
      "one standard error, of the measurement and of the Monte Carlo noise; of an inverse to first order");
  table.numbers("monte_carlo_error", gathered(fitted, [](const auto& p) { return p.monte_carlo_error; }),
                unit, "part of it from Monte Carlo noise");
  table.numbers("interval_low", gathered(fitted, [](const auto& p) { return p.interval_low; }), unit,
                "value at one standard error of the variable below, or the bound");
  table.numbers("interval_high", gathered(fitted, [](const auto& p) { return p.interval_high; }), unit,
                "value at one standard error of the variable above, or the bound");
  const std::string of_variable = "as /parameters/unit, or its inverse by /parameters/variable";
  table.numbers("variable_value", gathered(fitted, [](const auto& p) { return p.variable.value; }),
                of_variable, "value or its inverse");
  table.numbers("variable_error", gathered(fitted, [](const auto& p) { return p.variable.error; }),
                of_variable, "one standard error of it");
  std::vector<double> correlation;
  for (Eigen::Index i = 0; i < record.fit.correlation.rows(); ++i)
    for (Eigen::Index j = 0; j < record.fit.correlation.cols(); ++j)
      correlation.push_back(record.fit.correlation(i, j));
  table.numbers("correlation", correlation, "1", "of the errors of any two parameters",
                {fitted.size(), fitted.size()});
}

void put_curve(FitTable table, const analysis::FitRecord& record) {
  const analysis::CurveFit& fit = record.fit;
  const auto& points = record.measured.points;
  table.numbers("position", gathered(points, [](const auto& p) { return p.x; }), record.spec.unit,
                "position of the measurement");
  table.numbers("measured", gathered(points, [](const auto& p) { return p.y.value; }), "as measured",
                "measured");
  if (record.measured.has_errors)
    table.numbers("measured_error", gathered(points, [](const auto& p) { return p.y.error; }), "as measured",
                  "its standard error");
  const auto value = [](const analysis::ModelPoint& p) { return p.value.value; };
  const auto error = [](const analysis::ModelPoint& p) { return p.value.error; };
  const std::string unit = record.spec.quantity == scene_file::FitQuantity::light_per_keV ? "1/keV" : "1";
  table.numbers("start", gathered(fit.start_curve, value), unit, "simulated at the start, before any scale");
  table.numbers("start_error", gathered(fit.start_curve, error), unit, "its standard error");
  table.numbers("fitted", gathered(fit.curve, value), unit,
                "simulated with the fitted values, before any scale");
  table.numbers("fitted_error", gathered(fit.curve, error), unit, "its standard error");
  table.numbers("residual", fit.residual, "1", "(measured - scale fitted) / residual_error");
  table.numbers("residual_error", fit.error, "as measured",
                "measurement and Monte Carlo error in quadrature");
}

void put_steps(FitTable table, const analysis::FitRecord& record) {
  std::vector<double> parameters;
  for (const analysis::CurveFitStep& step : record.fit.steps)
    parameters.insert(parameters.end(), step.parameters.begin(), step.parameters.end());
  const auto& steps = record.fit.steps;
  table.numbers("parameters", parameters, "as /parameters/unit", "of each step, from the start",
                {steps.size(), record.spec.parameters.size()});
  table.numbers("chi2", gathered(steps, [](const auto& s) { return s.chi2; }), "1",
                "with the weights of the step");
  table.numbers("scale", gathered(steps, [](const auto& s) { return s.scale; }), "1", "best for the step");
  table.numbers("evaluations",
                gathered(steps, [](const auto& s) { return static_cast<double>(s.evaluations); }), "1",
                "curves traced up to the step");
  table.numbers("estimate", gathered(steps, [](const auto& s) { return s.estimate ? 1.0 : 0.0; }), "1",
                "1: with other random numbers than the search's");
}

}  // namespace

void check_fit_path(const std::filesystem::path& path) {
  if (!std::filesystem::exists(std::filesystem::status(path)) || is_fit_file(path)) return;
  throw core::InputError({{path.string()},
                          "this exists and is not a fit, so it is not written over",
                          "choose another name for the fit, or move what is there away"});
}

void write_fit(const std::filesystem::path& path, const analysis::FitRecord& record) {
  check_fit_path(path);
  core::h5::File file = core::h5::File::create(path);
  FitTable root(file.root());
  core::h5::Group& group = root.group();
  const analysis::CurveFit& fit = record.fit;
  group.set_attribute("", "format", std::string(kFitFormat));
  group.set_attribute("", "version", kFitVersion);
  group.set_attribute("", "scintray_version", record.version);
  group.set_attribute("", "title", record.title);
  group.set_attribute("", "scene_file", record.scene_file);
  group.set_attribute("", "measurement_file", record.spec.measurement.string());
  group.set_attribute("", "quantity", std::string(scene_file::quantity_name(record.spec.quantity)));
  group.set_attribute("", "end", std::string(end_name(fit.end)));
  group.set_attribute("", "complete", static_cast<std::int64_t>(fit.end != analysis::FitEnd::stopped));
  group.set_attribute("", "scale_fitted", static_cast<std::int64_t>(record.spec.free_scale));
  group.set_attribute("", "traced_per_point", static_cast<std::int64_t>(record.traced));
  group.set_attribute("", "traced", record.thing);
  root.texts("scene", {record.scene_text}, "the complete scene file");
  root.texts("warnings", fit.warnings, "warnings of the fit");
  if (record.omitted) {
    std::vector<std::string> effects;
    for (const tally::OmittedEffect& effect : *record.omitted)
      if (effect.in_fraction)
        effects.push_back(effect.effect + (effect.subject.empty() ? "" : " (" + effect.subject + ")"));
    root.texts("not_included", effects, "physical effects that the simulated curves do not include");
  }
  group.write("seed", std::vector<std::uint64_t>{record.seed}, {1});
  group.set_attribute("seed", "unit", std::string("1"));
  group.set_attribute("seed", "description", std::string("seed of the random streams of every curve"));
  root.numbers("chi2", {fit.goodness.chi2, fit.goodness.degrees, fit.goodness.p_value}, "1",
               "chi-square, degrees of freedom, probability of a larger one");
  root.numbers("scale", {fit.scale.value, fit.scale.error, fit.start_scale}, "measured over simulated",
               "factor on the simulation, its standard error, and that of the start; 1 when it is fixed");
  if (fit.common_error)
    root.numbers("common_error", {*fit.common_error}, "as measured",
                 "error of a measured value, found from the scatter");
  root.numbers("variance_ratio", {fit.variance_ratio}, "1",
               "variance of differences of curves, with independent over common random numbers");
  put_parameters(FitTable(group.create_group("parameters")), record);
  put_curve(FitTable(group.create_group("curve")), record);
  put_steps(FitTable(group.create_group("steps")), record);
  file.commit();
}

}  // namespace scintray::simulation
