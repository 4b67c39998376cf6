#pragma once
/// The subcommands of the program: a file NAME_command.cpp each, and a line in a list of commands.cpp.

#include <CLI/App.hpp>
#include <functional>
#include <iosfwd>
#include <span>
#include <vector>

namespace scintray::cli {

/// Adds one subcommand, with its options and its callback, to the program or to the command that groups it.
using AddCommand = void (*)(CLI::App& parent);

/// Subcommands of the program, in the order of its help.
std::span<const AddCommand> commands();
/// Subcommands of `scintray map`.
std::span<const AddCommand> map_commands();
/// Subcommands of `scintray table`.
std::span<const AddCommand> table_commands();
/// Subcommands of `scintray cache`.
std::span<const AddCommand> cache_commands();

/// The commands within a command, in the order of its help.
std::vector<const CLI::App*> subcommands_of(const CLI::App& command);

/// Exit code (exit_codes.hpp) of a command line of `scintray`, whose first word is the program's name.
///
/// @param available  the subcommands: commands(), or those and others
/// @param out, err   streams of the help, and of the messages of a failure
int run_program(std::span<const AddCommand> available, int argc, const char* const* argv, std::ostream& out,
                std::ostream& err);

/// Runs `command` and converts its exceptions, here only, to messages on `err`. Returns an exit code
/// (exit_codes.hpp).
///
/// InputError: every problem with its place and hint. SystemError and failures of the standard library: their
/// text. InternalError and unknown exceptions: the text and a request to report it. CLI::ParseError is
/// rethrown: the caller has the application that prints it.
int run_guarded(const std::function<void()>& command, std::ostream& err);

}  // namespace scintray::cli
