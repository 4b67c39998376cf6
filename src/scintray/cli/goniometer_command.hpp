#pragma once
/// `scintray goniometer`: a beam on one surface.

#include <CLI/CLI.hpp>

namespace scintray::cli {

void add_goniometer_command(CLI::App& app);

}  // namespace scintray::cli
