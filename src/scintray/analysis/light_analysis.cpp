#include "scintray/analysis/light_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "scintray/core/error.hpp"
#include "scintray/core/function_ref.hpp"
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

using Quantity = core::FunctionRef<std::optional<double>(const std::vector<double>& sums)>;

/// Number of the groups of events: of fewer events than groups the last ones are empty.
std::size_t groups_with_events(const std::vector<double>& groups, std::size_t bins) {
  const auto last = std::find_if(groups.rbegin(), groups.rend(), [](double sum) { return sum > 0.0; });
  return (static_cast<std::size_t>(groups.rend() - last) + bins - 1) / bins;
}

/// Error of a quantity of the sums of all bins, from those of groups of events: by leaving out each group.
/// Nothing with fewer than two groups, or where the quantity is not defined without one.
std::optional<double> error_by_events(const std::vector<double>& sums, const std::vector<double>& groups,
                                      Quantity quantity) {
  const std::size_t count = groups_with_events(groups, sums.size());
  if (count < 2) return std::nullopt;
  std::vector<double> without, left(sums.size());
  for (std::size_t group = 0; group < count; ++group) {
    for (std::size_t bin = 0; bin < sums.size(); ++bin)
      left[bin] = sums[bin] - groups[group * sums.size() + bin];
    const std::optional<double> value = quantity(left);
    if (!value) return std::nullopt;
    without.push_back(*value);
  }
  return core::jackknife_error(without);
}

double sum_of(const std::vector<double>& sums) { return std::accumulate(sums.begin(), sums.end(), 0.0); }

/// Angle below which a share of a histogram lies, and the density of the light there, per radian.
struct Quantile {
  double angle = 0.5 * core::kPi, density = 0.0;
};
std::optional<Quantile> quantile(const std::vector<double>& counts, double share) {
  const double width = 0.5 * core::kPi / static_cast<double>(counts.size());
  const double total = sum_of(counts);
  double below = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (below + counts[i] < share * total || counts[i] <= 0.0) {
      below += counts[i];
      continue;
    }
    return Quantile{width * (static_cast<double>(i) + (share * total - below) / counts[i]),
                    counts[i] / (total * width)};
  }
  return std::nullopt;
}

/// Mean of the cosine over a histogram, and its variance.
struct Cosine {
  double mean = 0.0, variance = 0.0;
};
std::optional<Cosine> cosine_of(const std::vector<double>& counts) {
  const double total = sum_of(counts);
  if (total <= 0.0) return std::nullopt;
  const double width = 0.5 * core::kPi / static_cast<double>(counts.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double cosine = std::cos(width * (static_cast<double>(i) + 0.5));
    sum += counts[i] * cosine;
    squares += counts[i] * cosine * cosine;
  }
  const double mean = sum / total;
  return Cosine{mean, std::max(0.0, squares / total - mean * mean)};
}

/// Sums of a grid across all axes but one.
std::vector<double> marginal(const tally::TallyResult& tally, const std::vector<double>& grid,
                             std::size_t axis) {
  const std::size_t columns = tally.axes[1].bins();
  std::vector<double> sums(tally.axes[axis].bins(), 0.0);
  for (std::size_t bin = 0; bin < grid.size(); ++bin)
    sums[axis == 0 ? bin / columns : bin % columns] += grid[bin];
  return sums;
}

/// Mean and mean square of the centres of bins.
struct PositionMoments {
  double mean = 0.0, mean_square = 0.0;
};
std::optional<PositionMoments> spread_of(const std::vector<double>& sums, const std::vector<double>& edges) {
  const double total = sum_of(sums);
  if (total <= 0.0) return std::nullopt;
  PositionMoments spread;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double x = 0.5 * (edges[i] + edges[i + 1]);
    spread.mean += sums[i] / total * x;
    spread.mean_square += sums[i] / total * x * x;
  }
  return spread;
}

/// A bin of a tally of photons.
struct Bin {
  const tally::TallyResult& tally;
  std::size_t number;

  double sum() const { return tally.sum[number]; }
  bool has_groups() const { return !tally.group_sums.empty(); }
  double group(std::size_t group) const { return tally.group_sums[group * tally.sum.size() + number]; }
};

/// The photons of one bin over those of another.
core::Estimate share_of(const Bin& of, const Bin& all) {
  const auto count = static_cast<std::uint64_t>(of.sum());
  core::Estimate share = core::binomial_estimate(count, static_cast<std::uint64_t>(all.sum()));
  if (!of.has_groups() || !all.has_groups() || count == 0) return share;
  std::vector<double> groups;
  for (std::size_t group = 0; group < tally::kEventGroups; ++group)
    groups.insert(groups.end(), {of.group(group), all.group(group)});
  const auto ratio = [](const std::vector<double>& left) -> std::optional<double> {
    return left[1] > 0.0 ? std::optional(left[0] / left[1]) : std::nullopt;
  };
  share.error = error_by_events({of.sum(), all.sum()}, groups, ratio).value_or(share.error);
  return share;
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
  if (matrix.type != scene_file::kCrosstalk) throw wrong_tally(matrix, "is not a crosstalk matrix");
  const tally::TallyResult& emitted = find_tally(point, name + ": emitted");
  Crosstalk crosstalk;
  crosstalk.sources = matrix.axes[0].names;
  crosstalk.sensors = matrix.axes[1].names;
  for (std::size_t row = 0; row < crosstalk.sources.size(); ++row) {
    crosstalk.emitted.push_back(static_cast<std::uint64_t>(emitted.sum[row]));
    std::vector<core::Estimate> shares;
    for (std::size_t column = 0; column < crosstalk.sensors.size(); ++column)
      shares.push_back(share_of({matrix, row * crosstalk.sensors.size() + column}, {emitted, row}));
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
    all.push_back({inside.name, inside.faces.front(), inside.detected_only, counts_of(inside),
                   counts_of(*beyond), inside.group_sums, beyond->group_sums});
  }
  return all;
}

std::vector<tally::TallyResult> tallies_of(const CrossingAngles& angles) {
  const auto tally_of = [&](const char* type, const std::string& name, const char* variable,
                            const std::vector<std::uint64_t>& counts, const std::vector<double>& groups) {
    tally::TallyResult tally;
    tally.name = name;
    tally.type = type;
    tally.score = "photons";
    tally.unit = "1";
    tally.faces = {angles.face};
    tally.detected_only = angles.detected_only;
    tally.axes.push_back({variable, "rad", {}, {}, {}});
    // The numbers that the run itself has.
    const double right_angle = 0.5 * core::kPi, per_bin = static_cast<double>(counts.size()) / right_angle;
    for (std::size_t i = 0; i < counts.size(); ++i)
      tally.axes[0].edges.push_back(static_cast<double>(i) / per_bin);
    tally.axes[0].edges.push_back(right_angle);
    tally.sum.assign(counts.begin(), counts.end());
    tally.sum_of_squares = tally.sum;
    tally.group_sums = groups;
    return tally;
  };
  return {tally_of(scene_file::kExitAngleBeyond, scene_file::beyond_name(angles.name), "angle_after",
                   angles.outside, angles.outside_groups),
          tally_of(scene_file::kExitAngle, angles.name, "angle_before", angles.inside, angles.inside_groups)};
}

Divergence divergence(const std::vector<std::uint64_t>& counts, const std::vector<double>& groups) {
  Divergence result;
  result.photons = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  if (result.photons == 0) return result;
  const auto total = static_cast<double>(result.photons);
  const std::vector<double> sums(counts.begin(), counts.end());
  const double binning = 0.5 * core::kPi / static_cast<double>(counts.size()) / std::sqrt(12.0);
  const auto angle_with = [&](double share) -> core::Estimate {
    const Quantile at = quantile(sums, share).value();
    const auto angle = [share](const std::vector<double>& left) -> std::optional<double> {
      const std::optional<Quantile> found = quantile(left, share);
      return found ? std::optional(found->angle) : std::nullopt;
    };
    const std::optional<double> by_events = error_by_events(sums, groups, angle);
    const double by_photons = std::sqrt(share * (1.0 - share) / total) / at.density;
    return {at.angle, std::hypot(by_events.value_or(by_photons), binning)};
  };
  result.half_rad = angle_with(0.5);
  result.ninety_rad = angle_with(0.9);
  const Cosine cosine = cosine_of(sums).value();
  const auto mean = [](const std::vector<double>& left) -> std::optional<double> {
    const std::optional<Cosine> found = cosine_of(left);
    return found ? std::optional(found->mean) : std::nullopt;
  };
  result.mean_cosine = {cosine.mean,
                        error_by_events(sums, groups, mean).value_or(std::sqrt(cosine.variance / total))};
  return result;
}

LightSpread light_spread(const tally::TallyResult& tally) {
  const auto is_position = [](const tally::TallyAxis& axis) { return axis.variable == "position"; };
  if (tally.axes.size() != 2 || !std::all_of(tally.axes.begin(), tally.axes.end(), is_position))
    throw wrong_tally(tally, "is not a grid of positions");
  LightSpread spread;
  spread.photons = sum_of(tally.sum);
  if (spread.photons <= 0.0) return spread;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::vector<double>& edges = tally.axes[axis].edges;
    const std::vector<double> sums = marginal(tally, tally.sum, axis);
    const PositionMoments found = spread_of(sums, edges).value();
    const auto centre = [&](const std::vector<double>& left) -> std::optional<double> {
      const std::optional<PositionMoments> without = spread_of(marginal(tally, left, axis), edges);
      return without ? std::optional(without->mean) : std::nullopt;
    };
    spread.centre_mm[axis] = found.mean;
    spread.rms_mm[axis] = std::sqrt(std::max(0.0, found.mean_square - found.mean * found.mean));
    spread.centre_error_mm[axis] = error_by_events(tally.sum, tally.group_sums, centre)
                                       .value_or(spread.rms_mm[axis] / std::sqrt(spread.photons));
    spread.fwhm_mm[axis] = full_width_at_half_maximum(sums, edges);
  }
  return spread;
}

/// Of the counts of bins: sums over pairs and triples of photons in one bin, each over all.
struct Clusters {
  double photons = 0.0, pairs = 0.0, triples = 0.0;  ///< numbers

  explicit Clusters(const std::vector<double>& counts) {
    for (const double count : counts) {
      photons += count;
      pairs += count * (count - 1.0);
      triples += count * (count - 1.0) * (count - 2.0);
    }
  }
  double square() const { return pairs / (photons * (photons - 1.0)); }                    ///< sum of p^2
  double cube() const { return triples / (photons * (photons - 1.0) * (photons - 2.0)); }  ///< of p^3
};

Etendue read_etendue(const tally::TallyResult& tally) {
  if (tally.type != scene_file::kEtendue) throw wrong_tally(tally, "is not an etendue");
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
  const Clusters clusters(tally.sum);
  if (clusters.pairs <= 0.0)
    throw core::InputError(
        core::Problem{{},
                      "the tally \"" + tally.name + "\" does not have two photons in any bin",
                      "trace more photons, or use fewer bins"});
  const double n = clusters.photons, square = clusters.square();
  const double variance =
      4.0 * (n - 2.0) / (n * (n - 1.0)) * std::max(0.0, clusters.cube() - square * square) +
      2.0 / (n * (n - 1.0)) * std::max(0.0, square - square * square);
  const auto filled = [bin](const std::vector<double>& left) -> std::optional<double> {
    const Clusters without(left);
    return without.pairs > 0.0 ? std::optional(bin / without.square()) : std::nullopt;
  };
  result.filled_mm2_sr = {bin / square, error_by_events(tally.sum, tally.group_sums, filled)
                                            .value_or(bin / square * std::sqrt(variance) / square)};
  return result;
}

}  // namespace scintray::analysis
