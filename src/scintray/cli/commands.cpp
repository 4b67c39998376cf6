#include "scintray/cli/commands.hpp"

#include <CLI/CLI.hpp>
#include <ostream>

#include "scintray/cli/error_kinds.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/cli/mpi_ranks.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/version.hpp"

namespace scintray::cli {

// The subcommands, a line each, in the order of the help: NAME is the function add_NAME_command that
// NAME_command.cpp defines.
#define SCINTRAY_COMMANDS(ADD) \
  ADD(new)                     \
  ADD(run)                     \
  ADD(merge)                   \
  ADD(check)                   \
  ADD(view)                    \
  ADD(import)                  \
  ADD(export)                  \
  ADD(repair)                  \
  ADD(report)                  \
  ADD(analyze)                 \
  ADD(map)                     \
  ADD(table)                   \
  ADD(goniometer)              \
  ADD(replay)                  \
  ADD(response)                \
  ADD(reweight)                \
  ADD(fit)                     \
  ADD(cache)                   \
  ADD(schema)                  \
  ADD(manual)                  \
  ADD(completion)

// Subcommands of `scintray map`.
#define SCINTRAY_MAP_COMMANDS(ADD) \
  ADD(map_describe)                \
  ADD(map_prepare)                 \
  ADD(map_synthesize)

// Subcommands of `scintray table`.
#define SCINTRAY_TABLE_COMMANDS(ADD) \
  ADD(table_list)                    \
  ADD(table_compare)                 \
  ADD(table_build)                   \
  ADD(table_stack)                   \
  ADD(table_show)                    \
  ADD(table_export)                  \
  ADD(table_import)

// Subcommands of `scintray cache`.
#define SCINTRAY_CACHE_COMMANDS(ADD) \
  ADD(cache_list)                    \
  ADD(cache_clear)

#define SCINTRAY_DECLARE(name) void add_##name##_command(CLI::App& parent);
SCINTRAY_COMMANDS(SCINTRAY_DECLARE)
SCINTRAY_MAP_COMMANDS(SCINTRAY_DECLARE)
SCINTRAY_TABLE_COMMANDS(SCINTRAY_DECLARE)
SCINTRAY_CACHE_COMMANDS(SCINTRAY_DECLARE)

namespace {

/// The innermost command of a command line that was parsed as far as it went.
const CLI::App& innermost(const CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? app : innermost(*parsed.back());
}

/// "scintray table build".
std::string full_name(const CLI::App& command) {
  return (command.get_parent() ? full_name(*command.get_parent()) + " " : "") + command.get_name();
}

/// The error of a command line, in terms of what was typed.
std::string usage_text(const CLI::ParseError& error) {
  const std::string text = error.what();
  const std::size_t of = text.find(": "), missing = text.rfind(" missing");
  const bool no_value = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr &&
                        of != std::string::npos && missing != std::string::npos;
  return no_value ? text.substr(0, of) + " is not followed by a value" : text;
}

/// Exit code for a command line that was not run, after its message: 0 for --help and --version,
/// the code a command set with CLI::RuntimeError, else bad usage.
int explain(const CLI::App& app, const CLI::ParseError& error, std::ostream& out, std::ostream& err) {
  if (error.get_exit_code() == 0 || error.get_name() == "RuntimeError") return app.exit(error, out, err);
  const CLI::App& command = innermost(app);
  err << "error: " << usage_text(error) << " [" << kUsageError << "]\n";
  if (&command == &app)
    err << app.help();
  else
    err << "  hint: " << full_name(command) << " --help shows how it is used, with examples\n";
  return kBadUsage;
}

/// The first word that is no command or option of a command line, and what may be meant; empty where every
/// word is one.
std::string unknown_word(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining(true);
  if (left.empty()) return "";
  const CLI::App& command = innermost(app);
  const std::string word = left.front().substr(0, left.front().find('='));
  const bool option = word.rfind('-', 0) == 0;
  std::vector<std::string> known;
  for (const CLI::App* inner : command.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(inner->get_name());
  if (!option && known.empty()) return "";
  if (option) {
    known.clear();
    for (const CLI::Option* one : command.get_options())
      for (const std::string& name : one->get_lnames()) known.push_back("--" + name);
  }
  const std::string of = full_name(command);
  const std::string near = core::nearest_word(word, known);
  return "error: " + of + " has no " + (option ? "option" : "command") + " " + core::in_quotes(word) + " [" +
         kUsageError + "]\n  hint: " + (near.empty() ? "" : "did you mean " + near + "? ") + of +
         " --help lists the " + (option ? "options" : "commands") + "\n";
}

/// Throws CLI::ValidationError for a command that mpirun has started several times, but for those that
/// compute together.
void require_one_process(const CLI::App& app) {
  const int processes = launched_processes();
  if (processes > 1 && !app.got_subcommand("run"))
    throw CLI::ValidationError(
        "mpirun", "of all commands `scintray run` alone runs in several processes, and " +
                      std::to_string(processes) + " were started; run this command without mpirun");
}

#define SCINTRAY_ENTRY(name) add_##name##_command,
constexpr AddCommand kCommands[] = {SCINTRAY_COMMANDS(SCINTRAY_ENTRY)};
constexpr AddCommand kMapCommands[] = {SCINTRAY_MAP_COMMANDS(SCINTRAY_ENTRY)};
constexpr AddCommand kTableCommands[] = {
    SCINTRAY_TABLE_COMMANDS(SCINTRAY_ENTRY) add_map_synthesize_command  // as under `map`: no measurement
};
constexpr AddCommand kCacheCommands[] = {SCINTRAY_CACHE_COMMANDS(SCINTRAY_ENTRY)};

}  // namespace

std::span<const AddCommand> commands() { return kCommands; }

std::span<const AddCommand> map_commands() { return kMapCommands; }

std::span<const AddCommand> table_commands() { return kTableCommands; }

std::span<const AddCommand> cache_commands() { return kCacheCommands; }

std::vector<const CLI::App*> subcommands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

int run_program(std::span<const AddCommand> available, int argc, const char* const* argv, std::ostream& out,
                std::ostream& err) {
  CLI::App app("Follows scintillation light through detectors made of triangle meshes.", "scintray");
  app.set_version_flag("--version", "scintray " + core::version());
  app.add_option_function<std::string>(
         "--explain",
         [&out](const std::string& code) {
           out << explanation(code);
           throw CLI::Success();
         },
         "explain the code that stands in brackets behind an error message; without one, list them")
      ->type_name("CODE")
      ->expected(0, 1)
      ->trigger_on_parse();
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  scintray new crystal\n"
      "  scintray run crystal.toml\n"
      "  scintray --explain unknown-key\n"
      "Exit codes: 0 done, 1 the input is wrong, 2 the command line is wrong, 3 the system failed, 4 a "
      "defect,\n"
      "130 interrupted.");
  for (const AddCommand add : available) add(app);
  app.parse_complete_callback([&app] { require_one_process(app); });
  try {
    return run_guarded([&] { app.parse(argc, argv); }, err);
  } catch (const CLI::ParseError& error) {
    // By type: the name of an ExtrasError is that of its subcommand.
    const bool left_over = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                           dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    const std::string unknown = left_over ? unknown_word(app) : "";
    if (unknown.empty()) return explain(app, error, out, err);
    err << unknown;
    return kBadUsage;
  }
}

}  // namespace scintray::cli
