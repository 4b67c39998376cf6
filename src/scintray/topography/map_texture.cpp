#include "scintray/topography/map_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scintray/core/error.hpp"
#include "scintray/topography/detail/fourier.hpp"
#include "scintray/topography/detail/missing_points.hpp"

namespace scintray::topography {

namespace {

constexpr int kDirections = 180;
/// ISO 25178-3:2012, 4.3: the default value to which the autocorrelation is followed.
constexpr double kFallenTo = 0.2;
constexpr double kResolvedRatio = 0.9, kLeastLengths = 10.0;

/// Heights less their mean, zero where they are missing.
std::vector<double> centred(const HeightMap& map) {
  double sum = 0.0;
  for (const double h : map.heights_um)
    if (!std::isnan(h)) sum += h;
  const double mean = sum / static_cast<double>(map.heights_um.size() - count_missing(map));
  std::vector<double> result;
  result.reserve(map.heights_um.size());
  for (const double h : map.heights_um) result.push_back(std::isnan(h) ? 0.0 : h - mean);
  return result;
}

/// Sums of products with the same values at each lag, on a grid padded with zeros so that the lags
/// do not wrap around.
std::vector<double> self_products(const std::vector<double>& values, const HeightMap& map,
                                  std::uint32_t columns, std::uint32_t rows) {
  std::vector<double> padded(std::size_t{columns} * rows, 0.0);
  for (std::uint32_t j = 0; j < map.rows; ++j)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(std::size_t{j} * map.columns), map.columns,
                padded.begin() + static_cast<std::ptrdiff_t>(std::size_t{j} * columns));
  HalfSpectrum spectrum = fourier_transform(padded, columns, rows);
  for (auto& term : spectrum.values) term = std::norm(term);
  return inverse_fourier_transform(spectrum);
}

struct Fall {
  double lag_um;
  bool reached;  ///< false: the autocorrelation is still above the level at that lag, the longest
};

/// The first lag at which a function of it, 1 at 0, has fallen to `level`.
template <class Function>
Fall fall_to(double level, double longest_um, double step_um, const Function& function) {
  double before = 1.0;
  for (double lag = step_um; lag <= longest_um; lag += step_um) {
    const double now = function(lag);
    if (now <= level) return {lag - step_um * (level - now) / (before - now), true};
    before = now;
  }
  return {longest_um, false};
}

std::array<double, kDirections> cosines() {
  std::array<double, kDirections> result;
  for (int k = 0; k < kDirections; ++k) result[static_cast<std::size_t>(k)] = std::cos(k * core::kDegree);
  return result;
}

void fill_lengths(const HeightMap& map, MapTexture& texture) {
  const Autocorrelation correlation(map);
  const double step = 0.25 * std::min(map.pitch_x_um, map.pitch_y_um);
  const double nearest = std::min(correlation.reach_x_um(), correlation.reach_y_um());
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  bool all_reached = true;
  for (int k = 0; k < kDirections; ++k) {
    const double c = std::cos(k * core::kDegree), s = std::sin(k * core::kDegree);
    const double reach = std::min(correlation.reach_x_um() / std::max(std::abs(c), 1e-9),
                                  correlation.reach_y_um() / std::max(std::abs(s), 1e-9));
    const Fall fall =
        fall_to(kFallenTo, reach, step, [&](double lag) { return correlation.at(lag * c, lag * s); });
    if (fall.reached) shortest = std::min(shortest, fall.lag_um);
    longest = std::max(longest, fall.lag_um);
    all_reached = all_reached && fall.reached;
  }
  if (std::isfinite(shortest)) {
    texture.sal_um = shortest;
    texture.str = std::min(1.0, shortest / longest);
    texture.str_is_bound = !all_reached;
  }
  const auto cosine = cosines();
  const Fall mean = fall_to(std::exp(-1.0), nearest, step, [&](double lag) {
    double sum = 0.0;
    for (int k = 0; k < kDirections; ++k)
      sum += correlation.at(lag * cosine[static_cast<std::size_t>(k)], lag * std::sin(k * core::kDegree));
    return sum / kDirections;
  });
  if (mean.reached) texture.correlation_length_um = mean.lag_um;
}

double hann(std::uint32_t k, std::uint32_t n) { return 0.5 - 0.5 * std::cos(core::kTwoPi * (k + 0.5) / n); }

/// Direction perpendicular to that of most power.
std::optional<double> lay_direction(const HeightMap& map) {
  std::vector<double> heights = centred(map);
  if (!map.periodic)
    for (std::uint32_t j = 0; j < map.rows; ++j)
      for (std::uint32_t i = 0; i < map.columns; ++i)
        heights[std::size_t{j} * map.columns + i] *= hann(i, map.columns) * hann(j, map.rows);
  const HalfSpectrum spectrum = fourier_transform(heights, map.columns, map.rows);
  const double highest = 0.5 / std::max(map.pitch_x_um, map.pitch_y_um);
  const double width = std::min(map.columns * map.pitch_x_um, map.rows * map.pitch_y_um);
  const double lowest = map.periodic ? 0.0 : 2.0 / width;

  struct Term {
    double angle, power;
  };
  std::vector<Term> terms;
  std::array<double, kDirections> sector{};
  for (std::uint32_t l = 0; l < map.rows; ++l)
    for (std::uint32_t k = 0; k < spectrum.kept(); ++k) {
      const double fx = spatial_frequency(k, map.columns, map.pitch_x_um);
      const double fy = spatial_frequency(l, map.rows, map.pitch_y_um);
      const double f = std::hypot(fx, fy);
      if (f == 0.0 || f < lowest || f > highest) continue;
      const double across = std::atan2(fy, fx) + 0.5 * core::kPi;  // in [0, pi], fx being positive
      const double angle = across >= core::kPi ? across - core::kPi : across;
      terms.push_back({angle, spectrum.weight(k) * std::norm(spectrum.at(k, l))});
      sector[std::min<std::size_t>(kDirections - 1, static_cast<std::size_t>(angle / core::kDegree))] +=
          terms.back().power;
    }
  constexpr int kHalf = 2;
  double most = 0.0;
  int best = 0;
  for (int k = 0; k < kDirections; ++k) {
    double sum = 0.0;
    for (int d = -kHalf; d <= kHalf; ++d)
      sum += sector[static_cast<std::size_t>((k + d + kDirections) % kDirections)];
    if (sum > most) {
      most = sum;
      best = k;
    }
  }
  if (!(most > 0.0)) return std::nullopt;
  // A map has few terms in few directions: the middle of the power about the maximum is more precise than the
  // sector itself. The weight falls smoothly, so that no term jumps in or out.
  constexpr int kRounds = 30;
  double angle = (best + 0.5) * core::kDegree;
  for (int round = 0; round < kRounds; ++round) {
    double moment = 0.0, power = 0.0;
    for (const Term& term : terms) {
      const double off = std::remainder(term.angle - angle, core::kPi);
      if (std::abs(off) > 0.25 * core::kPi) continue;
      const double weight = std::pow(std::cos(2.0 * off), 2) * term.power;
      moment += weight * off;
      power += weight;
    }
    angle += moment / power;
  }
  return angle - core::kPi * std::floor(angle / core::kPi);
}

}  // namespace

Autocorrelation::Autocorrelation(const HeightMap& map)
    : columns_(map.periodic ? map.columns : quick_size(2 * map.columns)),
      rows_(map.periodic ? map.rows : quick_size(2 * map.rows)),
      pitch_x_um_(map.pitch_x_um),
      pitch_y_um_(map.pitch_y_um),
      reach_x_um_(0.5 * map.columns * map.pitch_x_um),
      reach_y_um_(0.5 * map.rows * map.pitch_y_um) {
  std::vector<double> known;
  known.reserve(map.heights_um.size());
  for (const double h : map.heights_um) known.push_back(std::isnan(h) ? 0.0 : 1.0);
  values_ = self_products(centred(map), map, columns_, rows_);
  const std::vector<double> pairs = self_products(known, map, columns_, rows_);
  const double square = values_[0] / pairs[0];
  // Counts are whole numbers up to rounding; at a lag without pairs of points the value is undefined.
  for (std::size_t k = 0; k < values_.size(); ++k)
    values_[k] = pairs[k] > 0.5 ? values_[k] / (pairs[k] * square) : std::nan("");
}

double Autocorrelation::value(long i, long j) const {
  const long columns = static_cast<long>(columns_), rows = static_cast<long>(rows_);
  return values_[static_cast<std::size_t>(((j % rows) + rows) % rows) * columns_ +
                 static_cast<std::size_t>(((i % columns) + columns) % columns)];
}

double Autocorrelation::at(double x_um, double y_um) const {
  const double x = x_um / pitch_x_um_, y = y_um / pitch_y_um_;
  const double i = std::floor(x), j = std::floor(y);
  const auto k = static_cast<long>(i), l = static_cast<long>(j);
  return std::lerp(std::lerp(value(k, l), value(k + 1, l), x - i),
                   std::lerp(value(k, l + 1), value(k + 1, l + 1), x - i), y - j);
}

MapTexture map_texture(const HeightMap& map) {
  MapTexture texture;
  if (!(map_statistics(map).sq_um > 0.0)) return texture;
  fill_lengths(map, texture);
  texture.std_rad = lay_direction(map);
  return texture;
}

std::vector<std::string> map_warnings(const HeightMap& map, const MapStatistics& statistics,
                                      const MapTexture& texture) {
  std::vector<std::string> warnings;
  const double fall = 1.0 - statistics.slope_ratio_at_two_pitches;
  if (fall > 1.0 - kResolvedRatio)
    warnings.push_back(fmt::format(
        "the map is too coarse for its roughness, or noisy: over two pitches the rms slope is {:.0f} % lower "
        "than over one, so it depends on the pitch",
        100.0 * fall));
  const double width = std::min(map.columns * map.pitch_x_um, map.rows * map.pitch_y_um);
  if (!texture.sal_um && statistics.sq_um > 0.0)
    warnings.emplace_back(
        "the map is too small: its autocorrelation does not fall to 0.2 within half the map; level it, or "
        "measure a larger field");
  if (texture.sal_um && width / *texture.sal_um < kLeastLengths)
    warnings.push_back(fmt::format(
        "the map is too small: its shorter side holds {:.1f} autocorrelation lengths (Sal); with fewer than "
        "{:.0f} another field of the same surface may differ visibly",
        width / *texture.sal_um, kLeastLengths));
  if (statistics.missing > 0)
    warnings.push_back(fmt::format(
        "{} points ({:.2g} %) have no height: light cannot be traced before they "
        "are filled or cropped",
        statistics.missing,
        100.0 * static_cast<double>(statistics.missing) / static_cast<double>(map.heights_um.size())));
  return warnings;
}

}  // namespace scintray::topography
