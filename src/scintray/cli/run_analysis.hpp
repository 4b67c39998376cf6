#pragma once
/// Analyses of the events of a results file, and its page, for commands.

#include <CLI/CLI.hpp>
#include <filesystem>

#include "scintray/report/run_analysis.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::cli {

/// Throws InputError before a run for acceptance criteria about curves that the scene does not have.
void check_criteria(const scene_file::SceneFile& scene);

/// Analyses of the file's events, with the [analysis] and the acceptance criteria of the scene of the run.
report::RunAnalysis analysis_of(const std::filesystem::path& results, const tally::RunResult& run);

/// Adds the option --no-view.
void add_no_view_flag(CLI::App& command, bool& no_view);

/// Parts of the output of a command that has written results.
struct ShownResults {
  bool summary = true, page = true;
  bool view = true;  ///< the page has the scene in three dimensions
};

/// Prints the path of results, with the summary and the page of the run if they are wanted. Returns
/// the analyses.
report::RunAnalysis show_results(const std::filesystem::path& results, const tally::RunResult& run,
                                 const ShownResults& shown);

/// A run, and the file of its results.
struct RunFile {
  const std::filesystem::path& path;
  const tally::RunResult& run;
};

/// Writes the page of a run, and prints its path.
/// @param view  the page has the scene in three dimensions
void write_page(const std::filesystem::path& page, const RunFile& results,
                const report::RunAnalysis& analyses, bool view = true);

}  // namespace scintray::cli
