#pragma once
/// [run] until: what ends a run before the photons or events of its source.

#include <cstdint>
#include <optional>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/step_event.hpp"

namespace scintray::scene_file {

/// Conditions, of which the first that holds ends a point. One at least is stated.
struct UntilSpec {
  core::Fate fate = core::Fate::detected;  ///< whose share the errors are of
  std::optional<double> relative_error;    ///< standard error of the share over the share
  std::optional<double> absolute_error;    ///< standard error of the share
  std::optional<double> wall_time_s;       ///< of the whole run
  std::optional<std::uint64_t> photons;    ///< emitted, of a point
  std::optional<std::uint64_t> events;     ///< of a point of an event source
  core::FileLocation where;
};

/// The conditions in [run]; nothing without `until`. Adds errors to the collector of the table.
std::optional<UntilSpec> read_until(const config::TomlTable& run);

}  // namespace scintray::scene_file
