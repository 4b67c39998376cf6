#pragma once

#include <CLI/CLI.hpp>

namespace scintray::cli {

/// `scintray check SCENE`
void add_check_command(CLI::App& app);

}  // namespace scintray::cli
