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

constexpr const char* kRelativeError = "relative_error";
constexpr const char* kAbsoluteError = "absolute_error";

/// An error as a share, above 0 and below 1.
std::optional<double> read_share(const config::TomlTable& table, const std::string& key) {
  const std::optional<double> error = table.optional_quantity(key, core::Dimension::dimensionless);
  table.expect(key, !error || (*error > 0.0 && *error < 1.0), "an error to reach is above 0 and below 1",
               "write it as a share, as \"1 %\" or 0.01");
  return error;
}

/// An error in the unit of the result.
std::optional<double> read_absolute(const config::TomlTable& table, UntilGoal of) {
  if (of == UntilGoal::fate || of == UntilGoal::tally || of == UntilGoal::energy_resolution)
    return read_share(table, kAbsoluteError);
  const auto read = [&](core::Dimension dimension, const std::string& hint) {
    const std::optional<double> error = table.optional_quantity(kAbsoluteError, dimension);
    table.expect(kAbsoluteError, !error || *error > 0.0, "an error to reach is above 0", hint);
    return error;
  };
  if (of == UntilGoal::ctr) return read(core::Dimension::time, "write it as a time, as \"2 ps\"");
  if (of == UntilGoal::light_per_energy)
    return read(core::Dimension::photons_per_energy, "write it as \"0.01 1/keV\"");
  return read(core::Dimension::dimensionless, "write it in photons, or in photoelectrons with a readout");
}

std::optional<std::uint64_t> read_count(const config::TomlTable& table, const std::string& key) {
  const std::optional<std::int64_t> count = table.optional_integer(key);
  return count ? std::optional(positive_count(table, key, *count)) : std::nullopt;
}

bool is_entry(const config::TomlNode& item) {
  return item.kind == config::TomlNode::Kind::string || item.kind == config::TomlNode::Kind::integer ||
         item.kind == config::TomlNode::Kind::number;
}

/// The entries of `bin`: names, quantities and numbers, as text.
std::vector<std::string> read_bin(const config::TomlTable& table) {
  const config::TomlNodePtr node = table.take("bin");
  if (!node) return {};
  std::vector<std::string> bin;
  bool good = node->kind == config::TomlNode::Kind::array && !node->items.empty();
  if (good)
    for (const config::TomlNode& item : node->items) {
      good = good && is_entry(item);
      bin.push_back(item.text);
    }
  if (good) return bin;
  table.report("bin", "\"bin\" is no list with an entry for each axis of the tally",
               "write the name of a bin, or a value within it, as [\"pmt\", \"3 ns\"]");
  return {};
}

}  // namespace

std::optional<UntilSpec> read_until(const config::TomlTable& run) {
  const std::optional<config::TomlTable> table = run.optional_table("until");
  if (!table) return std::nullopt;
  UntilSpec until;
  until.where = table->where();
  until.of = table->choice("of", kUntilGoals, UntilGoal::fate);
  for (const char* key : {"fate", "tally", "bin"}) table->has(key);  // known, and without meaning for others
  if (until.of == UntilGoal::fate) until.fate = table->choice("fate", kUntilFates, core::Fate::detected);
  if (until.of == UntilGoal::tally) {
    until.tally = read_name(*table, "tally", true);
    until.bin = read_bin(*table);
  }
  until.relative_error = read_share(*table, kRelativeError);
  until.absolute_error = read_absolute(*table, until.of);
  constexpr double kNanosecondsPerSecond = 1e9;
  if (const auto time = table->optional_quantity("wall_time", core::Dimension::time)) {
    table->expect("wall_time", *time > 0.0, "a wall time that is not positive",
                  "give a time on the clock, as \"3600 s\"");
    until.wall_time_s = *time / kNanosecondsPerSecond;
  }
  until.photons = read_count(*table, "photons");
  until.events = read_count(*table, "events");
  const bool has_error = table->has(kRelativeError) || table->has(kAbsoluteError);
  if (!has_error && !table->has("wall_time") && !table->has("photons") && !table->has("events"))
    run.report("until", "\"until\" states no condition",
               "give relative_error, absolute_error, wall_time, photons or events");
  else
    table->expect("of", has_error, "\"until\" names a result, but no error of it",
                  "give relative_error or absolute_error, or remove of");
  return until;
}

}  // namespace scintray::scene_file
