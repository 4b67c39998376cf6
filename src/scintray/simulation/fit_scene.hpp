#pragma once
/// A scene's [fit], from beginning to end.

#include "scintray/analysis/fit/fit_record.hpp"
#include "scintray/simulation/fit_model.hpp"

namespace scintray::simulation {

struct SceneFitOptions {
  FitModelSettings model;
  std::function<void(const analysis::CurveFitStep&)> step;  ///< called after each step of the search
};

/// Reads the measurement, and searches. What was found is in the record also after an early stop, and then
/// marked by FitEnd::stopped.
/// @throws InputError when the scene has no [fit], and what read_measured_curve, make_fit_model and fit_curve
/// do
analysis::FitRecord fit_scene(const scene_file::SceneFile& file, const SceneFitOptions& options);

}  // namespace scintray::simulation
