#pragma once
/// Readout electronics applied again to the recorded photons of a result, without tracing.

#include <filesystem>

#include "scintray/detector/readout_spec.hpp"
#include "scintray/scene_file/tally_variable.hpp"
#include "scintray/simulation/simulation_options.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::simulation {

/// Writes a result like the one at `path`, whose events have the charges, times and waveforms of other
/// electronics for the same detected photons. The list of photons is not copied. With the electronics of the
/// run the numbers are its own, except for the rounding of recorded times and positions to single precision:
/// random streams are those of the run. Sensors are those of the scene.
/// @param run        of the same file; its scene is built again, so files that it names must be where they
/// were
/// @param readout    checked by the reader of [readout]
/// @param options    of the simulation that builds the scene, with the models that it may name; the seed is
/// that
///                   of the run
/// @param extensions  that the scene was read with
/// @throws InputError without events or without a list of their photons, for a scene whose sensors are not
///         those of the result, and for electronics that do not suit a sensor
void rerun_readout(const std::filesystem::path& path, const tally::RunResult& run,
                   const detector::ReadoutSpec& readout, const std::filesystem::path& output,
                   SimulationOptions options = {}, const scene_file::Extensions& extensions = {});

}  // namespace scintray::simulation
