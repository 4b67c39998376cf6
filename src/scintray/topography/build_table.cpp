#include "scintray/topography/build_table.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "scintray/core/statistics.hpp"
#include "scintray/core/version.hpp"
#include "scintray/optics/reciprocal_kernel.hpp"
#include "scintray/topography/detail/node_bytes.hpp"
#include "scintray/topography/resumable_table.hpp"

namespace scintray::topography {

namespace {

/// Nodes are addressed by integers so that bisection is exact and a node's random streams do not
/// depend on the order in which nodes were found.
constexpr std::uint64_t kUnitsPerStep = std::uint64_t{1} << 24;

/// Random streams of the reciprocal kernel's states, apart from those of nodes.
constexpr std::uint64_t kKernelStreams = std::uint64_t{1} << 62;

/// Result of one ray.
struct RayEnd {
  optics::SurfaceOutcome outcome = optics::SurfaceOutcome::inside;
  double first_slope_rad = 0.0;
  bool cut = false;
};

/// Traces a ray, in the surface's own frame (z: the mean normal), to the surface and until it leaves.
using SendRay =
    std::function<RayEnd(optics::Ray& ray, optics::Side side, const SpectralPoint& at, core::Rng& rng)>;

struct RayRecord {
  optics::ExitAngles exit;
  float first_slope_rad = 0.0f;
  optics::SurfaceOutcome outcome = optics::SurfaceOutcome::inside;
  bool cut = false;
  bool unclassified = false;
};

/// Angles of an outgoing direction, from the outgoing normal and from the forward azimuth.
optics::ExitAngles exit_angles(const core::Vec3& direction, double forward_azimuth,
                               optics::AzimuthKind kind) {
  const double lateral = std::hypot(direction.x(), direction.y());
  const double polar = std::atan2(lateral, std::abs(direction.z()));
  const double azimuth =
      std::remainder(std::atan2(direction.y(), direction.x()) - forward_azimuth, core::kTwoPi);
  return {static_cast<float>(polar),
          static_cast<float>(kind == optics::AzimuthKind::folded ? std::abs(azimuth) : azimuth)};
}

/// Aligns the maps of a surface, and of its shares, with x: the builder rotates the light instead.
void lay_along_x(optics::Surface& surface) {
  surface.direction = core::Vec3::UnitX();
  for (optics::SurfaceShare& part : surface.mixture) {
    optics::Surface share = *part.surface;
    lay_along_x(share);
    part.surface = std::make_shared<const optics::Surface>(std::move(share));
  }
}

class Builder {
 public:
  Builder(SendRay send, const std::vector<SpectralPoint>& spectrum, const TableSettings& settings,
          const TableProgress& progress, core::Journal* journal)
      : send_(std::move(send)),
        spectrum_(spectrum),
        settings_(settings),
        progress_(progress),
        journal_(journal) {
    intervals_ = static_cast<std::uint64_t>(std::ceil(0.5 * core::kPi / settings.incidence_step_rad - 1e-9));
    azimuths_ = static_cast<std::uint64_t>(std::ceil(core::kTwoPi / settings.azimuth_step_rad - 1e-9));
    kind_ = settings.directional ? optics::AzimuthKind::directional : optics::AzimuthKind::folded;
    planned_ = 2 * (intervals_ + 1) * spectrum.size() * slices_per_wavelength();
  }

  std::vector<optics::TableSlice> slices() {
    std::vector<optics::TableSlice> result;
    for (std::size_t k = 0; k < spectrum_.size(); ++k)
      for (std::uint64_t azimuth = 0; azimuth < slices_per_wavelength(); ++azimuth) {
        point_ = &spectrum_[k];
        slice_ = result.size();
        slice_azimuth_ = core::kTwoPi * static_cast<double>(azimuth) / static_cast<double>(azimuths_);
        result.push_back({point_->wavelength_nm, settings_.directional ? slice_azimuth_ : 0.0, point_->index,
                          side(optics::Side::inside), side(optics::Side::outside),
                          settings_.reciprocal ? reciprocal_kernel() : nullptr});
      }
    return result;
  }

  optics::AzimuthKind kind() const { return kind_; }
  const std::string& reciprocity() const { return reciprocity_; }
  std::uint64_t azimuths() const { return azimuths_; }
  std::uint64_t cut() const { return cut_; }
  std::uint64_t unclassified() const { return unclassified_; }
  std::uint64_t unconverged() const { return unconverged_; }

 private:
  std::uint64_t slices_per_wavelength() const { return settings_.directional ? azimuths_ : 1; }
  /// Rays of one batch of a node.
  std::uint64_t batch() const { return settings_.rays * (settings_.directional ? 1 : azimuths_); }

  std::vector<optics::TableNode> side(optics::Side side) {
    std::map<std::uint64_t, optics::TableNode> nodes;
    std::vector<std::uint64_t> wanted;
    for (std::uint64_t k = 0; k <= intervals_; ++k) wanted.push_back(k * kUnitsPerStep);
    while (!wanted.empty()) {
      for (const std::uint64_t position : wanted) nodes.emplace(position, trace(side, position));
      wanted = to_insert(nodes);
      planned_ += wanted.size();
    }
    std::vector<optics::TableNode> result;
    for (auto& [position, node] : nodes) result.push_back(std::move(node));
    return result;
  }

  double incidence(std::uint64_t position) const {
    return 0.5 * core::kPi * static_cast<double>(position) / static_cast<double>(intervals_ * kUnitsPerStep);
  }

  std::vector<std::uint64_t> to_insert(const std::map<std::uint64_t, optics::TableNode>& nodes) const {
    std::vector<std::uint64_t> result;
    if (!settings_.refine) return result;
    for (auto low = nodes.begin(), high = std::next(low); high != nodes.end(); ++low, ++high) {
      const optics::TableNode &a = low->second, &b = high->second;
      const double change = std::abs(b.reflectance - a.reflectance);
      const double noise = std::hypot(a.reflectance_error, b.reflectance_error);
      const bool wide = b.incidence_rad - a.incidence_rad > settings_.refine_down_to_rad;
      if (wide && change > settings_.refine_change && change > 4.0 * noise && high->first - low->first > 1)
        result.push_back(low->first + (high->first - low->first) / 2);
    }
    return result;
  }

  RayRecord follow(optics::Side side, std::uint64_t position, double angle, std::uint64_t number) const {
    const std::uint64_t address = (static_cast<std::uint64_t>(side) << 60) | position;
    core::Rng rng(settings_.seed, core::StreamKind::table, address, number, slice_);
    // Azimuths are stratified, not fixed: the rows of the map are not a special direction.
    const double stratum = static_cast<double>((number % batch()) / settings_.rays);
    const double azimuth = settings_.directional
                               ? slice_azimuth_
                               : core::kTwoPi * (stratum + rng.uniform()) / static_cast<double>(azimuths_);
    const double up = side == optics::Side::inside ? 1.0 : -1.0;
    optics::Ray ray{
        {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), up * std::cos(angle)},
        core::Vec3::Zero()};
    const RayEnd end = send_(ray, side, *point_, rng);
    return {exit_angles(ray.direction, azimuth, kind_), static_cast<float>(end.first_slope_rad), end.outcome,
            end.cut, is_unclassified(end, ray)};
  }

  static bool is_unclassified(const RayEnd& end, const optics::Ray& ray) {
    return !end.cut && !leaves_into_medium(end.outcome, ray.direction);
  }

  std::shared_ptr<const optics::ReciprocalKernel> reciprocal_kernel() {
    using Kernel = optics::ReciprocalKernel;
    const std::uint64_t rays = std::max<std::uint64_t>(1, batch() / 2);
    constexpr std::size_t kRow = std::size_t{Kernel::kStates} * Kernel::kTurns;
    std::vector<std::uint32_t> counts(Kernel::kStates * kRow);
    const std::string key = detail::node_key(slice_, 2, 0);
    const std::optional<std::string> earlier = journal_ ? journal_->find(key) : std::nullopt;
    if (earlier) counts = core::numbers_of<std::uint32_t>(*earlier);
    // One task per state: none writes into another's row.
    const int states = earlier ? 0 : Kernel::kStates;
    tbb::parallel_for(0, states, [&](int state) {
      const optics::Side from = state < Kernel::kPolar ? optics::Side::inside : optics::Side::outside;
      for (std::uint64_t k = 0; k < rays; ++k) {
        core::Rng rng(settings_.seed, core::StreamKind::table,
                      kKernelStreams | static_cast<std::uint64_t>(state), k, slice_);
        const double sine2 = (state % Kernel::kPolar + rng.uniform()) / Kernel::kPolar;
        const double azimuth = core::kTwoPi * rng.uniform();
        const double sine = std::sqrt(sine2), cosine = std::sqrt(1.0 - sine2);
        optics::Ray ray{{sine * std::cos(azimuth), sine * std::sin(azimuth),
                         from == optics::Side::inside ? cosine : -cosine},
                        core::Vec3::Zero()};
        const RayEnd end = send_(ray, from, *point_, rng);
        if (end.outcome == optics::SurfaceOutcome::absorbed) continue;
        if (is_unclassified(end, ray)) ++unclassified_;
        const optics::ExitAngles exit = exit_angles(ray.direction, azimuth, optics::AzimuthKind::folded);
        const double out = std::pow(std::sin(static_cast<double>(exit.polar)), 2);
        const optics::Side to =
            end.outcome == optics::SurfaceOutcome::inside ? optics::Side::inside : optics::Side::outside;
        ++counts[static_cast<std::size_t>(state) * kRow +
                 static_cast<std::size_t>(Kernel::target(Kernel::state(to, out), exit.azimuth))];
      }
    });
    if (journal_ && !earlier && unclassified_ == 0) journal_->add(key, core::bytes_of(counts));
    Kernel::Report report;
    auto kernel = std::make_shared<const Kernel>(Kernel::from_counts(point_->index, counts, rays, report));
    reciprocity_ += fmt::format(
        "{}traced: chi2 of reversal {:.0f} for {} pairs of directions, {:.4f} a pair; n1^2 (1 - R12) = "
        "{:.5f} +- {:.5f}, "
        "n2^2 (1 - R21) = {:.5f} +- {:.5f}; largest scaling {:.2g}",
        reciprocity_.empty() ? "" : "; ", report.chi2, report.pairs,
        report.chi2 / static_cast<double>(report.pairs), report.diffuse_inside, report.diffuse_inside_error,
        report.diffuse_outside, report.diffuse_outside_error, report.largest_scaling);
    return kernel;
  }

  optics::TableNode trace(optics::Side side, std::uint64_t position) {
    const std::string key = detail::node_key(slice_, static_cast<std::uint64_t>(side), position);
    const std::optional<std::string> earlier = journal_ ? journal_->find(key) : std::nullopt;
    if (earlier) {
      const detail::TracedNode traced = detail::decoded_node(*earlier);
      cut_ += traced.cut;
      unconverged_ += traced.unconverged;
      count_node();
      return traced.node;
    }
    const std::uint64_t cut = cut_, unconverged = unconverged_, unclassified = unclassified_;
    optics::TableNode node = trace_anew(side, position);
    if (journal_ && unclassified_ == unclassified)
      journal_->add(key, detail::encoded_node({node, cut_ - cut, unconverged_ - unconverged}));
    count_node();
    return node;
  }

  void count_node() {
    if (progress_ && !progress_(static_cast<double>(++done_) / static_cast<double>(planned_)))
      throw TableStopped("building the surface table was stopped");
  }

  optics::TableNode trace_anew(optics::Side side, std::uint64_t position) {
    optics::TableNode node;
    node.incidence_rad = incidence(position);
    node.traced_incidence_rad = std::min(node.incidence_rad, settings_.grazing_rad);
    records_.clear();
    do {
      add_batch(side, position, node.traced_incidence_rad);
      reduce(node, side);
    } while (!converged(node) && records_.size() < settings_.most_rays * batch());
    unconverged_ += converged(node) ? 0 : 1;
    return node;
  }

  void add_batch(optics::Side side, std::uint64_t position, double angle) {
    constexpr std::size_t kGrain = 1024;
    const std::size_t first = records_.size();
    records_.resize(first + batch());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, records_.size(), kGrain),
                      [&](const auto& range) {
                        for (std::size_t k = range.begin(); k != range.end(); ++k)
                          records_[k] = follow(side, position, angle, k);
                      });
  }

  bool converged(const optics::TableNode& node) const {
    return settings_.target_error == 0.0 ||
           std::max(node.reflectance_error, node.absorptance_error) <= settings_.target_error;
  }

  /// Reduces the records in their order, independent of the threads.
  void reduce(optics::TableNode& node, optics::Side side) {
    std::vector<optics::ExitAngles> reflected, transmitted;
    std::uint64_t absorbed = 0, cut = 0, unclassified = 0;
    double slopes = 0.0;
    for (const RayRecord& record : records_) {
      slopes += record.first_slope_rad;
      cut += record.cut ? 1 : 0;
      unclassified += record.unclassified ? 1 : 0;
      if (record.outcome == optics::SurfaceOutcome::absorbed)
        ++absorbed;
      else
        (record.outcome == optics::outcome_on(side) ? reflected : transmitted).push_back(record.exit);
    }
    node.rays = records_.size();
    const double rays = static_cast<double>(node.rays);
    node.reflectance = static_cast<double>(reflected.size()) / rays;
    node.reflectance_error = core::binomial_estimate(reflected.size(), node.rays).error;
    node.absorptance = static_cast<double>(absorbed) / rays;
    node.absorptance_error = absorbed > 0 ? core::binomial_estimate(absorbed, node.rays).error : 0.0;
    node.mean_slope_rad = slopes / rays;
    if (!converged(node) && records_.size() < settings_.most_rays * batch()) return;
    cut_ += cut;
    unclassified_ += unclassified;
    node.reflected = optics::quantiles_of(reflected, kind_);
    node.transmitted = optics::quantiles_of(transmitted, kind_);
  }

  const SendRay send_;
  const std::vector<SpectralPoint>& spectrum_;
  const TableSettings& settings_;
  const TableProgress& progress_;
  core::Journal* journal_;
  optics::AzimuthKind kind_ = optics::AzimuthKind::folded;
  const SpectralPoint* point_ = nullptr;  ///< of the current slice
  std::uint64_t slice_ = 0;
  double slice_azimuth_ = 0.0;
  std::uint64_t intervals_ = 0, azimuths_ = 0, cut_ = 0, unconverged_ = 0;
  std::uint64_t done_ = 0, planned_ = 0;
  std::atomic<std::uint64_t> unclassified_ = 0;
  std::string reciprocity_;
  std::vector<RayRecord> records_;
};

optics::SurfaceTable build(SendRay send, const std::vector<SpectralPoint>& spectrum,
                           const TableSettings& settings, optics::TableProvenance provenance,
                           const TableProgress& progress, core::Journal* journal = nullptr) {
  require_valid(settings, spectrum);
  Builder builder(std::move(send), spectrum, settings, progress, journal);
  std::vector<optics::TableSlice> slices = builder.slices();
  provenance.seed = settings.seed;
  provenance.rays_per_azimuth = settings.rays;
  provenance.azimuths = builder.azimuths();
  provenance.unclassified = builder.unclassified();
  if (provenance.unclassified > 0)
    throw core::InternalError(
        fmt::format("{} rays left a surface in a direction away from their medium", provenance.unclassified));
  provenance.cut = builder.cut();
  provenance.target_error = settings.target_error;
  provenance.unconverged = builder.unconverged();
  provenance.reciprocity = builder.reciprocity();
  provenance.version = core::version();
  return optics::SurfaceTable(std::move(slices), builder.kind(), std::move(provenance));
}

}  // namespace

bool leaves_into_medium(optics::SurfaceOutcome outcome, const core::Vec3& direction) {
  switch (outcome) {
    case optics::SurfaceOutcome::inside:
      return direction.z() <= 0.0;
    case optics::SurfaceOutcome::outside:
      return direction.z() >= 0.0;
    case optics::SurfaceOutcome::absorbed:
      return true;
  }
  throw core::InternalError("unknown outcome at a surface");
}

namespace {

/// Rays that begin anywhere over a period of the field.
SendRay into(const optics::HeightField& field) {
  return [&field](optics::Ray& ray, optics::Side side, const SpectralPoint& at, core::Rng& rng) -> RayEnd {
    const double x = field.period_x_um() * rng.uniform();
    const double y = field.period_y_um() * rng.uniform();
    const optics::HeightFieldExit exit = field.follow(ray, side, x, y, at.index, rng);
    return {optics::outcome_on(exit.side), exit.first_slope_rad, exit.cut};
  };
}

}  // namespace

optics::SurfaceTable build_table(const optics::HeightField& field, const std::vector<SpectralPoint>& spectrum,
                                 const TableSettings& settings, optics::TableProvenance provenance,
                                 const TableProgress& progress) {
  return build(into(field), spectrum, settings, std::move(provenance), progress);
}

optics::SurfaceTable build_table(const optics::HeightField& field, const std::vector<SpectralPoint>& spectrum,
                                 const TableSettings& settings, optics::TableProvenance provenance,
                                 const TableProgress& progress, core::Journal& journal) {
  return build(into(field), spectrum, settings, std::move(provenance), progress, &journal);
}

optics::SurfaceTable build_table(const optics::HeightField& field, const optics::IndexPair& index,
                                 const TableSettings& settings, optics::TableProvenance provenance,
                                 const TableProgress& progress) {
  return build_table(field, std::vector<SpectralPoint>{{0.0, index}}, settings, std::move(provenance),
                     progress);
}

optics::SurfaceTable build_stack_table(const optics::Surface& surface,
                                       const std::vector<SpectralPoint>& spectrum,
                                       const TableSettings& settings, optics::TableProvenance provenance,
                                       const TableProgress& progress) {
  optics::Surface laid = surface;
  lay_along_x(laid);
  const auto send = [&laid](optics::Ray& ray, optics::Side side, const SpectralPoint& at,
                            core::Rng& rng) -> RayEnd {
    return {laid.interact(ray, side, core::Vec3::UnitZ(), at.index, at.wavelength_nm, rng), 0.0, false};
  };
  return build(send, spectrum, settings, std::move(provenance), progress);
}

}  // namespace scintray::topography
