#include "scintray/cli/commands.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <ostream>

#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/failures.hpp"
#include "scintray/core/version.hpp"

namespace scintray::cli {

// Each is defined in the file of its name.
using CommandFunction = void(CLI::App& parent);
CommandFunction add_run_command, add_check_command, add_import_command, add_repair_command,
    add_report_command, add_analyze_command, add_map_command, add_table_command, add_goniometer_command,
    add_replay_command, add_response_command, add_reweight_command, add_fit_command;
CommandFunction add_map_describe_command, add_map_prepare_command, add_map_synthesize_command;
CommandFunction add_table_list_command, add_table_compare_command, add_table_build_command,
    add_table_stack_command, add_table_show_command, add_table_export_command, add_table_import_command;

namespace {

/// Exit code for a command line that was not run, after explaining it: 0 for --help and --version,
/// the code a command set with CLI::RuntimeError, else bad usage.
int explain(const CLI::App& app, const CLI::ParseError& error, std::ostream& out, std::ostream& err) {
  const int code = app.exit(error, out, err);
  const bool asked_for = code == 0 || error.get_name() == "RuntimeError";
  return asked_for ? code : static_cast<int>(kBadUsage);
}

constexpr std::array<AddCommand, 13> kCommands{
    add_run_command,        add_check_command,   add_import_command,   add_repair_command,
    add_report_command,     add_analyze_command, add_map_command,      add_table_command,
    add_goniometer_command, add_replay_command,  add_response_command, add_reweight_command,
    add_fit_command,
};

constexpr std::array<AddCommand, 3> kMapCommands{
    add_map_describe_command,
    add_map_prepare_command,
    add_map_synthesize_command,
};

constexpr std::array<AddCommand, 8> kTableCommands{
    add_table_list_command,     add_table_compare_command, add_table_build_command,  add_table_stack_command,
    add_table_show_command,     add_table_export_command,  add_table_import_command,
    add_map_synthesize_command,  // as under `map`, where a table starts from no measurement
};

}  // namespace

std::span<const AddCommand> commands() { return kCommands; }

std::span<const AddCommand> map_commands() { return kMapCommands; }

std::span<const AddCommand> table_commands() { return kTableCommands; }

int run_program(std::span<const AddCommand> available, int argc, const char* const* argv, std::ostream& out,
                std::ostream& err) {
  CLI::App app("Follows scintillation light through detectors made of triangle meshes.", "scintray");
  app.set_version_flag("--version", "scintray " + core::version());
  app.require_subcommand(1);
  for (const AddCommand add : available) add(app);
  app.failure_message(CLI::FailureMessage::help);
  try {
    return run_guarded([&] { app.parse(argc, argv); }, err);
  } catch (const CLI::ParseError& error) {
    return explain(app, error, out, err);
  }
}

}  // namespace scintray::cli
