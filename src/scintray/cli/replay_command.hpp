#pragma once

#include <CLI/CLI.hpp>

namespace scintray::cli {

/// `scintray replay SCENE --event E --photon P`
void add_replay_command(CLI::App& app);

}  // namespace scintray::cli
