#pragma once
/// `scintray map`: height maps described, prepared and made.

#include <CLI/CLI.hpp>

namespace scintray::cli {

void add_map_command(CLI::App& app);

/// Its subcommands, each in a file of its own.
void add_map_describe_command(CLI::App& map);
void add_map_prepare_command(CLI::App& map);
void add_map_synthesize_command(CLI::App& map);

}  // namespace scintray::cli
