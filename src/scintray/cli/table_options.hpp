#pragma once
/// Options of every command that traces a surface table.

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scintray/cli/json_answer.hpp"
#include "scintray/materials/database.hpp"
#include "scintray/materials/table_cache.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/topography/build_table.hpp"

namespace scintray::cli {

/// Options of the tracing of a table: media, wavelengths, rays.
struct TracingOptions {
  std::string inside, outside;                     ///< media of the database
  std::string scene;                               ///< file whose own definitions are used as well
  double inside_index = 0.0, outside_index = 0.0;  ///< in place of media; 0: not set
  std::vector<std::string> wavelengths;
  std::string incidence_step, azimuth_step;
  bool no_refine = false;
  topography::TableSettings settings;
};
void add_tracing_options(CLI::App& app, TracingOptions& options);

/// The shipped database, with the definitions of the scene file where one is named.
materials::MaterialDatabase database_of(const TracingOptions& options);

/// Media on both sides, and the wavelengths.
struct Between {
  optics::Medium inside, outside;
  std::vector<double> wavelengths_nm;  ///< empty where only indices are set
  std::vector<topography::SpectralPoint> spectrum() const;
  /// The names of the media, as "LSO to air".
  std::string names() const { return inside.name + " to " + outside.name; }
};
/// Media, of this database, and wavelengths of the options. InputError when a side has neither an index nor a
/// medium, for media without wavelengths, and for wavelengths beyond their indices.
Between between(const TracingOptions& options, const materials::MaterialDatabase& database);
topography::TableSettings settings_of(const TracingOptions& options);

/// Table from the cache, else traced with a progress line and kept; stops at Ctrl-C. Without an entry it is
/// traced, and not kept.
using BuildTable = std::function<optics::SurfaceTable(const topography::TableProgress&)>;
std::shared_ptr<const optics::SurfaceTable> table_with_progress(
    const std::optional<materials::CacheEntry>& entry, const BuildTable& build);

/// Numbers of a table: its provenance, and each slice with its nodes.
Json table_json(const optics::SurfaceTable& table);

/// Writes the table and prints its content, with a warning when the target error was not reached.
void write_and_report(const std::string& path, const optics::SurfaceTable& table);

}  // namespace scintray::cli
