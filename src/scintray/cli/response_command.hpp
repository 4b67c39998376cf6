#pragma once

#include <CLI/CLI.hpp>

namespace scintray::cli {

/// `scintray response build SCENE`, `scintray response run SCENE MAP`
void add_response_command(CLI::App& app);

}  // namespace scintray::cli
