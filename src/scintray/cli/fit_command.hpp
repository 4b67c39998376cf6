#pragma once

#include <CLI/CLI.hpp>

namespace scintray::cli {

/// `scintray fit SCENE`
void add_fit_command(CLI::App& app);

}  // namespace scintray::cli
