#include "scintray/scene_file/tally.hpp"

#include <algorithm>
#include <set>

#include "scintray/core/text.hpp"
#include "scintray/scene_file/detail/face_path.hpp"
#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

using Events = std::vector<core::StepEvent>;

const Events kReaching = {core::StepEvent::detected, core::StepEvent::not_detected};
const Events kThrough = {core::StepEvent::transmitted, core::StepEvent::detected,
                         core::StepEvent::not_detected};
const Events kAtInterface = {
    core::StepEvent::reflected,    core::StepEvent::transmitted,         core::StepEvent::detected,
    core::StepEvent::not_detected, core::StepEvent::absorbed_at_surface, core::StepEvent::absorbed_in_medium};

/// The table of a [[tally]], and the names to which it refers.
struct TallyTable {
  const config::TomlTable& table;
  const std::vector<PartSpec>& parts;
  const std::vector<std::string>& names;  ///< of all parts
  const TallyVariables& variables;
  std::string type;
};

Events read_events(const config::TomlTable& table, const std::string& key, const Events& fallback) {
  if (!table.has(key)) return fallback;
  const std::vector<std::string> words = core::word_list(kEventWords);
  Events events;
  for (const config::NameRef& name : read_names(table, key, false)) {
    const std::optional<core::StepEvent> event = core::find_word(kEventWords, name.name);
    const std::string near = core::nearest_word(name.name, words);
    table.expect(
        key, event.has_value(), "nothing that happens to a photon is called \"" + name.name + "\"",
        (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "there are " + core::list_of(words));
    if (!event) continue;
    events.push_back(*event);
    if (event == core::StepEvent::cut_interactions) events.push_back(core::StepEvent::cut_time);
  }
  return events;
}

std::int64_t read_bins(const config::TomlTable& table, const std::string& key, std::int64_t fallback,
                       const char* hint = "give a number of equal bins") {
  const std::int64_t bins = table.integer(key, fallback);
  table.expect(key, bins >= 1 && bins <= 9000, "the number of bins is not in 1 to 9000", hint);
  return bins;
}

/// A tally of a type with its name and optional faces.
TallySpec begin_tally(const TallyTable& from, bool needs_face) {
  TallySpec tally;
  tally.where = from.table.where();
  tally.type = from.type;
  tally.faces = read_names(from.table, "face", needs_face);
  tally.name =
      from.table.string("name", from.type + (tally.faces.empty() ? "" : " at " + tally.faces.front().name));
  return tally;
}

/// Two histograms of crossings of a face, over the angle in front of it and the angle behind it.
std::vector<TallySpec> read_exit_angle(const TallyTable& from) {
  const config::TomlTable& table = from.table;
  TallySpec tally;
  tally.where = table.where();
  tally.type = kExitAngle;
  const auto path = read_face_path(table, "face", table.string("face"), from.names, from.parts, false);
  tally.faces = {{path ? path->part.name + ":" + path->face.name : "", table.where("face")}};
  tally.name = table.string("name", tally.faces.front().name);
  tally.at = kThrough;
  if (table.boolean("detected_only", false)) {
    tally.each = TallyEach::last;
    tally.fate = {core::StepEvent::detected};
  }
  const std::int64_t bins = read_bins(table, "bins", 18, "give the number of equal bins over 0 to 90 deg");
  TallySpec beyond = tally;
  beyond.type = kExitAngleBeyond;
  beyond.name = beyond_name(tally.name);
  tally.axes = {binned_axis(from.variables.at("angle_before"), bins)};
  beyond.axes = {binned_axis(from.variables.at("angle_after"), bins)};
  return {std::move(beyond), std::move(tally)};
}

/// The crosstalk matrix, and the light of each part.
std::vector<TallySpec> read_crosstalk(const TallyTable& from) {
  const config::TomlTable& table = from.table;
  TallySpec tally;
  tally.where = table.where();
  tally.type = from.type;
  tally.name = table.string("name", from.type);
  const std::vector<config::NameRef> sources = read_names(table, "source_part", false);
  tally.at = read_events(table, "at", {core::StepEvent::detected});
  tally.axes = {named_axis(from.variables.at("source_part"), sources),
                named_axis(from.variables.at("part"), read_names(table, "part", false))};
  TallySpec emitted = tally;
  emitted.name += ": emitted";
  emitted.type = kCrosstalkEmitted;
  emitted.at = {core::StepEvent::emitted};
  emitted.axes.pop_back();
  return {std::move(emitted), std::move(tally)};
}

std::vector<TallySpec> read_grid(const TallyTable& from, const Events& at, FaceWay way) {
  TallySpec tally = begin_tally(from, true);
  tally.at = read_events(from.table, "at", at);
  tally.way = from.table.choice("way", kFaceWays, way);
  tally.normal = from.table.optional_direction("normal");
  tally.axes = read_pixels(from.table, from.variables, std::nullopt);
  return {std::move(tally)};
}

std::vector<TallySpec> read_light_spread(const TallyTable& from) {
  return read_grid(from, kReaching, FaceWay::both);
}

std::vector<TallySpec> read_irradiance(const TallyTable& from) {
  return read_grid(from, kThrough, FaceWay::out);
}

/// Adds the axes of directions at a face, over equal parts of the hemisphere.
void add_hemisphere(const TallyTable& from, std::int64_t polar, std::int64_t azimuth, TallySpec& tally) {
  const bool inside = from.table.boolean("inside", false);
  tally.axes.push_back(binned_axis(from.variables.at(inside ? "sin2_before" : "sin2_after"),
                                   read_bins(from.table, "polar_bins", polar)));
  tally.axes.push_back(binned_axis(from.variables.at(inside ? "azimuth_before" : "azimuth_after"),
                                   read_bins(from.table, "azimuth_bins", azimuth)));
}

std::vector<TallySpec> read_angles(const TallyTable& from) {
  TallySpec tally = begin_tally(from, true);
  tally.at = read_events(from.table, "at", kThrough);
  tally.way = from.table.choice("way", kFaceWays, FaceWay::out);
  add_hemisphere(from, 20, 36, tally);
  return {std::move(tally)};
}

std::vector<TallySpec> read_etendue(const TallyTable& from) {
  TallySpec tally = begin_tally(from, true);
  tally.at = read_events(from.table, "at", kThrough);
  tally.way = from.table.choice("way", kFaceWays, FaceWay::out);
  tally.axes = read_pixels(from.table, from.variables, 8);
  add_hemisphere(from, 8, 8, tally);
  return {std::move(tally)};
}

std::vector<TallySpec> read_ledger(const TallyTable& from) {
  TallySpec tally = begin_tally(from, false);
  if (tally.faces.empty()) tally.faces = {{"*:*", from.table.where()}};
  tally.at = kAtInterface;
  tally.way = from.table.choice("way", kFaceWays, FaceWay::arriving);
  tally.axes = {named_axis(from.variables.at("face")), named_axis(from.variables.at("occasion"))};
  return {std::move(tally)};
}

TallyVariablePtr read_score(const config::TomlTable& table, const TallyVariables& variables) {
  std::vector<std::string> words =
      variables.names([](const TallyVariable& variable) { return variable.is_score(); });
  words.insert(words.begin(), kPhotonScore);
  return variables.find(table.choice("score", words, words.front()));
}

std::vector<TallySpec> read_count(const TallyTable& from) {
  const config::TomlTable& table = from.table;
  TallySpec tally = begin_tally(from, false);
  tally.at = read_events(table, "at", {});
  if (!table.has("at")) table.report("at", "a count needs to know of what", "add at = \"detected\"");
  tally.way = table.choice("way", kFaceWays, FaceWay::out);
  table.expect("way", !tally.faces.empty(), "a way without a face", "add face = \"part:face\"");
  tally.parts = read_names(table, "part", false);
  tally.source_parts = read_names(table, "source_part", false);
  tally.visited = read_names(table, "visited", false);
  tally.not_visited = read_names(table, "not_visited", false);
  tally.fate = read_events(table, "fate", {});
  tally.each = table.choice("each", kTallyEach, TallyEach::time);
  tally.score = read_score(table, from.variables);
  for (const config::TomlTable& range : table.tables("where"))
    tally.ranges.push_back(read_tally_range(range, from.variables));
  for (const config::TomlTable& axis : table.tables("axes"))
    tally.axes.push_back(read_tally_axis(axis, from.variables, !tally.faces.empty()));
  return {std::move(tally)};
}

/// Reads a type's table: the tally that has its name last, its companions before it.
using ReadType = std::vector<TallySpec> (*)(const TallyTable&);
constexpr core::Word<ReadType> kTypes[] = {
    {kExitAngle, read_exit_angle},   {"count", read_count},
    {kCrosstalk, read_crosstalk},    {"light_spread", read_light_spread},
    {"irradiance", read_irradiance}, {"angles", read_angles},
    {kEtendue, read_etendue},        {"ledger", read_ledger}};

/// Reports contradictions: faces for events away from faces, directions at a face without one.
void check_faces(const config::TomlTable& table, const TallySpec& tally) {
  const bool away = std::any_of(tally.at.begin(), tally.at.end(),
                                [](core::StepEvent event) { return !core::is_at_boundary(event); });
  table.expect("face", !away, "a face for what does not happen at faces",
               "at a face photons are returned, crossed, detected, unconverted or absorbed");
  if (!tally.faces.empty()) return;
  const auto require_face = [&](const std::string& what, const TallyVariable& variable) {
    if (variable.at_face)
      table.report("face", what + variable.name + " needs a face", "add face = \"part:face\"");
  };
  for (const TallyAxisSpec& axis : tally.axes) require_face("an axis of ", *axis.variable);
  for (const TallyRangeSpec& range : tally.ranges) require_face("a condition on ", *range.variable);
  if (tally.score) require_face("a sum of ", *tally.score);
}

}  // namespace

bool TallySpec::detected_only() const {
  return each == TallyEach::last && fate == Events{core::StepEvent::detected};
}

std::vector<TallySpec> read_tallies(const config::TomlTable& root, const std::vector<PartSpec>& parts,
                                    const std::vector<std::string>& names, const TallyVariables& variables) {
  std::vector<TallySpec> all;
  std::set<std::string> taken;
  for (const config::TomlTable& table : root.tables("tally")) {
    const ReadType read = table.choice("type", kTypes);
    if (!table.good("type")) {
      table.skip();
      continue;
    }
    std::vector<TallySpec> tallies = read({table, parts, names, variables, core::word_of(kTypes, read)});
    const TallySpec& named = tallies.back();
    check_faces(table, named);
    if (!taken.insert(named.name).second)
      table.report("name", "there are two tallies named \"" + named.name + "\"",
                   "give each a name of its own");
    std::move(tallies.begin(), tallies.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace scintray::scene_file
