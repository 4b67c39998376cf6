#include "scintray/topography/build_table.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scintray/core/statistics.hpp"
#include "scintray/core/version.hpp"

namespace scintray {

namespace {

/// Nodes are addressed by integers so that bisection is exact and a node's random streams do not
/// depend on the order in which nodes were found.
constexpr std::uint64_t kUnitsPerStep = std::uint64_t{1} << 24;

struct RayRecord {
  ExitAngles exit;
  float first_slope_rad = 0.0f;
  bool reflected = false;
  bool cut = false;
};

/// Angles of a direction that left, from the outgoing normal and from the forward azimuth.
ExitAngles exit_angles(const Vec3& direction, double forward_azimuth) {
  const double lateral = std::hypot(direction.x(), direction.y());
  const double polar = std::atan2(lateral, std::abs(direction.z()));
  double azimuth = std::atan2(direction.y(), direction.x()) - forward_azimuth;
  azimuth = std::abs(std::remainder(azimuth, kTwoPi));
  return {static_cast<float>(polar), static_cast<float>(azimuth)};
}

void check(const IndexPair& index, const TableSettings& s) {
  Problems problems;
  const auto positive = [&](double value, const std::string& name) {
    if (!(value > 0.0 && std::isfinite(value)))
      problems.add({}, name + " is " + std::to_string(value) + "; expected a positive number");
  };
  positive(index.inside, "index inside");
  positive(index.outside, "index outside");
  positive(s.refine_change, "change of reflectance to refine at");
  positive(s.refine_down_to_rad, "smallest incidence interval");
  if (!(s.incidence_step_rad > 0.0 && s.incidence_step_rad <= 0.5 * kPi))
    problems.add({}, "incidence step is " + std::to_string(s.incidence_step_rad / kDegree) +
                         " deg; expected above 0, up to 90 deg");
  if (!(s.azimuth_step_rad > 0.0 && s.azimuth_step_rad <= kTwoPi))
    problems.add({}, "azimuth step is " + std::to_string(s.azimuth_step_rad / kDegree) +
                         " deg; expected above 0, up to 360 deg");
  if (!(s.grazing_rad > 0.0 && s.grazing_rad < 0.5 * kPi))
    problems.add({}, "grazing incidence is " + std::to_string(s.grazing_rad / kDegree) +
                         " deg; expected between 0 and 90 deg");
  if (s.rays == 0) problems.add({}, "0 rays per direction; expected at least 1");
  problems.throw_if_any();
}

class Builder {
 public:
  Builder(const HeightField& field, const IndexPair& index, const TableSettings& settings,
          const TableProgress& progress)
      : field_(field), index_(index), settings_(settings), progress_(progress) {
    intervals_ = static_cast<std::uint64_t>(std::ceil(0.5 * kPi / settings.incidence_step_rad - 1e-9));
    azimuths_ = static_cast<std::uint64_t>(std::ceil(kTwoPi / settings.azimuth_step_rad - 1e-9));
    records_.resize(azimuths_ * settings.rays);
    planned_ = 2 * (intervals_ + 1);
  }

  std::vector<TableNode> side(Side side) {
    std::map<std::uint64_t, TableNode> nodes;
    std::vector<std::uint64_t> wanted;
    for (std::uint64_t k = 0; k <= intervals_; ++k) wanted.push_back(k * kUnitsPerStep);
    while (!wanted.empty()) {
      for (const std::uint64_t position : wanted) nodes.emplace(position, trace(side, position));
      wanted = to_insert(nodes);
      planned_ += wanted.size();
    }
    std::vector<TableNode> result;
    for (auto& [position, node] : nodes) result.push_back(std::move(node));
    return result;
  }

  std::uint64_t azimuths() const { return azimuths_; }
  std::uint64_t cut() const { return cut_; }

 private:
  double incidence(std::uint64_t position) const {
    return 0.5 * kPi * static_cast<double>(position) / static_cast<double>(intervals_ * kUnitsPerStep);
  }

  std::vector<std::uint64_t> to_insert(const std::map<std::uint64_t, TableNode>& nodes) const {
    std::vector<std::uint64_t> result;
    if (!settings_.refine) return result;
    for (auto low = nodes.begin(), high = std::next(low); high != nodes.end(); ++low, ++high) {
      const TableNode &a = low->second, &b = high->second;
      const double change = std::abs(b.reflectance - a.reflectance);
      const double noise = std::hypot(a.reflectance_error, b.reflectance_error);
      const bool wide = b.incidence_rad - a.incidence_rad > settings_.refine_down_to_rad;
      if (wide && change > settings_.refine_change && change > 4.0 * noise && high->first - low->first > 1)
        result.push_back(low->first + (high->first - low->first) / 2);
    }
    return result;
  }

  RayRecord follow(Side side, std::uint64_t position, double angle, std::uint64_t number) const {
    const std::uint64_t address = (static_cast<std::uint64_t>(side) << 60) | position;
    Rng rng(settings_.seed, StreamKind::table, address, number);
    // Azimuths are stratified, not fixed: the rows of the map are no special direction.
    const double azimuth = kTwoPi * (static_cast<double>(number / settings_.rays) + rng.uniform()) /
                           static_cast<double>(azimuths_);
    const double x = field_.period_x_um() * rng.uniform();
    const double y = field_.period_y_um() * rng.uniform();
    const double up = side == Side::inside ? 1.0 : -1.0;
    Ray ray{{std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), up * std::cos(angle)},
            Vec3::Zero()};
    const HeightFieldExit exit = field_.follow(ray, side, x, y, index_, rng);
    return {exit_angles(ray.direction, azimuth), static_cast<float>(exit.first_slope_rad), exit.side == side,
            exit.cut};
  }

  TableNode trace(Side side, std::uint64_t position) {
    TableNode node;
    node.incidence_rad = incidence(position);
    node.traced_incidence_rad = std::min(node.incidence_rad, settings_.grazing_rad);
    constexpr std::size_t kGrain = 1024;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, records_.size(), kGrain), [&](const auto& range) {
      for (std::size_t k = range.begin(); k != range.end(); ++k)
        records_[k] = follow(side, position, node.traced_incidence_rad, k);
    });
    fill(node);
    if (progress_ && !progress_(static_cast<double>(++done_) / static_cast<double>(planned_)))
      throw TableStopped("building the surface table was stopped");
    return node;
  }

  /// Reduces the records in their order, whatever threads made them.
  void fill(TableNode& node) {
    std::vector<ExitAngles> reflected, transmitted;
    double slopes = 0.0;
    for (const RayRecord& record : records_) {
      (record.reflected ? reflected : transmitted).push_back(record.exit);
      slopes += record.first_slope_rad;
      cut_ += record.cut ? 1 : 0;
    }
    node.rays = records_.size();
    node.reflectance = static_cast<double>(reflected.size()) / static_cast<double>(node.rays);
    node.reflectance_error = binomial_estimate(reflected.size(), node.rays).error;
    node.mean_slope_rad = slopes / static_cast<double>(node.rays);
    node.reflected = quantiles_of(reflected);
    node.transmitted = quantiles_of(transmitted);
  }

  const HeightField& field_;
  const IndexPair& index_;
  const TableSettings& settings_;
  const TableProgress& progress_;
  std::uint64_t intervals_ = 0, azimuths_ = 0, cut_ = 0;
  std::uint64_t done_ = 0, planned_ = 0;
  std::vector<RayRecord> records_;
};

}  // namespace

SurfaceTable build_table(const HeightField& field, const IndexPair& index, const TableSettings& settings,
                         TableProvenance provenance, const TableProgress& progress) {
  check(index, settings);
  Builder builder(field, index, settings, progress);
  std::vector<TableNode> inside = builder.side(Side::inside);
  std::vector<TableNode> outside = builder.side(Side::outside);
  provenance.seed = settings.seed;
  provenance.rays_per_azimuth = settings.rays;
  provenance.azimuths = builder.azimuths();
  provenance.unclassified = 0;  // HeightField has no such exit
  provenance.cut = builder.cut();
  provenance.version = version();
  return SurfaceTable(index, std::move(inside), std::move(outside), std::move(provenance));
}

}  // namespace scintray
