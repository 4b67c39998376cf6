#pragma once

#include <CLI/CLI.hpp>

namespace scintray::cli {

/// `scintray repair MESH|SCENE -o OUT`
void add_repair_command(CLI::App& app);

}  // namespace scintray::cli
