/// The program: `scintray COMMAND ...`. Each command is in a file of its own.

#include <CLI/CLI.hpp>
#include <iostream>

#include "scintray/cli/analyze_command.hpp"
#include "scintray/cli/check_command.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/failures.hpp"
#include "scintray/cli/fit_command.hpp"
#include "scintray/cli/goniometer_command.hpp"
#include "scintray/cli/import_command.hpp"
#include "scintray/cli/map_command.hpp"
#include "scintray/cli/repair_command.hpp"
#include "scintray/cli/replay_command.hpp"
#include "scintray/cli/report_command.hpp"
#include "scintray/cli/response_command.hpp"
#include "scintray/cli/reweight_command.hpp"
#include "scintray/cli/run_command.hpp"
#include "scintray/cli/table_command.hpp"
#include "scintray/core/version.hpp"

namespace {

/// Exit code for a command line that was not run, after explaining it: 0 for --help and --version,
/// the code a command asked for with CLI::RuntimeError, else bad usage.
int explain(const CLI::App& app, const CLI::ParseError& error) {
  const int code = app.exit(error);
  const bool asked_for = code == 0 || error.get_name() == "RuntimeError";
  return asked_for ? code : static_cast<int>(scintray::cli::kBadUsage);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Follows scintillation light through detectors made of triangle meshes.", "scintray");
  app.set_version_flag("--version", "scintray " + scintray::core::version());
  app.require_subcommand(1);
  scintray::cli::add_run_command(app);
  scintray::cli::add_check_command(app);
  scintray::cli::add_import_command(app);
  scintray::cli::add_repair_command(app);
  scintray::cli::add_report_command(app);
  scintray::cli::add_analyze_command(app);
  scintray::cli::add_map_command(app);
  scintray::cli::add_table_command(app);
  scintray::cli::add_goniometer_command(app);
  scintray::cli::add_replay_command(app);
  scintray::cli::add_response_command(app);
  scintray::cli::add_reweigh_command(app);
  scintray::cli::add_fit_command(app);
  app.failure_message(CLI::FailureMessage::help);

  try {
    return scintray::cli::run_guarded([&] { app.parse(argc, argv); }, std::cerr);
  } catch (const CLI::ParseError& error) {
    return explain(app, error);
  }
}
