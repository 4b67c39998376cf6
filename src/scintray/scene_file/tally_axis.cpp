#include "scintray/scene_file/tally_axis.hpp"

#include <cmath>

#include "scintray/core/text.hpp"
#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

/// Largest accepted number of bins of an axis and of a whole tally.
constexpr std::int64_t kMostBins = 10'000'000;

enum class PixelKey { counts, side };
constexpr core::Word<PixelKey> kPixelKeys[] = {{"pixels", PixelKey::counts}, {"pixel", PixelKey::side}};

TallyVariablePtr read_variable(const config::TomlTable& table, const TallyVariables& variables) {
  return variables.at(table.choice("variable", variables.names([](const TallyVariable&) { return true; })));
}

/// A bound of a range; a plain number where the variable has no unit.
std::optional<double> read_bound(const config::TomlTable& table, const std::string& key,
                                 const TallyVariable& variable) {
  return variable.dimension == core::Dimension::dimensionless
             ? table.optional_number(key)
             : table.optional_quantity(key, variable.dimension);
}

/// Direction `along`, which is required by directions and positions and not allowed for most variables.
core::Vec3 read_along(const config::TomlTable& table, const TallyVariables& variables,
                      const TallyVariable& variable) {
  const std::optional<core::Vec3> along = table.optional_direction("along");
  table.expect("along", variable.along, "\"along\" with the variable " + variable.name,
               "measured along something are only " +
                   core::list_of(variables.names([](const TallyVariable& known) { return known.along; })));
  if (variable.along && !table.has("along"))
    table.report("along", "\"" + variable.name + "\" needs a direction", "add along = [1, 0, 0]");
  return along.value_or(core::Vec3::Zero());
}

void default_bounds(TallyAxisSpec& axis) {
  if (!axis.low) axis.low = axis.variable->low;
  if (!axis.high) axis.high = axis.variable->high;
}

}  // namespace

TallyAxisSpec read_tally_axis(const config::TomlTable& table, const TallyVariables& variables,
                              bool has_faces) {
  TallyAxisSpec axis;
  axis.where = table.where();
  axis.variable = read_variable(table, variables);
  if (!table.good("variable")) {
    table.skip();  // what the other keys mean depends on it
    return axis;
  }
  const TallyVariable& variable = *axis.variable;
  axis.names = read_names(table, "names", false);
  table.expect("names", variable.is_name(), "names for an axis of numbers", "give from, to and bins");
  axis.along = read_along(table, variables, variable);
  axis.low = read_bound(table, "from", variable);
  axis.high = read_bound(table, "to", variable);
  axis.bins = table.integer("bins", 0);
  for (const char* key : {"from", "to", "bins"})
    table.expect(key, !variable.is_name(), std::string("\"") + key + "\" for an axis of names",
                 "give names = [...], or nothing for all");
  if (variable.is_name()) return axis;
  default_bounds(axis);
  table.expect("bins", axis.bins >= 1 && axis.bins <= kMostBins,
               "the number of bins is not in 1 to 10 million",
               "give the number of equal bins from \"from\" to \"to\"");
  if (!table.has("bins")) table.report("bins", "an axis of numbers needs a number of bins", "add bins = 50");
  const bool extent_known = variable.spans_face && has_faces;
  if (!extent_known && (!axis.low || !axis.high))
    table.report(axis.low ? "to" : "from", "an axis of " + variable.name + " needs both its ends",
                 "add from and to; only positions on a face take the face's extent");
  table.expect("to", !axis.low || !axis.high || *axis.high > *axis.low,
               "the axis ends at or below where it begins", "give the smaller value as \"from\"");
  return axis;
}

TallyRangeSpec read_tally_range(const config::TomlTable& table, const TallyVariables& variables) {
  TallyRangeSpec range;
  range.where = table.where();
  range.variable = read_variable(table, variables);
  if (!table.good("variable")) {
    table.skip();
    return range;
  }
  table.expect("variable", !range.variable->is_name(), "a condition on a name is no range",
               "use part, source_part, face or at");
  range.along = read_along(table, variables, *range.variable);
  range.low = read_bound(table, "from", *range.variable).value_or(range.low);
  range.high = read_bound(table, "to", *range.variable).value_or(range.high);
  if (!table.has("from") && !table.has("to"))
    table.report("from", "a condition without bounds", "give from, to, or both");
  table.expect("to", range.high > range.low, "the range ends at or below where it begins",
               "give the smaller value as \"from\"");
  return range;
}

TallyAxisSpec binned_axis(TallyVariablePtr variable, std::int64_t bins) {
  TallyAxisSpec axis;
  axis.variable = std::move(variable);
  axis.bins = bins;
  default_bounds(axis);
  return axis;
}

TallyAxisSpec named_axis(TallyVariablePtr variable, std::vector<config::NameRef> names) {
  TallyAxisSpec axis;
  axis.variable = std::move(variable);
  axis.names = std::move(names);
  return axis;
}

std::vector<TallyAxisSpec> read_pixels(const config::TomlTable& table, const TallyVariables& variables,
                                       std::optional<std::int64_t> fallback) {
  const core::Word<PixelKey>* key = table.one_of(kPixelKeys, !fallback);
  std::vector<double> counts;
  std::optional<double> side;
  if (key && key->value == PixelKey::counts) {
    counts = table.numbers(key->word, 2);
  } else if (key) {
    side = table.optional_quantity(key->word, core::Dimension::length);
    table.expect(key->word, side.value_or(1.0) > 0.0, "a pixel that is not larger than nothing",
                 "give its side, as \"0.5 mm\"");
  }
  for (const double n : counts)
    table.expect(key->word, n >= 1 && n <= 10'000 && n == std::floor(n),
                 "pixels that are not whole numbers from 1 to 10000",
                 "give how many there are in each direction, as [16, 16]");
  std::vector<TallyAxisSpec> axes;
  for (int k = 0; k < 2; ++k) {
    TallyAxisSpec& axis = axes.emplace_back();
    axis.variable = variables.at("position");
    axis.where = table.where();
    axis.across_face = true;
    axis.across = k;
    axis.pixel_mm = side;
    axis.bins = counts.size() == 2 ? static_cast<std::int64_t>(counts[static_cast<std::size_t>(k)])
                                   : fallback.value_or(1);
  }
  return axes;
}

}  // namespace scintray::scene_file
