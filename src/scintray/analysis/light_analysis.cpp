#include "scintray/analysis/light_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/scene_file/tally.hpp"

namespace scintray::analysis {

namespace {

core::InputError wrong_tally(const tally::TallyResult& tally, const std::string& what) {
  return core::InputError(
      core::Problem{{}, "the tally \"" + tally.name + "\" " + what, "name a tally of that type"});
}

std::vector<std::uint64_t> counts_of(const tally::TallyResult& tally) {
  std::vector<std::uint64_t> counts;
  for (const double count : tally.sum) counts.push_back(static_cast<std::uint64_t>(count));
  return counts;
}

/// Angle below which a share of the histogram lies, and its error.
core::Estimate quantile(const std::vector<std::uint64_t>& counts, double share, double total) {
  const double width = 0.5 * core::kPi / static_cast<double>(counts.size());
  double below = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto here = static_cast<double>(counts[i]);
    if (below + here < share * total) {
      below += here;
      continue;
    }
    const double angle = width * (static_cast<double>(i) + (share * total - below) / here);
    const double density = here / (total * width);
    return {angle, std::hypot(std::sqrt(share * (1.0 - share) / total) / density, width / std::sqrt(12.0))};
  }
  return {0.5 * core::kPi, width};
}

/// Sums across all axes but one.
std::vector<double> marginal(const tally::TallyResult& tally, std::size_t axis) {
  const std::size_t columns = tally.axes[1].bins();
  std::vector<double> sums(tally.axes[axis].bins(), 0.0);
  for (std::size_t bin = 0; bin < tally.sum.size(); ++bin)
    sums[axis == 0 ? bin / columns : bin % columns] += tally.sum[bin];
  return sums;
}

double full_width_at_half_maximum(const std::vector<double>& sums, const std::vector<double>& edges) {
  const std::size_t peak =
      static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin());
  const double half = 0.5 * sums[peak];
  const auto centre = [&](std::size_t i) { return 0.5 * (edges[i] + edges[i + 1]); };
  double low = edges.front(), high = edges.back();
  for (std::size_t i = peak; i > 0; --i)
    if (sums[i - 1] <= half) {
      low = centre(i) - (sums[i] - half) / (sums[i] - sums[i - 1]) * (centre(i) - centre(i - 1));
      break;
    }
  for (std::size_t i = peak; i + 1 < sums.size(); ++i)
    if (sums[i + 1] <= half) {
      high = centre(i) + (sums[i] - half) / (sums[i] - sums[i + 1]) * (centre(i + 1) - centre(i));
      break;
    }
  return high - low;
}

}  // namespace

const tally::TallyResult& find_tally(const tally::PointResult& point, const std::string& name) {
  std::vector<std::string> names;
  for (const tally::TallyResult& tally : point.tallies) {
    if (tally.name == name) return tally;
    names.push_back(tally.name);
  }
  if (names.empty())
    throw core::InputError(core::Problem{
        {}, "this result has no tallies", "add [[tally]] tables to the scene and run it again"});
  throw core::InputError(core::unknown_name({}, "tally", name, names));
}

Crosstalk read_crosstalk(const tally::PointResult& point, const std::string& name) {
  const tally::TallyResult& matrix = find_tally(point, name);
  if (matrix.type != "crosstalk") throw wrong_tally(matrix, "is no crosstalk matrix");
  const tally::TallyResult& emitted = find_tally(point, name + ": emitted");
  Crosstalk crosstalk;
  crosstalk.sources = matrix.axes[0].names;
  crosstalk.sensors = matrix.axes[1].names;
  for (std::size_t row = 0; row < crosstalk.sources.size(); ++row) {
    crosstalk.emitted.push_back(static_cast<std::uint64_t>(emitted.sum[row]));
    std::vector<core::Estimate> shares;
    for (std::size_t column = 0; column < crosstalk.sensors.size(); ++column) {
      const double count = matrix.sum[row * crosstalk.sensors.size() + column];
      shares.push_back(core::binomial_estimate(static_cast<std::uint64_t>(count), crosstalk.emitted.back()));
    }
    crosstalk.share.push_back(std::move(shares));
  }
  return crosstalk;
}

std::vector<CrossingAngles> crossing_angles(const tally::PointResult& point) {
  std::vector<CrossingAngles> all;
  for (const tally::TallyResult& inside : point.tallies) {
    if (inside.type != scene_file::kExitAngle) continue;
    const auto beyond =
        std::find_if(point.tallies.begin(), point.tallies.end(), [&](const tally::TallyResult& other) {
          return other.type == scene_file::kExitAngleBeyond &&
                 other.name == scene_file::beyond_name(inside.name);
        });
    if (beyond == point.tallies.end())
      throw core::InternalError("the exit angle tally \"" + inside.name + "\" has no second histogram");
    all.push_back(
        {inside.name, inside.faces.front(), inside.detected_only, counts_of(inside), counts_of(*beyond)});
  }
  return all;
}

std::vector<tally::TallyResult> tallies_of(const CrossingAngles& angles) {
  const auto tally_of = [&](const char* type, const std::string& name, const char* variable,
                            const std::vector<std::uint64_t>& counts) {
    tally::TallyResult tally;
    tally.name = name;
    tally.type = type;
    tally.score = "photons";
    tally.unit = "1";
    tally.faces = {angles.face};
    tally.detected_only = angles.detected_only;
    tally.axes.push_back({variable, "rad", {}, {}, {}});
    for (std::size_t i = 0; i <= counts.size(); ++i)
      tally.axes[0].edges.push_back(0.5 * core::kPi * static_cast<double>(i) /
                                    static_cast<double>(counts.size()));
    tally.sum.assign(counts.begin(), counts.end());
    tally.sum_of_squares = tally.sum;
    return tally;
  };
  return {tally_of(scene_file::kExitAngleBeyond, scene_file::beyond_name(angles.name), "angle_after",
                   angles.outside),
          tally_of(scene_file::kExitAngle, angles.name, "angle_before", angles.inside)};
}

Divergence divergence(const std::vector<std::uint64_t>& counts) {
  Divergence result;
  result.photons = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  if (result.photons == 0) return result;
  const auto total = static_cast<double>(result.photons);
  result.half_rad = quantile(counts, 0.5, total);
  result.ninety_rad = quantile(counts, 0.9, total);
  const double width = 0.5 * core::kPi / static_cast<double>(counts.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double cosine = std::cos(width * (static_cast<double>(i) + 0.5));
    sum += static_cast<double>(counts[i]) * cosine;
    squares += static_cast<double>(counts[i]) * cosine * cosine;
  }
  const double mean = sum / total;
  result.mean_cosine = {mean, std::sqrt(std::max(0.0, squares / total - mean * mean) / total)};
  return result;
}

LightSpread light_spread(const tally::TallyResult& tally) {
  const auto is_position = [](const tally::TallyAxis& axis) { return axis.variable == "position"; };
  if (tally.axes.size() != 2 || !std::all_of(tally.axes.begin(), tally.axes.end(), is_position))
    throw wrong_tally(tally, "is no grid of positions");
  LightSpread spread;
  spread.photons = std::accumulate(tally.sum.begin(), tally.sum.end(), 0.0);
  if (spread.photons <= 0.0) return spread;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::vector<double>& edges = tally.axes[axis].edges;
    const std::vector<double> sums = marginal(tally, axis);
    double first = 0.0, second = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double x = 0.5 * (edges[i] + edges[i + 1]);
      first += sums[i] * x;
      second += sums[i] * x * x;
    }
    spread.centre_mm[axis] = first / spread.photons;
    spread.rms_mm[axis] =
        std::sqrt(std::max(0.0, second / spread.photons - spread.centre_mm[axis] * spread.centre_mm[axis]));
    spread.centre_error_mm[axis] = spread.rms_mm[axis] / std::sqrt(spread.photons);
    spread.fwhm_mm[axis] = full_width_at_half_maximum(sums, edges);
  }
  return spread;
}

Etendue read_etendue(const tally::TallyResult& tally) {
  if (tally.type != "etendue") throw wrong_tally(tally, "is no etendue");
  if (tally.index <= 0.0)
    throw wrong_tally(tally, "has directions in media of several indices, or in an opaque part");
  Etendue result;
  result.index = tally.index;
  const auto span = [&](std::size_t axis) {
    return tally.axes[axis].edges.back() - tally.axes[axis].edges.front();
  };
  // dOmega cos(theta) = d(sin^2 theta) dphi / 2
  result.grid_mm2_sr = tally.index * tally.index * span(0) * span(1) * 0.5 * span(2) * span(3);
  const double bin = result.grid_mm2_sr / static_cast<double>(tally.sum.size());
  double n = 0.0, pairs = 0.0, triples = 0.0;
  for (const double count : tally.sum) {
    n += count;
    pairs += count * (count - 1.0);
    triples += count * (count - 1.0) * (count - 2.0);
  }
  if (pairs <= 0.0)
    throw core::InputError(core::Problem{{},
                                         "the tally \"" + tally.name + "\" has no two photons in one bin",
                                         "trace more photons, or use fewer bins"});
  const double square = pairs / (n * (n - 1.0));              // sum of p^2
  const double cube = triples / (n * (n - 1.0) * (n - 2.0));  // sum of p^3
  const double variance = 4.0 * (n - 2.0) / (n * (n - 1.0)) * std::max(0.0, cube - square * square) +
                          2.0 / (n * (n - 1.0)) * std::max(0.0, square - square * square);
  result.filled_mm2_sr = {bin / square, bin / square * std::sqrt(variance) / square};
  return result;
}

}  // namespace scintray::analysis
