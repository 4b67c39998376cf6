#pragma once
/// --shard K/N of commands that compute a part of their work.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "scintray/simulation/range_file.hpp"

namespace scintray::cli {

/// Adds the option. Its value is K/N, as 17/400; others are errors of usage.
void add_shard_option(CLI::App& command, std::optional<simulation::Shard>& shard);

/// Path of a shard beside an output: map.h5 becomes map.017-of-400.shard.
std::filesystem::path shard_path(std::filesystem::path output, const simulation::Shard& shard);

}  // namespace scintray::cli
