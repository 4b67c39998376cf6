#include "scintray/surface/table.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"

namespace scintray {

namespace {

/// Steps of the incidence lookup: finer than the nodes, so that at most a step or two remain.
constexpr std::uint32_t kLookupSteps = 2048;

/// A measure of the incidence angle between 0 and 1, increasing with it, that needs no arc function.
double slant(double sine, double cosine) { return sine / (sine + cosine); }
double angle_of_slant(double value) { return std::atan2(value, 1.0 - value); }

/// Sine of incidence below which the plane of incidence is drawn at random.
constexpr double kNoPlane = 1e-9;

constexpr double kLeastCosine = 1e-7;

/// Rounding of angles stored in single precision.
constexpr double kAngleRounding = 1e-6;

/// Quantile of a sorted sample; order statistic k stands for the level (k + 1/2)/n.
float quantile(std::span<const float> sorted, double level) {
  const double n = static_cast<double>(sorted.size());
  const double rank = std::clamp(level * n - 0.5, 0.0, n - 1.0);
  const std::size_t k = std::min(static_cast<std::size_t>(rank), sorted.size() - 1);
  const std::size_t next = std::min(k + 1, sorted.size() - 1);
  const float share = static_cast<float>(rank - static_cast<double>(k));
  return sorted[k] + share * (sorted[next] - sorted[k]);
}

bool increasing(std::span<const float> edges, double high) {
  return edges.front() >= 0.0f && edges.back() <= high + kAngleRounding &&
         std::is_sorted(edges.begin(), edges.end());
}

class TableCheck {
 public:
  void nodes(const std::vector<TableNode>& nodes, const std::string& side) {
    if (nodes.size() < 2) {
      fault("table from " + side + " has " + std::to_string(nodes.size()) + " nodes; expected at least 2");
      return;
    }
    if (nodes.front().incidence_rad != 0.0 || std::abs(nodes.back().incidence_rad - 0.5 * kPi) > 1e-9)
      fault("table from " + side + " runs from " + degrees(nodes.front()) + " to " + degrees(nodes.back()) +
            "; expected 0 to 90 deg");
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const std::string name = "node " + std::to_string(k) + " (" + degrees(nodes[k]) + ") from " + side;
      if (k > 0 && !(nodes[k].incidence_rad > nodes[k - 1].incidence_rad))
        fault(name + " does not follow " + degrees(nodes[k - 1]) + "; expected increasing angles");
      node(nodes[k], name);
    }
  }

  void throw_if_any() { problems_.throw_if_any(); }

 private:
  static std::string degrees(const TableNode& node) {
    return std::to_string(node.incidence_rad / kDegree) + " deg";
  }

  void node(const TableNode& node, const std::string& name) {
    if (!(node.reflectance >= 0.0 && node.reflectance <= 1.0))
      fault(name + " has reflectance " + std::to_string(node.reflectance) + "; expected 0 to 1");
    if (node.reflectance > 0.0 && node.reflected.empty()) fault(name + " reflects but has no directions");
    if (node.reflectance < 1.0 && node.transmitted.empty()) fault(name + " transmits but has no directions");
    directions(node.reflected, name + ", reflected");
    directions(node.transmitted, name + ", transmitted");
  }

  void directions(const DirectionQuantiles& q, const std::string& name) {
    if (q.empty() && q.azimuth.empty()) return;
    constexpr std::size_t kRow = kAzimuthBins + 1;
    if (q.polar.size() != kPolarBins + 1 || q.azimuth.size() != kPolarBins * kRow) {
      fault(name + " has " + std::to_string(q.polar.size()) + " polar and " +
            std::to_string(q.azimuth.size()) + " azimuth edges; expected " + std::to_string(kPolarBins + 1) +
            " and " + std::to_string(kPolarBins * kRow));
      return;
    }
    if (!increasing(q.polar, 0.5 * kPi)) fault(name + ": polar edges do not increase within 0 to 90 deg");
    for (int row = 0; row < kPolarBins; ++row)
      if (!increasing(std::span(q.azimuth).subspan(row * kRow, kRow), kPi)) {
        fault(name + ": azimuth edges of polar bin " + std::to_string(row) +
              " do not increase within 0 to 180 deg");
        return;
      }
  }

  void fault(std::string what) { problems_.add({}, std::move(what), "rebuild the table"); }

  Problems problems_;
};

}  // namespace

DirectionQuantiles quantiles_of(std::vector<ExitAngles>& sample) {
  DirectionQuantiles result;
  result.rays = sample.size();
  if (sample.empty()) return result;
  // The azimuth breaks ties, so that the result depends on the sample as a set only.
  std::sort(sample.begin(), sample.end(), [](const ExitAngles& a, const ExitAngles& b) {
    return a.polar != b.polar ? a.polar < b.polar : a.azimuth < b.azimuth;
  });
  std::vector<float> values(sample.size());
  std::transform(sample.begin(), sample.end(), values.begin(), [](const ExitAngles& e) { return e.polar; });
  for (int k = 0; k <= kPolarBins; ++k) result.polar.push_back(quantile(values, polar_level(k)));

  const double n = static_cast<double>(sample.size());
  for (int k = 0; k < kPolarBins; ++k) {
    // Rays of the bin; a bin narrower than one ray borrows the nearest.
    const auto first = std::min(static_cast<std::size_t>(polar_level(k) * n), sample.size() - 1);
    const auto last = std::max(static_cast<std::size_t>(polar_level(k + 1) * n), first + 1);
    values.clear();
    for (std::size_t r = first; r < last; ++r) values.push_back(sample[r].azimuth);
    std::sort(values.begin(), values.end());
    for (int c = 0; c <= kAzimuthBins; ++c) result.azimuth.push_back(quantile(values, azimuth_level(c)));
  }
  return result;
}

SurfaceTable::SurfaceTable(IndexPair index, std::vector<TableNode> from_inside,
                           std::vector<TableNode> from_outside, TableProvenance provenance)
    : index_(index),
      nodes_{std::move(from_inside), std::move(from_outside)},
      provenance_(std::move(provenance)) {
  TableCheck check;
  check.nodes(nodes_[0], "inside");
  check.nodes(nodes_[1], "outside");
  check.throw_if_any();
  for (int side = 0; side < 2; ++side) {
    for (const TableNode& node : nodes_[side])
      slants_[side].push_back({slant(std::sin(node.incidence_rad), std::cos(node.incidence_rad)), 0.0});
    for (std::size_t k = 0; k + 1 < nodes_[side].size(); ++k) {
      const double low = nodes_[side][k].incidence_rad, high = nodes_[side][k + 1].incidence_rad;
      const double middle = 0.5 * (slants_[side][k].value + slants_[side][k + 1].value);
      slants_[side][k].bend = 4.0 * ((angle_of_slant(middle) - low) / (high - low) - 0.5);
    }
    std::uint32_t node = 0;
    for (std::uint32_t step = 0; step <= kLookupSteps; ++step) {
      while (node + 2 < nodes_[side].size() && slants_[side][node + 1].value * kLookupSteps <= step) ++node;
      lookup_[side].push_back(node);
    }
  }
}

SurfaceTable::Place SurfaceTable::place(int side, double sine, double cosine) const {
  const std::vector<Slant>& slants = slants_[side];
  const double value = slant(sine, cosine);
  std::uint32_t node =
      lookup_[side][std::min(static_cast<std::uint32_t>(value * kLookupSteps), kLookupSteps)];
  while (node + 2 < slants.size() && value >= slants[node + 1].value) ++node;
  const double low = slants[node].value, high = slants[node + 1].value;
  const double x = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return {node, x + slants[node].bend * x * (1.0 - x)};
}

double SurfaceTable::reflectance(Side side, double incidence_rad) const {
  const auto& nodes = this->nodes(side);
  const auto above =
      std::lower_bound(nodes.begin() + 1, nodes.end() - 1, incidence_rad,
                       [](const TableNode& n, double angle) { return n.incidence_rad < angle; });
  const TableNode &low = *(above - 1), &high = *above;
  const double share = (incidence_rad - low.incidence_rad) / (high.incidence_rad - low.incidence_rad);
  return low.reflectance + std::clamp(share, 0.0, 1.0) * (high.reflectance - low.reflectance);
}

double SurfaceTable::reflectance(int side, const Place& at) const {
  const double low = nodes_[side][at.node].reflectance;
  return low + at.share * (nodes_[side][at.node + 1].reflectance - low);
}

ExitAngles SurfaceTable::sample(int side, const Place& place, bool reflected, Rng& rng) const {
  const auto directions = [&](std::uint32_t node) -> const DirectionQuantiles& {
    return reflected ? nodes_[side][node].reflected : nodes_[side][node].transmitted;
  };
  const DirectionQuantiles* low = &directions(place.node);
  const DirectionQuantiles* high = &directions(place.node + 1);
  // A node that light never leaves that way has no directions of its own.
  if (low->empty()) low = high;
  if (high->empty()) high = low;

  const double u = rng.uniform();
  const double s = u < 0.5 ? std::sqrt(0.5 * u) : 1.0 - std::sqrt(0.5 * (1.0 - u));
  const std::uint64_t bits = rng.bits();
  const double t = 1.0 - std::sqrt(1.0 - static_cast<double>(bits >> 11) * 0x1.0p-53);
  const int polar_bin = std::min(static_cast<int>(s * kPolarBins), kPolarBins - 1);
  const int azimuth_bin = std::min(static_cast<int>(t * kAzimuthBins), kAzimuthBins - 1);
  const auto polar_part = static_cast<float>(s * kPolarBins - polar_bin);
  const auto azimuth_part = static_cast<float>(t * kAzimuthBins - azimuth_bin);
  const auto share = static_cast<float>(place.share);

  const auto angles = [&](const DirectionQuantiles& q) -> ExitAngles {
    const float* polar = q.polar.data() + polar_bin;
    const float* azimuth = q.azimuth.data() + polar_bin * (kAzimuthBins + 1) + azimuth_bin;
    return {polar[0] + polar_part * (polar[1] - polar[0]),
            azimuth[0] + azimuth_part * (azimuth[1] - azimuth[0])};
  };
  const ExitAngles a = angles(*low), b = angles(*high);
  const float azimuth = a.azimuth + share * (b.azimuth - a.azimuth);
  // A bit that t does not use: either side of the plane of incidence.
  return {a.polar + share * (b.polar - a.polar), (bits & 1) != 0 ? azimuth : -azimuth};
}

Side SurfaceTable::scatter(Ray& ray, Side side, const Vec3& normal, const IndexPair&, Rng& rng) const {
  const int from = static_cast<int>(side);
  const double along = ray.direction.dot(normal);
  const Vec3 lateral = ray.direction - along * normal;
  const double sine = lateral.norm();
  const Place at = place(from, sine, std::abs(along));
  const bool reflected = rng.uniform() < reflectance(from, at);
  const ExitAngles exit = sample(from, at, reflected, rng);

  const Vec3 forward = sine > kNoPlane ? Vec3(lateral / sine) : sample_polarisation(normal, rng);
  const Vec3 across = normal.cross(forward);
  const Side after = reflected ? side : other(side);
  const double out = after == Side::outside ? 1.0 : -1.0;
  // Cosines in single precision, as the table holds the angles, and sines that go with them exactly. A
  // direction exactly in the surface would be on neither side.
  const double cos_polar = std::max<double>(std::cos(exit.polar), kLeastCosine);
  const double sin_polar = std::sqrt(1.0 - cos_polar * cos_polar);
  const double cos_azimuth = std::cos(exit.azimuth);
  const double sin_azimuth = std::copysign(std::sqrt(1.0 - cos_azimuth * cos_azimuth), exit.azimuth);
  ray.direction = sin_polar * (cos_azimuth * forward + sin_azimuth * across) + out * cos_polar * normal;
  if (!ray.polarisation.isZero(0.0)) ray.polarisation = sample_polarisation(ray.direction, rng);
  return after;
}

}  // namespace scintray
