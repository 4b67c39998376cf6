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

/// Rounding of shares that sum to one.
constexpr double kShareRounding = 1e-12;

constexpr float kQuarterTurn = static_cast<float>(0.5 * kPi), kHalfTurn = static_cast<float>(kPi);

/// Quantile of a sorted sample within [low, high]; order statistic k stands for the level (k + 1/2)/n. The
/// half step beyond the first and the last goes on as steeply as the step before it: ending at the extreme
/// rays of a small sample would leave the tails of the distribution empty.
float quantile(std::span<const float> sorted, double level, float low, float high) {
  const double n = static_cast<double>(sorted.size());
  if (sorted.size() == 1) return sorted.front();
  const double rank = std::clamp(level * n - 0.5, -0.5, n - 0.5);
  const std::size_t k =
      std::min(static_cast<std::size_t>(std::max(0.0, rank)), sorted.size() - 2);  // steps from k to k + 1
  const float share = static_cast<float>(rank - static_cast<double>(k));           // -1/2 to 3/2
  return std::clamp(sorted[k] + share * (sorted[k + 1] - sorted[k]), low, high);
}

/// A quantity of the nodes at an incidence angle, linear between them.
double between_nodes(const std::vector<TableNode>& nodes, double incidence_rad, double TableNode::*what) {
  const auto above =
      std::lower_bound(nodes.begin() + 1, nodes.end() - 1, incidence_rad,
                       [](const TableNode& n, double angle) { return n.incidence_rad < angle; });
  const TableNode &low = *(above - 1), &high = *above;
  const double share = (incidence_rad - low.incidence_rad) / (high.incidence_rad - low.incidence_rad);
  return std::lerp(low.*what, high.*what, std::clamp(share, 0.0, 1.0));
}

bool increasing(std::span<const float> edges, double low, double high) {
  return edges.front() >= low - kAngleRounding && edges.back() <= high + kAngleRounding &&
         std::is_sorted(edges.begin(), edges.end());
}

class TableCheck {
 public:
  explicit TableCheck(AzimuthKind kind) : kind_(kind) {}

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
    else if (!(node.absorptance >= 0.0 && node.reflectance + node.absorptance <= 1.0 + kShareRounding))
      fault(name + " has absorptance " + std::to_string(node.absorptance) + "; expected 0 to " +
            std::to_string(1.0 - node.reflectance) + ", one less its reflectance");
    if (node.reflectance > 0.0 && node.reflected.empty()) fault(name + " reflects but has no directions");
    if (node.transmittance() > kShareRounding && node.transmitted.empty())
      fault(name + " transmits but has no directions");
    directions(node.reflected, name + ", reflected");
    directions(node.transmitted, name + ", transmitted");
  }

  void directions(const DirectionQuantiles& q, const std::string& name) {
    if (q.empty() && q.azimuth.empty()) return;
    constexpr std::size_t kRowEnds = kAzimuthBins + 1;
    if (q.polar.size() != kPolarBins + 1 || q.azimuth.size() != kPolarBins * kRowEnds) {
      fault(name + " has " + std::to_string(q.polar.size()) + " polar and " +
            std::to_string(q.azimuth.size()) + " azimuth edges; expected " + std::to_string(kPolarBins + 1) +
            " and " + std::to_string(kPolarBins * kRowEnds));
      return;
    }
    if (!increasing(q.polar, 0.0, 0.5 * kPi))
      fault(name + ": polar edges do not increase within 0 to 90 deg");
    const double low = kind_ == AzimuthKind::folded ? 0.0 : -kPi;
    for (int row = 0; row < kPolarBins; ++row)
      if (!increasing(std::span(q.azimuth).subspan(row * kRowEnds, kRowEnds), low, kPi)) {
        fault(name + ": azimuth edges of polar bin " + std::to_string(row) + " do not increase within " +
              (low < 0.0 ? "-180" : "0") + " to 180 deg");
        return;
      }
  }

  void fault(std::string what) { problems_.add({}, std::move(what), "rebuild the table"); }

  AzimuthKind kind_;
  Problems problems_;
};

}  // namespace

DirectionQuantiles quantiles_of(std::vector<ExitAngles>& sample, AzimuthKind kind) {
  DirectionQuantiles result;
  result.rays = sample.size();
  if (sample.empty()) return result;
  // The azimuth breaks ties, so that the result depends on the sample as a set only.
  std::sort(sample.begin(), sample.end(), [](const ExitAngles& a, const ExitAngles& b) {
    return a.polar != b.polar ? a.polar < b.polar : a.azimuth < b.azimuth;
  });
  std::vector<float> values(sample.size());
  std::transform(sample.begin(), sample.end(), values.begin(), [](const ExitAngles& e) { return e.polar; });
  for (int k = 0; k <= kPolarBins; ++k)
    result.polar.push_back(quantile(values, polar_level(k), 0.0f, kQuarterTurn));

  const double n = static_cast<double>(sample.size());
  for (int k = 0; k < kPolarBins; ++k) {
    // Rays of the bin; a bin narrower than one ray borrows the nearest.
    const auto first = std::min(static_cast<std::size_t>(polar_level(k) * n), sample.size() - 1);
    const auto last = std::max(static_cast<std::size_t>(polar_level(k + 1) * n), first + 1);
    values.clear();
    for (std::size_t r = first; r < last; ++r) values.push_back(sample[r].azimuth);
    std::sort(values.begin(), values.end());
    for (int c = 0; c <= kAzimuthBins; ++c)
      result.azimuth.push_back(kind == AzimuthKind::folded
                                   ? quantile(values, azimuth_level(c), 0.0f, kHalfTurn)
                                   : quantile(values, signed_azimuth_level(c), -kHalfTurn, kHalfTurn));
  }
  return result;
}

SurfaceTable::SurfaceTable(IndexPair index, std::vector<TableNode> from_inside,
                           std::vector<TableNode> from_outside, TableProvenance provenance)
    : SurfaceTable({TableSlice{0.0, 0.0, index, std::move(from_inside), std::move(from_outside), nullptr}},
                   AzimuthKind::folded, std::move(provenance)) {}

SurfaceTable::SurfaceTable(std::vector<TableSlice> slices, AzimuthKind kind, TableProvenance provenance)
    : slices_(std::move(slices)), kind_(kind), provenance_(std::move(provenance)) {
  check_grid();
  TableCheck check(kind_);
  for (const TableSlice& slice : slices_) {
    check.nodes(slice.from_inside, "inside");
    check.nodes(slice.from_outside, "outside");
  }
  check.throw_if_any();
  opaque_ = true;
  for (const TableSlice& slice : slices_) {
    index_.push_back(make_index(slice.from_inside));
    index_.push_back(make_index(slice.from_outside));
    for (const TableNode& node : slice.from_inside) opaque_ = opaque_ && node.transmitted.empty();
    for (const Side side : {Side::inside, Side::outside})
      for (const TableNode& node : slice.nodes(side)) absorbs_ = absorbs_ || node.absorptance > 0.0;
  }
}

void SurfaceTable::check_grid() {
  const auto fault = [](const std::string& what) {
    throw InputError({{}, "the slices of a table " + what, "rebuild the table"});
  };
  if (slices_.empty()) fault("are missing");
  for (const TableSlice& slice : slices_)
    if (wavelengths_nm_.empty() || slice.wavelength_nm != wavelengths_nm_.back())
      wavelengths_nm_.push_back(slice.wavelength_nm);
  for (std::size_t k = 1; k < wavelengths_nm_.size(); ++k)
    if (!(wavelengths_nm_[k] > wavelengths_nm_[k - 1])) fault("are not in order of wavelength");
  azimuths_ = slices_.size() / wavelengths_nm_.size();
  if (kind_ == AzimuthKind::folded && azimuths_ != 1) fault("have several azimuths, but no direction");
  for (std::size_t k = 0; k < slices_.size(); ++k) {
    const double azimuth = kTwoPi * static_cast<double>(k % azimuths_) / static_cast<double>(azimuths_);
    if (slices_[k].wavelength_nm != wavelengths_nm_[std::min(k / azimuths_, wavelengths_nm_.size() - 1)] ||
        !(std::abs(slices_[k].azimuth_rad - azimuth) < kAngleRounding))
      fault("are not at the same azimuths, evenly spaced from 0, for every wavelength");
  }
}

SurfaceTable::Index SurfaceTable::make_index(const std::vector<TableNode>& nodes) {
  Index index;
  for (const TableNode& node : nodes)
    index.slants.push_back({slant(std::sin(node.incidence_rad), std::cos(node.incidence_rad)), 0.0});
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    const double low = nodes[k].incidence_rad, high = nodes[k + 1].incidence_rad;
    const double middle = 0.5 * (index.slants[k].value + index.slants[k + 1].value);
    index.slants[k].bend = 4.0 * ((angle_of_slant(middle) - low) / (high - low) - 0.5);
  }
  std::uint32_t node = 0;
  for (std::uint32_t step = 0; step <= kLookupSteps; ++step) {
    while (node + 2 < nodes.size() && index.slants[node + 1].value * kLookupSteps <= step) ++node;
    index.lookup.push_back(node);
  }
  return index;
}

SurfaceTable::Place SurfaceTable::place(const Index& index, double sine, double cosine) const {
  const std::vector<Slant>& slants = index.slants;
  const double value = slant(sine, cosine);
  std::uint32_t node = index.lookup[std::min(static_cast<std::uint32_t>(value * kLookupSteps), kLookupSteps)];
  while (node + 2 < slants.size() && value >= slants[node + 1].value) ++node;
  const double low = slants[node].value, high = slants[node + 1].value;
  const double x = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return {node, x + slants[node].bend * x * (1.0 - x)};
}

double SurfaceTable::reflectance(Side side, double incidence_rad, std::size_t slice) const {
  if (const auto& kernel = slices_[slice].reciprocal)
    return kernel->reflectance(side, std::pow(std::sin(incidence_rad), 2));
  return between_nodes(nodes(side, slice), incidence_rad, &TableNode::reflectance);
}

double SurfaceTable::mean_slope(Side side, double incidence_rad, std::size_t slice) const {
  return between_nodes(nodes(side, slice), incidence_rad, &TableNode::mean_slope_rad);
}

std::size_t SurfaceTable::pick_slice(double lateral_azimuth, double wavelength_nm, Rng& rng) const {
  std::size_t spectral = 0;
  if (wavelengths_nm_.size() > 1) {
    const auto above =
        std::upper_bound(wavelengths_nm_.begin() + 1, wavelengths_nm_.end() - 1, wavelength_nm);
    const double low = *(above - 1), high = *above;
    spectral = static_cast<std::size_t>(above - wavelengths_nm_.begin()) - 1;
    if (rng.uniform() < (wavelength_nm - low) / (high - low)) ++spectral;
  }
  std::size_t azimuth = 0;
  if (azimuths_ > 1) {
    const double turns = lateral_azimuth / kTwoPi;
    const double at = (turns - std::floor(turns)) * static_cast<double>(azimuths_);
    azimuth = static_cast<std::size_t>(at);
    if (rng.uniform() < at - std::floor(at)) ++azimuth;
    azimuth %= azimuths_;
  }
  return spectral * azimuths_ + azimuth;
}

ExitAngles SurfaceTable::sample(const std::vector<TableNode>& nodes, const Place& place, bool reflected,
                                Rng& rng) const {
  const auto directions = [&](std::uint32_t node) -> const DirectionQuantiles& {
    return reflected ? nodes[node].reflected : nodes[node].transmitted;
  };
  const DirectionQuantiles* low = &directions(place.node);
  const DirectionQuantiles* high = &directions(place.node + 1);
  // A node that light never leaves that way has no directions of its own.
  if (low->empty()) low = high;
  if (high->empty()) high = low;

  const auto two_tails = [](double u) {
    return u < 0.5 ? std::sqrt(0.5 * u) : 1.0 - std::sqrt(0.5 * (1.0 - u));
  };
  const bool folded = kind_ == AzimuthKind::folded;
  const double s = two_tails(rng.uniform());
  const std::uint64_t bits = rng.bits();
  const double u = static_cast<double>(bits >> 11) * 0x1.0p-53;
  const double t = folded ? 1.0 - std::sqrt(1.0 - u) : two_tails(u);
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
  // A bit that u does not use: either side of the plane of incidence.
  return {a.polar + share * (b.polar - a.polar), folded && (bits & 1) != 0 ? -azimuth : azimuth};
}

SurfaceOutcome SurfaceTable::meet(Ray& ray, Side side, const Vec3& normal, const Vec3& along,
                                  double wavelength_nm, Rng& rng) const {
  const double cosine = ray.direction.dot(normal);
  const Vec3 lateral = ray.direction - cosine * normal;
  const double sine = lateral.norm();
  const Vec3 forward = sine > kNoPlane ? Vec3(lateral / sine) : sample_polarisation(normal, rng);
  const Vec3 across = normal.cross(forward);

  std::size_t slice = 0;
  if (slices_.size() > 1) {
    double azimuth = 0.0;
    if (azimuths_ > 1) {
      const Frame map = map_frame(normal, along, rng);
      azimuth = std::atan2(forward.dot(map.y), forward.dot(map.x));
    }
    slice = pick_slice(azimuth, wavelength_nm, rng);
  }
  const auto leave = [&](Side after, double sin_polar, double cos_polar, double sin_azimuth,
                         double cos_azimuth) {
    const double out = after == Side::outside ? 1.0 : -1.0;
    ray.direction = sin_polar * (cos_azimuth * forward + sin_azimuth * across) + out * cos_polar * normal;
    if (!ray.polarisation.isZero(0.0)) ray.polarisation = sample_polarisation(ray.direction, rng);
    return outcome_on(after);
  };
  if (const ReciprocalKernel* kernel = slices_[slice].reciprocal.get()) {
    const ReciprocalKernel::Sample exit = kernel->sample(side, std::min(1.0, sine * sine), rng);
    const double cos2 = std::max(1.0 - exit.sine2, kLeastCosine * kLeastCosine);
    const double sin_turn = std::sin(exit.turn);
    return leave(exit.side, std::sqrt(1.0 - cos2), std::sqrt(cos2),
                 (rng.bits() & 1) != 0 ? sin_turn : -sin_turn, std::cos(exit.turn));
  }
  const std::vector<TableNode>& nodes = slices_[slice].nodes(side);
  const Place at = place(index_[2 * slice + static_cast<std::size_t>(side)], sine, std::abs(cosine));
  const TableNode &low = nodes[at.node], &high = nodes[at.node + 1];
  const double reflectance = low.reflectance + at.share * (high.reflectance - low.reflectance);
  const double u = rng.uniform();
  const bool reflected = u < reflectance;
  if (absorbs_ && !reflected) {
    const double absorptance = low.absorptance + at.share * (high.absorptance - low.absorptance);
    // Rounding must not let light through where no node does.
    const bool closed = low.transmitted.empty() && high.transmitted.empty();
    if (closed || u < reflectance + absorptance) return SurfaceOutcome::absorbed;
  }
  const ExitAngles exit = sample(nodes, at, reflected, rng);

  // Cosines in single precision, as the table holds the angles, and sines that go with them exactly. A
  // direction exactly in the surface would be on neither side.
  const double cos_polar = std::max<double>(std::cos(exit.polar), kLeastCosine);
  const double cos_azimuth = std::cos(exit.azimuth);
  return leave(reflected ? side : other(side), std::sqrt(1.0 - cos_polar * cos_polar), cos_polar,
               std::copysign(std::sqrt(1.0 - cos_azimuth * cos_azimuth), exit.azimuth), cos_azimuth);
}

Side SurfaceTable::scatter(Ray& ray, Side side, const Vec3& normal, const IndexPair&, Rng& rng) const {
  return meet(ray, side, normal, Vec3::Zero(), wavelengths_nm_.front(), rng) == SurfaceOutcome::inside
             ? Side::inside
             : Side::outside;
}

}  // namespace scintray
