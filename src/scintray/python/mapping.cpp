/// Response maps, and fits of scenes.

#include "scintray/python/detail/bindings.hpp"
#include "scintray/simulation/fit.hpp"
#include "scintray/simulation/response.hpp"

namespace scintray::python {

namespace {

using MapPtr = std::shared_ptr<simulation::ResponseFile>;

/// A scene as Python hands it over.
struct SceneText {
  std::string text, file;
};

simulation::SimulationOptions options_of(const std::optional<int>& threads,
                                         const std::optional<std::uint64_t>& seed,
                                         const std::optional<std::uint64_t>& photons,
                                         const std::optional<std::uint64_t>& events) {
  simulation::SimulationOptions options;
  options.threads = threads;
  options.seed = seed;
  options.photons = photons;
  options.events = events;
  return options;
}

MapPtr build_map(const SceneText& scene, const simulation::ResponseSettings& settings,
                 const simulation::SimulationOptions& given, const py::object& progress) {
  auto map = std::make_shared<simulation::ResponseFile>();
  WatchedWork work;
  work.progress = progress;
  const py::object error = work.run([&] {
    simulation::MapOptions options;
    options.settings = settings;
    options.simulation = given;
    options.simulation.surface_hooks.stop = [&] { return work.stop.load(); };
    options.hooks.stop = &work.stop;
    options.hooks.progress = [&](std::uint64_t cells, std::uint64_t of) { work.report(cells, of, "cells"); };
    *map = simulation::build_map(scene_file::SceneFile::from_text(scene.text, scene.file), options);
  });
  raise_if(error);
  if (map->map.grids.empty())
    throw core::Cancelled("the response map was stopped: it requires all its cells");
  return map;
}

py::dict grid_of(const MapPtr& file, std::size_t number) {
  const simulation::ResponseMap& map = file->map;
  const simulation::ResponseGrid& grid = map.grids.at(number);
  const py::capsule owner(new MapPtr(file), [](void* held) { delete static_cast<MapPtr*>(held); });
  std::vector<py::ssize_t> shape(grid.cells.begin(), grid.cells.end());
  py::dict entry;
  entry["part"] = grid.part;
  entry["low_mm"] = py::make_tuple(grid.low.x(), grid.low.y(), grid.low.z());
  entry["pitch_mm"] = py::make_tuple(grid.pitch.x(), grid.pitch.y(), grid.pitch.z());
  entry["photons"] = view(grid.photons.data(), shape, owner);
  shape.push_back(static_cast<py::ssize_t>(map.channels.size()));
  entry["detected"] = view(grid.detected.data(), shape, owner);
  if (map.backward()) {
    entry["probability"] = view(grid.probabilities.data(), shape, owner);
    entry["probability_error"] = view(grid.probability_errors.data(), shape, owner);
  }
  return entry;
}

/// @param keep  the results file stays; else its events are kept in memory
py::tuple run_mapped(const SceneText& scene, const std::string& map, simulation::SimulationOptions options,
                     const std::string& output, bool keep, const py::object& progress) {
  std::shared_ptr<RunData> data;
  WatchedWork work;
  work.progress = progress;
  const py::object error = work.run([&] {
    options.surface_hooks.stop = [&] { return work.stop.load(); };
    simulation::SimulationHooks hooks;
    hooks.stop = &work.stop;
    hooks.progress = [&](const simulation::SimulationProgress& p) { work.report(p.done, p.total, p.thing); };
    simulation::ResultsFile results(output);
    simulation::simulate_mapped(scene_file::SceneFile::from_text(scene.text, scene.file), map, results,
                                options, hooks);
    data = open_results(output);
    if (keep) return;
    data->read_all_events();
    data->file.clear();
  });
  return py::make_tuple(data, error);
}

py::list parameters_of(const analysis::FitRecord& record) {
  py::list entries;
  for (std::size_t i = 0; i < record.fit.parameters.size(); ++i) {
    const analysis::FittedParameter& of = record.fit.parameters[i];
    py::dict entry;
    entry["name"] = of.parameter.name;
    entry["unit"] = record.spec.parameters.at(i).unit;
    entry["value"] = estimate(of.value);
    entry["monte_carlo_error"] = of.monte_carlo_error;
    entry["interval"] = py::make_tuple(of.interval_low, of.interval_high);
    entry["variable"] = core::word_of(scene_file::kFitVariables, of.parameter.variable);
    entry["in_variable"] = estimate(of.variable);
    entry["start"] = of.parameter.start;
    entry["low"] = of.parameter.low;
    entry["high"] = of.parameter.high;
    entry["at_bound"] = of.at_low || of.at_high;
    entry["determined"] = of.determined;
    entries.append(entry);
  }
  return entries;
}

py::dict fit_of(const analysis::FitRecord& record) {
  constexpr const char* kEnds[] = {"converged", "not_converged", "stopped"};
  const analysis::CurveFit& fit = record.fit;
  py::dict entry;
  entry["title"] = record.title;
  entry["end"] = kEnds[static_cast<std::size_t>(fit.end)];
  entry["quantity"] = analysis::quantity_words(record.spec.quantity);
  entry["position"] = record.spec.at.key;
  entry["position_unit"] = record.spec.unit;
  entry["parameters"] = parameters_of(record);
  std::vector<double> correlation;
  for (Eigen::Index i = 0; i < fit.correlation.rows(); ++i)
    for (Eigen::Index k = 0; k < fit.correlation.cols(); ++k) correlation.push_back(fit.correlation(i, k));
  entry["correlation"] = array_of(std::move(correlation), {fit.correlation.rows(), fit.correlation.cols()});
  entry["scale"] = estimate(fit.scale);
  std::vector<double> x;
  std::vector<core::Estimate> measured, curve, start;
  for (const analysis::MeasuredCurve::Point& point : record.measured.points) {
    x.push_back(point.x);
    measured.push_back(point.y);
  }
  for (const analysis::ModelPoint& point : fit.curve) curve.push_back(point.value);
  for (const analysis::ModelPoint& point : fit.start_curve) start.push_back(point.value);
  entry["x"] = array_of(std::move(x));
  entry["measured"] = estimates(measured);
  entry["curve"] = estimates(curve);
  entry["start_curve"] = estimates(start);
  entry["residual"] = array_of(fit.residual);
  entry["chi2"] = fit.goodness.chi2;
  entry["degrees"] = fit.goodness.degrees;
  entry["p_value"] = fit.goodness.p_value;
  entry["warnings"] = fit.warnings;
  entry["steps"] = fit.steps.size();
  return entry;
}

py::dict fit_scene(const SceneText& scene, const simulation::SimulationOptions& given,
                   const py::object& progress, const std::optional<std::string>& output) {
  analysis::FitRecord record;
  WatchedWork work;
  work.progress = progress;
  const py::object error = work.run([&] {
    simulation::SceneFitOptions options;
    options.model.run = given;
    options.model.run.surface_hooks.stop = [&] { return work.stop.load(); };
    options.model.stop = &work.stop;
    options.step = [&](const analysis::CurveFitStep& step) { work.report(step.number, 0, "steps"); };
    if (output) simulation::check_fit_path(*output);
    record = simulation::fit_scene(scene_file::SceneFile::from_text(scene.text, scene.file), options);
    if (output) simulation::write_fit(*output, record);
  });
  raise_if(error);
  return fit_of(record);
}

}  // namespace

void add_mapping(py::module_& module) {
  const py::call_guard<py::gil_scoped_release> released;
  py::class_<simulation::ResponseFile, MapPtr>(module, "ResponseMap")
      .def("channels", [](const MapPtr& file) { return file->map.channels; })
      .def("photons_per_cell", [](const MapPtr& file) { return file->map.photons_per_cell; })
      .def("photons_per_channel", [](const MapPtr& file) { return file->map.photons_per_channel; })
      .def("grids", [](const MapPtr& file) { return file->map.grids.size(); })
      .def("grid", &grid_of)
      .def("write",
           [](const MapPtr& file, const std::string& path) { simulation::write_response(path, *file); });
  module.def(
      "read_response",
      [](const std::string& path) {
        return std::make_shared<simulation::ResponseFile>(simulation::read_response(path));
      },
      released);
  using Threads = std::optional<int>;
  using Number = std::optional<std::uint64_t>;
  using Text = std::string;
  module.def("build_response", [](const Text& text, const Text& file, double pitch_mm, std::uint32_t photons,
                                  std::uint32_t delays, const Text& direction, std::uint64_t channel_photons,
                                  const Threads& threads, const Number& seed, const py::object& progress) {
    const auto known = core::find_word(simulation::kMapDirections, direction);
    if (!known)
      throw core::unknown_name({}, "direction", direction, core::word_list(simulation::kMapDirections));
    return build_map({text, file}, {pitch_mm, photons, delays, *known, channel_photons},
                     options_of(threads, seed, {}, {}), progress);
  });
  module.def("run_mapped", [](const Text& text, const Text& file, const Text& map, const Threads& threads,
                              const Number& seed, const Number& events, const Text& output, bool keep,
                              const py::object& progress) {
    return run_mapped({text, file}, map, options_of(threads, seed, {}, events), output, keep, progress);
  });
  module.def("fit_scene",
             [](const Text& text, const Text& file, const Threads& threads, const Number& photons,
                const Number& events, const py::object& progress, const std::optional<Text>& output) {
               return fit_scene({text, file}, options_of(threads, {}, photons, events), progress, output);
             });
}

}  // namespace scintray::python
