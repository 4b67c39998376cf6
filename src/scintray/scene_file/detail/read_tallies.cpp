#include "scintray/scene_file/detail/read_tallies.hpp"

#include <algorithm>
#include <set>

#include "scintray/core/pattern.hpp"
#include "scintray/core/text.hpp"
#include "scintray/scene_file/detail/bodies.hpp"
#include "scintray/scene_file/detail/face_path.hpp"
#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

/// Bins of an axis and of a whole tally that are still an answer and no mistake.
constexpr std::int64_t kMostBins = 10'000'000;

ExitAngleTallySpec read_exit_angle(const config::TomlTable& table, const SceneSpec& scene) {
  ExitAngleTallySpec tally;
  tally.where = table.where();
  if (const auto path = read_face_path(table, "face", table.string("face"),
                                       part_names(scene.parts, scene.groups), scene.parts, false)) {
    tally.part = path->part;
    tally.face = path->face;
  }
  tally.name = table.string("name", tally.part.name + ":" + tally.face.name);
  tally.detected_only = table.boolean("detected_only", false);
  const std::int64_t bins = table.integer("bins", tally.bins);
  table.expect("bins", bins >= 1 && bins <= 9000, "the number of bins is not in 1 to 9000",
               "give the number of equal bins over 0 to 90 deg");
  tally.bins = static_cast<int>(bins);
  return tally;
}

/// One string or a list of them.
std::vector<config::NameRef> read_names(const config::TomlTable& table, const std::string& key,
                                        bool required) {
  std::vector<config::NameRef> names;
  const config::TomlNode* node = table.node()->find(key);
  if (node && node->kind == config::TomlNode::Kind::array) {
    for (const std::string& name : table.strings(key, 0, required)) names.push_back({name, table.where(key)});
  } else if (const config::NameRef one = read_name(table, key, required); !one.empty()) {
    names.push_back(one);
  }
  return names;
}

std::vector<std::string> words_of(int count, const char* (*name)(int)) {
  std::vector<std::string> words;
  for (int i = 0; i < count; ++i) words.emplace_back(name(i));
  return words;
}

const std::vector<std::string>& event_words() {
  static const auto words =
      words_of(kEventWordCount, [](int i) { return event_word(static_cast<core::StepEvent>(i)); });
  return words;
}

const std::vector<std::string>& variable_words() {
  static const auto words =
      words_of(kTallyVariableCount, [](int i) { return tally_variable_name(static_cast<TallyVariable>(i)); });
  return words;
}

std::size_t place_of(const std::vector<std::string>& words, const std::string& word) {
  return static_cast<std::size_t>(std::find(words.begin(), words.end(), word) - words.begin());
}

TallyVariable read_variable(const config::TomlTable& table, const std::string& key) {
  return static_cast<TallyVariable>(place_of(variable_words(), table.choice(key, variable_words())));
}

std::vector<core::StepEvent> read_events(const config::TomlTable& table, const std::string& key,
                                         const std::vector<core::StepEvent>& fallback) {
  if (!table.has(key)) return fallback;
  std::vector<core::StepEvent> events;
  for (const config::NameRef& name : read_names(table, key, false)) {
    const std::size_t i = place_of(event_words(), name.name);
    const std::string near = core::nearest_word(name.name, event_words());
    table.expect(key, i < event_words().size(),
                 "nothing that happens to a photon is called \"" + name.name + "\"",
                 (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "there are " +
                     core::list_of(event_words()));
    if (i == event_words().size()) continue;
    const std::vector<core::StepEvent> named = events_of_word(static_cast<int>(i));
    events.insert(events.end(), named.begin(), named.end());
  }
  return events;
}

core::Dimension dimension_of(TallyVariable variable) {
  switch (variable) {
    case TallyVariable::wavelength:
      return core::Dimension::wavelength;
    case TallyVariable::time:
      return core::Dimension::time;
    case TallyVariable::path:
    case TallyVariable::position:
    case TallyVariable::start:
      return core::Dimension::length;
    case TallyVariable::angle_before:
    case TallyVariable::angle_after:
    case TallyVariable::azimuth_before:
    case TallyVariable::azimuth_after:
      return core::Dimension::angle;
    default:
      return core::Dimension::dimensionless;
  }
}

/// A bound of a range; a plain number where the variable has no unit.
std::optional<double> read_bound(const config::TomlTable& table, const std::string& key,
                                 TallyVariable variable) {
  const core::Dimension dimension = dimension_of(variable);
  return dimension == core::Dimension::dimensionless ? table.optional_number(key)
                                                     : table.optional_quantity(key, dimension);
}

/// Reads `along`, which directions and positions need and nothing else has.
core::Vec3 read_along(const config::TomlTable& table, TallyVariable variable, bool required) {
  const std::optional<core::Vec3> along = table.optional_direction("along");
  table.expect("along", needs_direction(variable),
               std::string("\"along\" with the variable ") + tally_variable_name(variable),
               "only position, start and direction are measured along something");
  if (required && needs_direction(variable) && !table.has("along"))
    table.report("along", std::string("\"") + tally_variable_name(variable) + "\" needs a direction",
                 "add along = [1, 0, 0]");
  return along.value_or(core::Vec3::Zero());
}

/// Bounds that a variable has by nature.
void default_bounds(TallyAxisSpec& axis) {
  switch (axis.variable) {
    case TallyVariable::angle_before:
    case TallyVariable::angle_after:
      axis.low = axis.low.value_or(0.0);
      axis.high = axis.high.value_or(0.5 * core::kPi);
      break;
    case TallyVariable::sin2_before:
    case TallyVariable::sin2_after:
      axis.low = axis.low.value_or(0.0);
      axis.high = axis.high.value_or(1.0);
      break;
    case TallyVariable::azimuth_before:
    case TallyVariable::azimuth_after:
      axis.low = axis.low.value_or(-core::kPi);
      axis.high = axis.high.value_or(core::kPi);
      break;
    case TallyVariable::direction:
      axis.low = axis.low.value_or(-1.0);
      axis.high = axis.high.value_or(1.0);
      break;
    default:
      break;
  }
}

TallyAxisSpec read_axis(const config::TomlTable& table, bool has_faces) {
  TallyAxisSpec axis;
  axis.where = table.where();
  axis.variable = read_variable(table, "variable");
  const bool category = is_category(axis.variable);
  axis.names = read_names(table, "names", false);
  table.expect("names", category, "names for an axis of numbers", "give from, to and bins");
  axis.along = read_along(table, axis.variable, true);
  axis.low = read_bound(table, "from", axis.variable);
  axis.high = read_bound(table, "to", axis.variable);
  axis.bins = table.integer("bins", 0);
  for (const char* key : {"from", "to", "bins"})
    table.expect(key, !category, std::string("\"") + key + "\" for an axis of names",
                 "give names = [...], or nothing for all");
  if (category || !table.good("variable")) return axis;
  default_bounds(axis);
  table.expect("bins", axis.bins >= 1 && axis.bins <= kMostBins,
               "the number of bins is not in 1 to 10 million",
               "give the number of equal bins from \"from\" to \"to\"");
  if (!table.has("bins")) table.report("bins", "an axis of numbers needs a number of bins", "add bins = 50");
  const bool extent_known = axis.variable == TallyVariable::position && has_faces;
  if (!extent_known && (!axis.low || !axis.high))
    table.report(axis.low ? "to" : "from",
                 std::string("an axis of ") + tally_variable_name(axis.variable) + " needs both its ends",
                 "add from and to; only positions on a face take the face's extent");
  table.expect("to", !axis.low || !axis.high || *axis.high > *axis.low,
               "the axis ends at or below where it begins", "give the smaller value as \"from\"");
  return axis;
}

TallyRangeSpec read_range(const config::TomlTable& table) {
  TallyRangeSpec range;
  range.where = table.where();
  range.variable = read_variable(table, "variable");
  table.expect("variable", !is_category(range.variable), "a condition on a name is no range",
               "use part, source_part, face or at");
  range.along = read_along(table, range.variable, true);
  range.low = read_bound(table, "from", range.variable).value_or(range.low);
  range.high = read_bound(table, "to", range.variable).value_or(range.high);
  if (!table.has("from") && !table.has("to"))
    table.report("from", "a condition without bounds", "give from, to, or both");
  table.expect("to", range.high > range.low, "the range ends at or below where it begins",
               "give the smaller value as \"from\"");
  return range;
}

const std::vector<core::StepEvent> kReaching = {core::StepEvent::detected, core::StepEvent::not_detected};
const std::vector<core::StepEvent> kThrough = {core::StepEvent::transmitted, core::StepEvent::detected,
                                               core::StepEvent::not_detected};
const std::vector<core::StepEvent> kAtInterface = {
    core::StepEvent::reflected,    core::StepEvent::transmitted,         core::StepEvent::detected,
    core::StepEvent::not_detected, core::StepEvent::absorbed_at_surface, core::StepEvent::absorbed_in_medium};

TallyAxisSpec axis_of(TallyVariable variable, std::vector<config::NameRef> names = {}) {
  TallyAxisSpec axis;
  axis.variable = variable;
  axis.names = std::move(names);
  return axis;
}

TallyAxisSpec binned(TallyVariable variable, std::int64_t bins) {
  TallyAxisSpec axis = axis_of(variable);
  axis.bins = bins;
  default_bounds(axis);
  return axis;
}

/// `pixels = [n, m]` or `pixel = "0.5 mm"` across the face.
void add_pixels(const config::TomlTable& table, std::optional<std::int64_t> fallback, TallySpec& tally) {
  const auto kind = table.one_of({"pixels", "pixel"}, !fallback);
  const std::vector<double> counts = kind == "pixels" ? table.numbers("pixels", 2) : std::vector<double>{};
  std::optional<double> size;
  if (kind == "pixel") {
    size = table.optional_quantity("pixel", core::Dimension::length);
    table.expect("pixel", size.value_or(1.0) > 0.0, "a pixel that is not larger than nothing",
                 "give its side, as \"0.5 mm\"");
  }
  for (const double n : counts)
    table.expect("pixels", n >= 1 && n <= 10'000 && n == std::floor(n),
                 "pixels that are not whole numbers from 1 to 10000",
                 "give how many there are in each direction, as [16, 16]");
  for (int k = 0; k < 2; ++k) {
    TallyAxisSpec axis = axis_of(TallyVariable::position);
    axis.where = table.where();
    axis.across_face = true;
    axis.across = k;
    axis.pixel_mm = size;
    axis.bins = counts.size() == 2 ? static_cast<std::int64_t>(counts[static_cast<std::size_t>(k)])
                                   : fallback.value_or(1);
    tally.axes.push_back(axis);
  }
}

FaceWay read_way(const config::TomlTable& table, const std::string& fallback) {
  const std::string word = table.choice("way", {"out", "in", "both"}, fallback);
  return word == "in" ? FaceWay::in : word == "both" ? FaceWay::both : FaceWay::out;
}

std::int64_t read_bins(const config::TomlTable& table, const std::string& key, std::int64_t fallback) {
  const std::int64_t bins = table.integer(key, fallback);
  table.expect(key, bins >= 1 && bins <= 9000, "the number of bins is not in 1 to 9000",
               "give a number of equal bins");
  return bins;
}

void read_crosstalk(const config::TomlTable& table, TallySpec& tally, std::vector<TallySpec>& all) {
  const std::vector<config::NameRef> sources = read_names(table, "source_part", false);
  tally.at = read_events(table, "at", {core::StepEvent::detected});
  tally.axes = {axis_of(TallyVariable::source_part, sources),
                axis_of(TallyVariable::part, read_names(table, "part", false))};
  TallySpec emitted = tally;
  emitted.name += ": emitted";
  emitted.type = "emitted";
  emitted.at = {core::StepEvent::emitted};
  emitted.axes.pop_back();
  all.push_back(std::move(emitted));
}

void read_etendue(const config::TomlTable& table, TallySpec& tally) {
  tally.at = read_events(table, "at", kThrough);
  tally.way = read_way(table, "out");
  const bool inside = table.boolean("inside", false);
  add_pixels(table, 8, tally);
  tally.axes.push_back(binned(inside ? TallyVariable::sin2_before : TallyVariable::sin2_after,
                              read_bins(table, "polar_bins", 8)));
  tally.axes.push_back(binned(inside ? TallyVariable::azimuth_before : TallyVariable::azimuth_after,
                              read_bins(table, "azimuth_bins", 8)));
}

void read_angles(const config::TomlTable& table, TallySpec& tally) {
  tally.at = read_events(table, "at", kThrough);
  tally.way = read_way(table, "out");
  const bool inside = table.boolean("inside", false);
  tally.axes = {binned(inside ? TallyVariable::sin2_before : TallyVariable::sin2_after,
                       read_bins(table, "polar_bins", 20)),
                binned(inside ? TallyVariable::azimuth_before : TallyVariable::azimuth_after,
                       read_bins(table, "azimuth_bins", 36))};
}

void read_count(const config::TomlTable& table, TallySpec& tally) {
  tally.at = read_events(table, "at", {});
  if (!table.has("at")) table.report("at", "a count needs to know of what", "add at = \"detected\"");
  tally.way = read_way(table, "out");
  table.expect("way", !tally.faces.empty(), "a way without a face", "add face = \"part:face\"");
  tally.parts = read_names(table, "part", false);
  tally.source_parts = read_names(table, "source_part", false);
  tally.visited = read_names(table, "visited", false);
  tally.not_visited = read_names(table, "not_visited", false);
  tally.fate = read_events(table, "fate", {});
  const std::string each = table.choice("each", {"time", "first", "last"}, "time");
  tally.each = each == "first" ? TallyEach::first : each == "last" ? TallyEach::last : TallyEach::time;
  if (const std::string score =
          table.choice("score", {"photons", "time", "path", "interactions", "wavelength"}, "photons");
      score != "photons")
    tally.score = static_cast<TallyVariable>(place_of(variable_words(), score));
  for (const config::TomlTable& range : table.tables("where")) tally.ranges.push_back(read_range(range));
  for (const config::TomlTable& axis : table.tables("axes"))
    tally.axes.push_back(read_axis(axis, !tally.faces.empty()));
}

/// What no tally can mean: faces for events away from faces, directions at no face.
void check_faces(const config::TomlTable& table, const TallySpec& tally) {
  const bool away = std::any_of(tally.at.begin(), tally.at.end(),
                                [](core::StepEvent event) { return !core::is_at_boundary(event); });
  table.expect("face", !away, "a face for what does not happen at faces",
               "at a face photons are returned, crossed, detected, unconverted or absorbed");
  for (const TallyAxisSpec& axis : tally.axes)
    if (needs_face(axis.variable) && tally.faces.empty())
      table.report("face", std::string("an axis of ") + tally_variable_name(axis.variable) + " needs a face",
                   "add face = \"part:face\"");
  for (const TallyRangeSpec& range : tally.ranges)
    if (needs_face(range.variable) && tally.faces.empty())
      table.report("face",
                   std::string("a condition on ") + tally_variable_name(range.variable) + " needs a face",
                   "add face = \"part:face\"");
}

void read_tally(const config::TomlTable& table, const std::string& type, std::vector<TallySpec>& all) {
  TallySpec tally;
  tally.where = table.where();
  tally.type = type;
  const bool needs = type != "count" && type != "crosstalk" && type != "ledger";
  if (type != "crosstalk") tally.faces = read_names(table, "face", needs);
  tally.name = table.string("name", type + (tally.faces.empty() ? "" : " at " + tally.faces.front().name));
  if (type == "crosstalk") {
    read_crosstalk(table, tally, all);
  } else if (type == "light_spread" || type == "irradiance") {
    const bool spread = type == "light_spread";
    tally.at = read_events(table, "at", spread ? kReaching : kThrough);
    tally.way = read_way(table, spread ? "both" : "out");
    tally.normal = table.optional_direction("normal");
    add_pixels(table, std::nullopt, tally);
  } else if (type == "angles") {
    read_angles(table, tally);
  } else if (type == "etendue") {
    read_etendue(table, tally);
  } else if (type == "ledger") {
    if (tally.faces.empty()) tally.faces = {{"*:*", table.where()}};
    tally.at = kAtInterface;
    tally.way = read_way(table, "out");
    tally.axes = {axis_of(TallyVariable::face), axis_of(TallyVariable::event)};
  } else {
    read_count(table, tally);
  }
  check_faces(table, tally);
  all.push_back(std::move(tally));
}

}  // namespace

void read_tallies(const config::TomlTable& root, SceneSpec& scene) {
  std::set<std::string> names;
  for (const config::TomlTable& table : root.tables("tally")) {
    const std::string type = table.choice("type", {"exit_angle", "count", "crosstalk", "light_spread",
                                                   "irradiance", "angles", "etendue", "ledger"});
    if (!table.good("type")) {
      table.skip();
      continue;
    }
    std::string name;
    if (type == "exit_angle") {
      scene.exit_angles.push_back(read_exit_angle(table, scene));
      name = scene.exit_angles.back().name;
    } else {
      read_tally(table, type, scene.tallies);
      name = scene.tallies.back().name;
    }
    if (!names.insert(name).second)
      table.report("name", "there are two tallies named \"" + name + "\"", "give each a name of its own");
  }
}

}  // namespace scintray::scene_file
