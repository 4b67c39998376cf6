#pragma once
/// `scintray reweigh`: a result under other absorption lengths and reflectances, without tracing.

#include <CLI/CLI.hpp>

namespace scintray::cli {

void add_reweigh_command(CLI::App& app);

}  // namespace scintray::cli
