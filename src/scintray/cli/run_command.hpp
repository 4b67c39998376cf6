#pragma once

#include <CLI/CLI.hpp>

namespace scintray::cli {

/// `scintray run SCENE...`
void add_run_command(CLI::App& app);

}  // namespace scintray::cli
