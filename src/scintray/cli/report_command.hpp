#pragma once

#include <CLI/CLI.hpp>

namespace scintray::cli {

/// `scintray report RESULT`
void add_report_command(CLI::App& app);

}  // namespace scintray::cli
