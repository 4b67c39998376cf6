#pragma once
/// The [fit] of a scene, and its file (HDF5, docs/fit.md).

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/analysis/fit/fit_record.hpp"
#include "scintray/core/journal.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/simulation/simulation_options.hpp"

namespace scintray::simulation {

/// Options of the tracing of a curve.
struct FitModelSettings {
  SimulationOptions run;
  const std::atomic<bool>* stop = nullptr;                             ///< set from outside: stop
  std::function<void(std::uint64_t done, std::uint64_t of)> progress;  ///< within a curve
  /// Keeps the finished points of curves, and has those of before. Its file is for the caller to remove, once
  /// the fit is written.
  std::optional<core::JournalSettings> journal = {};
};

/// A curve of a scene that can be traced for any values of the fitted keys. All curves of one draw have the
/// same seed, and each point its own streams, so that the photons are the same ones for all values.
class FitModel {
 public:
  virtual ~FitModel() = default;
  /// The curve, in step with the measured points; empty when it was stopped.
  virtual std::optional<analysis::ModelCurve> trace(const std::vector<double>& parameters,
                                                    std::uint64_t draw) = 0;
  /// Number of photons, events or rays at each point, and which of these.
  virtual std::uint64_t count() const = 0;
  virtual std::string thing() const = 0;
  virtual std::uint64_t seed() const = 0;
  /// Warnings of the scene.
  virtual std::vector<std::string> notes() const = 0;
  /// analysis::FitRecord::omitted
  virtual std::optional<std::vector<tally::OmittedEffect>> omitted() const = 0;
};

/// Model of the fit of a scene, checked with every position, and with every parameter at its bounds.
/// @throws InputError for a source without the quantity, a sweep that does not determine which scene is
///         meant, options that the source does not have, and errors of the scene itself
std::unique_ptr<FitModel> make_fit_model(const scene_file::SceneFile& file, const scene_file::FitSpec& fit,
                                         const analysis::MeasuredCurve& measured,
                                         const FitModelSettings& settings);

struct SceneFitOptions {
  FitModelSettings model;
  std::function<void(const analysis::CurveFitStep&)> step;  ///< called after each step of the search
};

/// Fit of a scene to its measurement. The record contains the result also after an early stop, marked by
/// FitEnd::stopped.
/// @throws InputError when the scene has no [fit], and as read_measured_curve, make_fit_model, fit_curve and
///         core::Journal
[[nodiscard]] analysis::FitRecord fit_scene(const scene_file::SceneFile& file,
                                            const SceneFitOptions& options);

/// Version of the file's layout; grows when a reader of the older one would misread the newer.
inline constexpr std::int64_t kFitVersion = 1;

/// Throws InputError when `path` is taken by a file that is not a fit.
void check_fit_path(const std::filesystem::path& path);

/// Writes a fit. Throws as check_fit_path, and SystemError when the file cannot be written.
void write_fit(const std::filesystem::path& path, const analysis::FitRecord& record);

}  // namespace scintray::simulation
