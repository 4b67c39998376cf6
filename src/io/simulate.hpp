#pragma once
/// A scene file, run from beginning to end.

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "scintray/scene/build_scene.hpp"
#include "scintray/scene/read_scene.hpp"
#include "scintray/tally/result.hpp"
#include "scintray/trace/run.hpp"

namespace scintray {

struct SimulationProgress {
  std::size_t point = 0, points = 1;  ///< under way, of how many
  std::uint64_t done = 0, total = 0;  ///< over all points
  std::string thing;                  ///< of which: "photons", or "events"
  std::uint64_t segments = 0;         ///< of finished points
};

struct SimulationOptions {
  std::filesystem::path output;  ///< results file; written only when the run ends
  std::optional<int> threads;    ///< in place of the scene's
  std::optional<std::uint64_t> seed;
  std::optional<std::uint64_t> photons;  ///< per point, of a source of photons
  std::optional<std::uint64_t> events;   ///< per point, of a source of energy
  bool quick = false;  ///< the scene's quick_photons or quick_events in place of its full number
  std::function<void(const SimulationProgress&)> progress;
  SurfaceMaker::Hooks surface_hooks;        ///< told while surface tables are built
  const std::atomic<bool>* stop = nullptr;  ///< set to end early; what was traced is kept
};

/// Reads nothing but what the scene names. Every point of the sweep is built before the first is
/// traced, so that mistakes show at once. Results are in `options.output` when this returns, also
/// after an early stop, and then marked as partial.
/// @throws InputError, SystemError; InternalError when a photon has no fate.
RunResult simulate(const SceneFile& file, const SimulationOptions& options);

/// Settings of a run as its scene gives them, with the options in their place. Throws InputError for an
/// option that the scene's source does not have.
SceneSpec with_options(SceneSpec spec, const SimulationOptions& options);

/// Settings of the tracer from [run], for a point of a sweep.
RunSettings run_settings(const RunSpec& run, std::uint32_t point = 0);

}  // namespace scintray
