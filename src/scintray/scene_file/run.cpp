#include "scintray/scene_file/run.hpp"

#include <algorithm>

#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

RunSpec read_run(const config::TomlTable& scene) {
  RunSpec run;
  const std::optional<config::TomlTable> table = scene.optional_table("run");
  if (!table) return run;
  run.where = table->where();
  const std::int64_t seed = table->integer("seed", static_cast<std::int64_t>(run.seed));
  table->expect("seed", seed >= 0, "a seed below 0", "give an integer from 0 to 9223372036854775807");
  run.seed = static_cast<std::uint64_t>(seed);
  const auto limit = static_cast<std::int64_t>(run.max_interactions);
  run.max_interactions =
      positive_count(*table, "max_interactions", table->integer("max_interactions", limit));
  run.max_time_ns = table->optional_quantity("max_time", core::Dimension::time);
  table->expect("max_time", run.max_time_ns.value_or(1.0) > 0.0, "a time limit that is not positive",
                "give a time after emission, as \"500 ns\", or remove it");
  if (const auto threads = table->optional_integer("threads")) {
    table->expect("threads", *threads >= 1 && *threads <= 4096, "the number of threads is not in 1 to 4096",
                  "give a number of threads, or remove it to use all cores");
    run.threads = static_cast<int>(*threads);
  }
  run.contact_tolerance_mm =
      table->quantity("contact_tolerance", core::Dimension::length, run.contact_tolerance_mm);
  table->expect("contact_tolerance", run.contact_tolerance_mm > 0.0,
                "a contact tolerance that is not positive",
                "give the distance below which faces touch, as \"0.1 um\"");
  run.accelerator = table->choice("accelerator", kAcceleratorKinds, AcceleratorKind::automatic);
  run.efficiency_at_birth = table->boolean("efficiency_at_birth", true);
  run.curved = table->choice("curved", kCurvedFaces, CurvedFaces::exact);
  run.polarisation = table->choice("polarisation", kPolarisationStates, PolarisationState::linear);
  run.photon_list = table->boolean("photon_list", false);
  run.photons = read_photon_output(*table, run.photon_list);
  run.photon_history = table->boolean("photon_history", false);
  constexpr std::int64_t kMostPaths = 100'000;
  const std::int64_t paths = table->integer("paths", 0);
  table->expect("paths", paths >= 0 && paths <= kMostPaths,
                "the number of photon paths is not in 0 to 100000",
                "give the number of photons whose paths the results file holds, as 500, or remove it");
  run.paths = static_cast<std::uint64_t>(std::max<std::int64_t>(paths, 0));
  run.until = read_until(*table);
  run.output = table->string("output", "");
  if (!run.output.empty() && run.output.is_relative())
    run.output = std::filesystem::path(table->where("output").file).parent_path() / run.output;
  return run;
}

}  // namespace scintray::scene_file
