#include "scintray/cli/map_options.hpp"

#include <charconv>
#include <vector>

#include "scintray/cli/progress.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/units.hpp"
#include "scintray/core/words.hpp"

namespace scintray::cli {

namespace {

constexpr double kUmPerMm = 1000.0;

using LevelingKind = topography::Leveling::Kind;
constexpr core::Word<topography::Leveling> kLevelings[] = {{"none", {LevelingKind::none, 0}},
                                                           {"mean", {LevelingKind::mean, 0}},
                                                           {"plane", {LevelingKind::plane, 1}}};

topography::Leveling parse_leveling(const std::string& how) {
  if (const auto known = core::find_word(kLevelings, how)) return *known;
  constexpr std::string_view kPolynomial = "poly:";
  if (how.starts_with(kPolynomial) && how.size() == kPolynomial.size() + 1 && how.back() >= '0' &&
      how.back() <= '8')
    return {LevelingKind::polynomial, how.back() - '0'};
  throw core::InputError(
      {{}, "--level " + how + "; expected plane, mean, none or poly:N with N from 0 to 8", ""});
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    std::string part = text.substr(start, end - start);
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    parts.push_back(part);
    start = end + 1;
  }
  return parts;
}

std::optional<std::uint32_t> whole(const std::string& text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

decltype(topography::Preparation::crop) parse_crop(const std::string& text) {
  const std::vector<std::string> parts = split(text);
  if (parts.size() != 4)
    throw core::InputError(
        {{},
         "--crop \"" + text + "\"; expected X,Y,WIDTH,HEIGHT",
         "four numbers of points, as 10,0,256,256, or four lengths, as \"2 um,0 um,45 um,45 um\""});
  std::vector<std::uint32_t> points;
  for (const std::string& part : parts)
    if (const auto value = whole(part)) points.push_back(*value);
  if (points.size() == 4) return topography::CropBox{points[0], points[1], points[2], points[3]};
  return topography::CropLengths{length_um(parts[0]), length_um(parts[1]), length_um(parts[2]),
                                 length_um(parts[3])};
}

}  // namespace

double length_um(const std::string& text) {
  return core::parse_quantity(text, core::Dimension::length) * kUmPerMm;
}

void add_map_options(CLI::App& app, MapOptions& options) {
  app.add_option("map", options.map,
                 "Height map: .gwy, .gsf, .ibw, Nanoscope (.spm, .001), .mi, .sdf, .x3p, text (matrix, x y z "
                 "list, Gwyddion's export, profiler), also .gz; others through gwyddion where installed")
      ->required();
  app.add_option("--channel", options.channel,
                 "Channel of the file by name, as \"Height Sensor\"; without it, the height that a sensor "
                 "measured, else the height");
  app.add_option("--pitch", options.pitch,
                 "Distance of points where the file does not state it, as \"0.175 um\"");
  app.add_option("--width", options.width, "Width of the map where the file does not state it, as \"90 um\"");
  app.add_option("--unit", options.unit, "Unit of the heights where the file does not state it, as um");
  app.add_flag("--periodic", options.periodic, "The map is one period of a periodic surface");
}

topography::ReadOptions read_options(const MapOptions& options) {
  topography::ReadOptions read;
  if (!options.pitch.empty()) read.pitch_um = length_um(options.pitch);
  if (!options.width.empty()) read.width_um = length_um(options.width);
  if (!options.unit.empty())
    read.height_unit_um = core::unit_factor(options.unit, core::Dimension::length) * kUmPerMm;
  if (!options.channel.empty()) read.channel = options.channel;
  read.periodic = options.periodic;
  return read;
}

topography::HeightMap read_map(const MapOptions& options) {
  return with_progress("reading " + options.map,
                       [&] { return topography::read_height_map(options.map, read_options(options)); });
}

void add_preparation_options(CLI::App& app, PreparationOptions& options) {
  app.add_option("--crop", options.crop,
                 "Part of the map, X,Y,WIDTH,HEIGHT: points, as 10,0,256,256, or lengths, as \"2 um,0 um,45 "
                 "um,45 um\"");
  app.add_option(
         "--outliers", options.outliers,
         "Remove heights farther than this many robust standard deviations from the median around them, as 6")
      ->check(CLI::Range(1.0, 1e6));
  app.add_option("--outlier-radius", options.outlier_radius, "Pixels around a point in its median")
      ->check(CLI::Range(1, 50))
      ->capture_default_str();
  app.add_flag("--fill", options.fill, "Fill missing points by Laplace interpolation");
  app.add_option("--median", options.median, "Radius of a median filter, pixels")->check(CLI::Range(1, 50));
  app.add_option("--loess", options.loess,
                 "Width of the LOESS along lines against tip oscillation, as \"2 um\"");
  app.add_option("--gaussian", options.gaussian, "Standard deviation of a Gaussian filter, as \"0.3 um\"");
  app.add_option("--level", options.level, "plane, mean, none, or poly:N")->capture_default_str();
}

topography::Preparation preparation_of(const PreparationOptions& options) {
  topography::Preparation preparation;
  if (!options.crop.empty()) preparation.crop = parse_crop(options.crop);
  if (options.outliers > 0.0) preparation.outlier_limit = options.outliers;
  preparation.outlier_radius = options.outlier_radius;
  preparation.fill_missing = options.fill;
  if (options.median > 0) preparation.median_radius = options.median;
  if (!options.loess.empty()) preparation.loess_width_um = length_um(options.loess);
  if (!options.gaussian.empty()) preparation.gaussian_um = length_um(options.gaussian);
  preparation.leveling = parse_leveling(options.level);
  return preparation;
}

}  // namespace scintray::cli
