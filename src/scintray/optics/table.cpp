#include "scintray/optics/table.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <thread>

#include "scintray/core/elementary.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"

namespace scintray::optics {

namespace {

/// Largest total size of all copies of a table's samplers, unless a single copy is larger.
constexpr std::size_t kMostCopiedBytes = 16'000'000;

/// Number of the calling thread: 1, 2, ... in the order of the first calls. It selects one of several equal
/// copies; results do not depend on it.
unsigned thread_slot() {
  static std::atomic<unsigned> last{0};
  static thread_local unsigned slot = 0;
  if (slot == 0) slot = ++last;
  return slot;
}

std::size_t threads() { return std::max(1u, std::thread::hardware_concurrency()); }

/// Tolerance of angles stored in single precision.
constexpr double kAngleRounding = 1e-6;

/// Tolerance of the sum of shares.
constexpr double kShareRounding = 1e-12;

/// A quantity of the nodes at an incidence angle, interpolated linearly between them.
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
    if (nodes.front().incidence_rad != 0.0 || std::abs(nodes.back().incidence_rad - 0.5 * core::kPi) > 1e-9)
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
    return std::to_string(node.incidence_rad / core::kDegree) + " deg";
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
    if (!increasing(q.polar, 0.0, 0.5 * core::kPi))
      fault(name + ": polar edges do not increase within 0 to 90 deg");
    const double low = kind_ == AzimuthKind::folded ? 0.0 : -core::kPi;
    for (int row = 0; row < kPolarBins; ++row)
      if (!increasing(std::span(q.azimuth).subspan(row * kRowEnds, kRowEnds), low, core::kPi)) {
        fault(name + ": azimuth edges of polar bin " + std::to_string(row) + " do not increase within " +
              (low < 0.0 ? "-180" : "0") + " to 180 deg");
        return;
      }
  }

  void fault(std::string what) { problems_.add({}, std::move(what), "rebuild the table"); }

  AzimuthKind kind_;
  core::Problems problems_;
};

}  // namespace

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
    for (const TableNode& node : slice.from_inside) opaque_ = opaque_ && node.transmitted.empty();
    for (const Side side : {Side::inside, Side::outside})
      for (const TableNode& node : slice.nodes(side)) absorbs_ = absorbs_ || node.absorptance > 0.0;
  }
  Samplers samplers;
  for (const TableSlice& slice : slices_) {
    // Directions drawn from a reciprocal kernel do not use the sampler.
    static const std::vector<TableNode> kNone;
    for (const Side side : {Side::inside, Side::outside})
      samplers.emplace_back(slice.reciprocal ? kNone : slice.nodes(side), kind_, absorbs_);
  }
  std::size_t bytes = 0;
  for (const TableSampler& sampler : samplers) bytes += sampler.bytes();
  samplers_.assign(std::clamp<std::size_t>(kMostCopiedBytes / bytes, 1, threads()), samplers);
}

void SurfaceTable::check_grid() {
  const auto fault = [](const std::string& what) {
    throw core::InputError({{}, "the slices of a table " + what, "rebuild the table"});
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
    const double azimuth = core::kTwoPi * static_cast<double>(k % azimuths_) / static_cast<double>(azimuths_);
    if (slices_[k].wavelength_nm != wavelengths_nm_[std::min(k / azimuths_, wavelengths_nm_.size() - 1)] ||
        !(std::abs(slices_[k].azimuth_rad - azimuth) < kAngleRounding))
      fault("are not at the same azimuths, evenly spaced from 0, for every wavelength");
  }
}

bool SurfaceTable::reciprocal() const {
  return std::all_of(slices_.begin(), slices_.end(),
                     [](const TableSlice& slice) { return slice.reciprocal != nullptr; });
}

double SurfaceTable::reflectance(Side side, double incidence_rad, std::size_t slice) const {
  if (const auto& kernel = slices_[slice].reciprocal)
    return kernel->reflectance(side, std::pow(std::sin(incidence_rad), 2));
  return between_nodes(nodes(side, slice), incidence_rad, &TableNode::reflectance);
}

double SurfaceTable::mean_slope(Side side, double incidence_rad, std::size_t slice) const {
  return between_nodes(nodes(side, slice), incidence_rad, &TableNode::mean_slope_rad);
}

SurfaceTable::BetweenWavelengths SurfaceTable::between_wavelengths(double wavelength_nm) const {
  if (wavelengths_nm_.size() == 1) return {};
  const auto above = std::upper_bound(wavelengths_nm_.begin() + 1, wavelengths_nm_.end() - 1, wavelength_nm);
  const double low = *(above - 1), high = *above;
  return {static_cast<std::size_t>(above - wavelengths_nm_.begin()) - 1,
          (wavelength_nm - low) / (high - low)};
}

std::size_t SurfaceTable::pick_slice(double lateral_azimuth, double wavelength_nm, double for_wavelength,
                                     core::Rng& rng) const {
  const BetweenWavelengths between = between_wavelengths(wavelength_nm);
  std::size_t spectral = between.first;
  if (between.to_next && for_wavelength < *between.to_next) ++spectral;
  std::size_t azimuth = 0;
  if (azimuths_ > 1) {
    const double turns = lateral_azimuth / core::kTwoPi;
    const double at = (turns - std::floor(turns)) * static_cast<double>(azimuths_);
    azimuth = static_cast<std::size_t>(at);
    if (rng.uniform() < at - std::floor(at)) ++azimuth;
    azimuth %= azimuths_;
  }
  return spectral * azimuths_ + azimuth;
}

const TableSampler& SurfaceTable::sampler(std::size_t slice, Side side) const {
  return samplers_[thread_slot() % samplers_.size()][2 * slice + static_cast<std::size_t>(side)];
}

SurfaceOutcome SurfaceTable::interact(Ray& ray, Side side, const core::Vec3& normal, const core::Vec3& along,
                                      double wavelength_nm, core::Rng& rng) const {
  const double cosine = ray.direction.dot(normal);
  const core::Vec3 lateral = ray.direction - cosine * normal;
  const double sine = lateral.norm();
  const core::Vec3 forward =
      sine > kNoIncidencePlane ? core::Vec3(lateral / sine) : core::sample_polarisation(normal, rng);
  const core::Vec3 across = normal.cross(forward);

  const double for_wavelength = rng.uniform();  // also where there is one, as in lanes
  std::size_t slice = 0;
  if (slices_.size() > 1) {
    double azimuth = 0.0;
    if (azimuths_ > 1) {
      const core::Frame map = map_frame(normal, along, rng);
      azimuth = std::atan2(forward.dot(map.y), forward.dot(map.x));
    }
    slice = pick_slice(azimuth, wavelength_nm, for_wavelength, rng);
  }
  const auto leave = [&](Side after, double sin_polar, double cos_polar, double sin_azimuth,
                         double cos_azimuth) {
    const double out = after == Side::outside ? 1.0 : -1.0;
    ray.direction = sin_polar * (cos_azimuth * forward + sin_azimuth * across) + out * cos_polar * normal;
    if (!ray.polarisation.isZero(0.0)) repolarise(ray, rng);
    return outcome_on(after);
  };
  if (const ReciprocalKernel* kernel = slices_[slice].reciprocal.get()) {
    const ReciprocalKernel::Sample exit = kernel->sample(side, std::min(1.0, sine * sine), rng);
    const double cos2 = std::max(1.0 - exit.sine2, kLeastExitCosine * kLeastExitCosine);
    const core::SineCosine turn = core::sincos(exit.turn);
    return leave(exit.side, std::sqrt(1.0 - cos2), std::sqrt(cos2),
                 (rng.bits() & 1) != 0 ? turn.sine : -turn.sine, turn.cosine);
  }
  const TableSampler& sampler = this->sampler(slice, side);
  const TableSampler::Place at = sampler.place(sine, std::abs(cosine));
  const double u = rng.uniform();
  const bool reflected = u < at.reflectance();
  if (!reflected && at.absorbs(u)) return SurfaceOutcome::absorbed;
  const TableExit exit = sampler.sample(at, reflected, rng);

  core::SineCosine polar = core::sincos(exit.polar);
  // A direction exactly in the surface would be on neither side.
  if (polar.cosine < kLeastExitCosine) polar = {1.0, kLeastExitCosine};
  const core::SineCosine azimuth = core::sincos(exit.azimuth);
  return leave(reflected ? side : other(side), polar.sine, polar.cosine, azimuth.sine, azimuth.cosine);
}

SurfaceOutcome SurfaceTable::scatter(Ray& ray, Side side, const IndexPair&,
                                     SurfaceInteraction& interaction) const {
  return interact(ray, side, interaction.normal, interaction.direction, interaction.wavelength_nm,
                  interaction.rng);
}

Side SurfaceTable::scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair&,
                           core::Rng& rng) const {
  return interact(ray, side, normal, core::Vec3::Zero(), wavelengths_nm_.front(), rng) ==
                 SurfaceOutcome::inside
             ? Side::inside
             : Side::outside;
}

}  // namespace scintray::optics
