#include "scintray/scene_file/until.hpp"

#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

constexpr core::Word<core::Fate> kUntilFates[] = {{"detected", core::Fate::detected},
                                                  {"unconverted", core::Fate::not_detected},
                                                  {"absorbed_in_medium", core::Fate::absorbed_in_medium},
                                                  {"absorbed_at_surface", core::Fate::absorbed_at_surface},
                                                  {"escaped", core::Fate::escaped},
                                                  {"cut_interactions", core::Fate::cut_interactions},
                                                  {"cut_time", core::Fate::cut_time}};

/// An error as a share, above 0 and below 1.
std::optional<double> read_error(const config::TomlTable& table, const std::string& key) {
  const std::optional<double> error = table.optional_quantity(key, core::Dimension::dimensionless);
  table.expect(key, !error || (*error > 0.0 && *error < 1.0), "an error to reach is above 0 and below 1",
               "write it as a share, as \"1 %\" or 0.01");
  return error;
}

std::optional<std::uint64_t> read_count(const config::TomlTable& table, const std::string& key) {
  const std::optional<std::int64_t> count = table.optional_integer(key);
  return count ? std::optional(positive_count(table, key, *count)) : std::nullopt;
}

}  // namespace

std::optional<UntilSpec> read_until(const config::TomlTable& run) {
  const std::optional<config::TomlTable> table = run.optional_table("until");
  if (!table) return std::nullopt;
  UntilSpec until;
  until.where = table->where();
  until.fate = table->choice("fate", kUntilFates, core::Fate::detected);
  until.relative_error = read_error(*table, "relative_error");
  until.absolute_error = read_error(*table, "absolute_error");
  constexpr double kNanosecondsPerSecond = 1e9;
  if (const auto time = table->optional_quantity("wall_time", core::Dimension::time)) {
    table->expect("wall_time", *time > 0.0, "a wall time that is not positive",
                  "give a time on the clock, as \"3600 s\"");
    until.wall_time_s = *time / kNanosecondsPerSecond;
  }
  until.photons = read_count(*table, "photons");
  until.events = read_count(*table, "events");
  if (!until.relative_error && !until.absolute_error && !until.wall_time_s && !until.photons && !until.events)
    run.report("until", "\"until\" states no condition",
               "give relative_error, absolute_error, wall_time, photons or events");
  return until;
}

}  // namespace scintray::scene_file
