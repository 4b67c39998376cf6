#pragma once
/// A scene's [fit], from beginning to end, and the file that it becomes (HDF5, docs/fit.md).

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/fit/fit_record.hpp"
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

struct SceneFitOptions {
  FitModelSettings model;
  std::function<void(const analysis::CurveFitStep&)> step;  ///< called after each step of the search
};

/// Reads the measurement, and searches. What was found is in the record also after an early stop, and then
/// marked by FitEnd::stopped.
/// @throws InputError when the scene has no [fit], and what read_measured_curve, make_fit_model and fit_curve
/// do
[[nodiscard]] analysis::FitRecord fit_scene(const scene_file::SceneFile& file,
                                            const SceneFitOptions& options);

/// Version of the file's layout; grows when a reader of the older one would misread the newer.
inline constexpr std::int64_t kFitVersion = 1;

/// Throws InputError when `path` is taken by something that is not a fit.
void check_fit_path(const std::filesystem::path& path);

/// Throws what check_fit_path does, and SystemError when the file cannot be written.
void write_fit(const std::filesystem::path& path, const analysis::FitRecord& record);

}  // namespace scintray::simulation
