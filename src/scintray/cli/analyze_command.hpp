#pragma once
/// `scintray analyze`: what the events of a results file say.

#include <CLI/CLI.hpp>

namespace scintray::cli {

void add_analyze_command(CLI::App& app);

}  // namespace scintray::cli
