#pragma once
/// The curve of a scene against the positions of a measurement, as a function of fitted keys.

#include <atomic>
#include <functional>
#include <memory>

#include "scintray/analysis/fit/curve_fit.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_options.hpp"

namespace scintray::simulation {

/// What a curve is traced with.
struct FitModelSettings {
  SimulationOptions run;
  const std::atomic<bool>* stop = nullptr;                             ///< set from outside: give up
  std::function<void(std::uint64_t done, std::uint64_t of)> progress;  ///< within a curve
};

/// A curve of a scene that can be traced for any values of the fitted keys. Every curve of one draw has the
/// same seed, and each point streams of its own, so that photons are the same ones for all values.
class FitModel {
 public:
  virtual ~FitModel() = default;
  /// In step with the measured points; nothing when it was stopped.
  virtual std::optional<analysis::ModelCurve> trace(const std::vector<double>& parameters,
                                                    std::uint64_t draw) = 0;
  /// Photons, events or rays at each point, and which of these.
  virtual std::uint64_t count() const = 0;
  virtual std::string thing() const = 0;
  virtual std::uint64_t seed() const = 0;
  /// Warnings of the scene.
  virtual std::vector<std::string> notes() const = 0;
};

/// Checks the scene with every position, and with every parameter at its bounds.
/// @throws InputError with what is wrong: a source that has no such quantity, a sweep that leaves open which
///         scene is meant, options that the source does not have, and what the scene itself refuses
std::unique_ptr<FitModel> make_fit_model(const scene_file::SceneFile& file, const scene_file::FitSpec& fit,
                                         const analysis::MeasuredCurve& measured,
                                         const FitModelSettings& settings);

}  // namespace scintray::simulation
