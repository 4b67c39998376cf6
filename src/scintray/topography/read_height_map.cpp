#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/topography/detail/readers/formats.hpp"
#include "scintray/topography/height_map.hpp"

namespace scintray::topography {

namespace {

/// Largest file, packed or not, that is read.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

std::string file_content(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path))
    throw core::InputError({{path.string()}, "no such file; expected a height map", ""});
  const auto size = std::filesystem::file_size(path);
  if (size > kMostBytes)
    throw core::InputError(
        {{path.string()}, "file larger than 1 GiB; expected a height map", "crop the map"});
  std::optional<std::string> content = core::read_whole_file(path);
  if (!content) throw core::SystemError("cannot read " + path.string());
  return *std::move(content);
}

[[noreturn]] void refuse_format(const std::string& file, GwyddionAnswer answer) {
  const std::string export_it = "export the height channel from the instrument's program as text or .gsf";
  std::string hint = export_it;
  if (answer == GwyddionAnswer::not_installed)
    hint = "install gwyddion, which reads many more formats and is run when it is installed, or " + export_it;
  if (answer == GwyddionAnswer::refused) hint = "Gwyddion does not read it either: " + export_it;
  if (answer == GwyddionAnswer::timed_out) hint = "Gwyddion did not finish reading it: " + export_it;
  throw core::InputError({{file}, "format not known; expected one of: " + format_names(), hint});
}

RawMap parse(const std::filesystem::path& path, const std::string& content, const ReadRequest& request,
             bool may_query_gwyddion) {
  if (content.empty())
    throw core::InputError({{request.file}, "the file is empty; expected a height map", ""});
  if (const Format* format = find_format(content)) return format->parse(content, request);
  if (!may_query_gwyddion) refuse_format(request.file, GwyddionAnswer::not_installed);
  GwyddionResult result = query_gwyddion(path, request);
  if (!result.map) refuse_format(request.file, result.answer);
  return std::move(*result.map);
}

void set_pitch(const ReadOptions& options, RawMap& map, const std::string& file, core::Problems& problems) {
  const auto positive = [&](const std::optional<double>& value, const std::string& name) {
    if (value && !(*value > 0.0 && std::isfinite(*value)))
      problems.add({file}, name + " is " + std::to_string(*value) + "; expected a positive length");
  };
  positive(options.pitch_um, "pitch");
  positive(options.width_um, "width");
  positive(options.height_unit_um, "height unit");
  if (options.pitch_um && options.width_um)
    problems.add({file}, "both pitch and width are given", "give one of them");
  if (options.pitch_um) map.pitch_x_um = map.pitch_y_um = options.pitch_um;
  if (options.width_um) {
    map.pitch_x_um = *options.width_um / map.columns;
    map.pitch_y_um = *map.pitch_x_um * map.pitch_ratio;
  }
  if (!map.pitch_x_um || !map.pitch_y_um)
    problems.add({file}, "the file has no lateral size in a unit of length",
                 "set it: --pitch \"0.175 um\" or --width \"90 um\"");
  else if (!std::isfinite(*map.pitch_x_um) || !(*map.pitch_x_um > 0.0) || !std::isfinite(*map.pitch_y_um) ||
           !(*map.pitch_y_um > 0.0))
    problems.add({file}, "the distance of points is not a positive number", "the header is damaged");
}

void set_unit(const ReadOptions& options, RawMap& map, const std::string& file, core::Problems& problems) {
  if (options.height_unit_um) map.height_unit_um = options.height_unit_um;
  if (map.height_unit_um) return;
  const std::string which = map.channel.empty() ? "heights" : "channel " + core::in_quotes(map.channel);
  if (trimmed(map.height_unit).empty())
    problems.add({file}, "the file has no unit of length for " + which, "set it: --unit um");
  else
    problems.add({file}, which + " is in " + core::in_quotes(map.height_unit) + "; expected a unit of length",
                 map.channels.size() > 1
                     ? "choose a height channel, or state the length of one of these units: --unit um"
                     : "state the length of one of these units: --unit um");
}

std::string shortest(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string place_of(std::size_t k, std::uint32_t columns) {
  return "column " + std::to_string(k % columns + 1) + ", row " + std::to_string(k / columns + 1);
}

/// Number of points without a height.
std::size_t missing_points(const HeightMap& map) {
  return static_cast<std::size_t>(
      std::count_if(map.heights_um.begin(), map.heights_um.end(), [](double h) { return std::isnan(h); }));
}

/// Heights in um; an infinite height is an error, a missing one remains NaN.
void scale_heights(HeightMap& map, double unit_um, const std::string& file) {
  for (std::size_t k = 0; k < map.heights_um.size(); ++k) {
    double& height = map.heights_um[k];
    height *= unit_um;
    if (std::isinf(height))
      throw core::InputError({{file},
                              "the height at " + place_of(k, map.columns) + " is infinite; expected a number",
                              "the file is damaged, or marks missing points so: write nan for them"});
  }
}

/// Throws for heights that no surface of this size has, most often metres read as if the sides were metres
/// too: light would be followed through millions of facets. Single wrong points do not count, which outlier
/// removal is for.
void require_plausible_relief(const HeightMap& map, const std::string& file) {
  constexpr double kTail = 0.01, kMostRatio = 100.0;
  std::vector<double> heights;
  for (const double height : map.heights_um)
    if (!std::isnan(height)) heights.push_back(height);
  const auto tail = static_cast<std::ptrdiff_t>(kTail * static_cast<double>(heights.size()));
  const auto low = heights.begin() + tail, high = heights.end() - 1 - tail;
  std::nth_element(heights.begin(), low, heights.end());
  const double lowest = *low;
  std::nth_element(heights.begin(), high, heights.end());
  const double range_um = *high - lowest;
  const double width_um = map.columns * map.pitch_x_um, length_um = map.rows * map.pitch_y_um;
  if (range_um <= kMostRatio * std::max(width_um, length_um)) return;
  throw core::InputError(
      {{file},
       "the heights span " + shortest(range_um) + " um on a map of " + shortest(width_um) + " x " +
           shortest(length_um) + " um, which is no surface",
       "heights and sides are in different units: state that of the heights, --unit um (in a scene "
       "height_unit = \"1 um\"), or the size of the map, --width"});
}

std::string source_step(const std::filesystem::path& path, const RawMap& raw, const ReadOptions& options) {
  std::string step = "read " + path.filename().string() + " (" + raw.format;
  if (!raw.channel.empty()) step += ", channel " + core::in_quotes(raw.channel);
  if (raw.channels.size() > 1) step += " of " + std::to_string(raw.channels.size());
  step += "), " + std::to_string(raw.columns) + " x " + std::to_string(raw.rows) + " points, pitch " +
          shortest(*raw.pitch_x_um) + " x " + shortest(*raw.pitch_y_um) + " um";
  if (options.height_unit_um)
    step += ", heights in units of " + shortest(*options.height_unit_um) + " um as given";
  return step;
}

}  // namespace

HeightMap read_height_map(const std::filesystem::path& path, const ReadOptions& options) {
  const ReadRequest request{path.string(), options.channel};
  std::string content = file_content(path);
  if (content.starts_with("\x1F\x8B")) content = gunzip(content, request.file, kMostBytes);
  RawMap raw = parse(path, content, request, options.query_gwyddion);
  content = {};
  core::Problems problems;
  set_pitch(options, raw, request.file, problems);
  set_unit(options, raw, request.file, problems);
  problems.throw_if_any();

  HeightMap map;
  map.columns = raw.columns;
  map.rows = raw.rows;
  map.pitch_x_um = *raw.pitch_x_um;
  map.pitch_y_um = *raw.pitch_y_um;
  map.title = raw.title;
  map.periodic = options.periodic;
  map.steps.push_back(source_step(path, raw, options));
  map.steps.insert(map.steps.end(), raw.notes.begin(), raw.notes.end());
  map.heights_um = std::move(raw.values);
  scale_heights(map, *raw.height_unit_um, request.file);
  if (const std::size_t missing = missing_points(map); missing == map.heights_um.size())
    throw core::InputError({{request.file}, "no point of the map has a height; expected a height map", ""});
  else if (missing > 0)
    map.steps.push_back(std::to_string(missing) + " of " + std::to_string(map.heights_um.size()) +
                        " points missing");
  require_plausible_relief(map, request.file);
  return map;
}

}  // namespace scintray::topography
