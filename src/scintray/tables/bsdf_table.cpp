#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "scintray/core/vec.hpp"
#include "scintray/core/version.hpp"
#include "scintray/tables/bsdf_text.hpp"

namespace scintray::tables {

namespace {

/// Directions that represent one incidence.
constexpr std::uint64_t kPoints = 40'000;

/// One block of a scattering function as a distribution over its cells about the specular ray.
class BlockCells {
 public:
  BlockCells(const Bsdf& bsdf, std::size_t block) {
    for (const double azimuth : bsdf.angles.azimuth)
      if (azimuth <= 180.0) azimuths_.push_back(azimuth);
    radials_ = bsdf.angles.radial;
    const std::vector<double> cells =
        projected_cells({{}, azimuths_, radials_}, bsdf.angles.specular[block] * core::kDegree);
    const double* const values =
        bsdf.values.data() + block * bsdf.angles.azimuth.size() * bsdf.angles.radial.size();
    double sum = 0.0;
    for (std::size_t k = 0; k < cells.size(); ++k) sums_.push_back(sum += cells[k] * values[k]);
  }

  bool empty() const { return sums_.empty() || !(sums_.back() > 0.0); }

  /// Radial angle and azimuth (rad) about the specular ray at `u` of the cells' sums, and at `v` and `w` of
  /// the solid angle of the cell.
  struct Place {
    double radial, azimuth;
  };
  Place at(double u, double v, double w) const {
    const auto above = std::upper_bound(sums_.begin(), sums_.end() - 1, u * sums_.back());
    const auto cell = static_cast<std::size_t>(above - sums_.begin());
    const auto [radial_low, radial_high] = borders(radials_, cell % radials_.size());
    const auto [azimuth_low, azimuth_high] = borders(azimuths_, cell / radials_.size());
    const double cosine = std::lerp(std::cos(radial_low), std::cos(radial_high), v);
    return {std::acos(std::clamp(cosine, -1.0, 1.0)), std::lerp(azimuth_low, azimuth_high, w)};
  }

 private:
  /// Borders of a cell, rad: halfway to its neighbours, 0 and 180 deg at the ends.
  static std::pair<double, double> borders(const std::vector<double>& points, std::size_t k) {
    const double low = k == 0 ? 0.0 : 0.5 * (points[k - 1] + points[k]) * core::kDegree;
    return {low, k + 1 == points.size() ? core::kPi : 0.5 * (points[k] + points[k + 1]) * core::kDegree};
  }

  std::vector<double> azimuths_, radials_, sums_;
};

/// A scattering function between its angles: shares and directions at any angle of the specular ray.
class Interpolated {
 public:
  explicit Interpolated(const Bsdf& bsdf) : bsdf_(bsdf) {
    for (std::size_t block = 0; block < bsdf.total.size(); ++block) blocks_.emplace_back(bsdf, block);
  }

  /// The share and the directions of an angle (rad): those of the two angles beside it in proportion, each
  /// lobe about the specular ray of this angle. Beyond the first and last angle those of it.
  double share(double specular_rad) const {
    const auto [low, high, part] = neighbours(specular_rad);
    return std::lerp(bsdf_.total[low], bsdf_.total[high], part);
  }
  std::vector<optics::ExitAngles> directions(double specular_rad, const CubePoint& shift) const {
    const auto [low, high, part] = neighbours(specular_rad);
    const double high_share = part * bsdf_.total[high], all = (1.0 - part) * bsdf_.total[low] + high_share;
    std::vector<optics::ExitAngles> exits;
    if (!(all > 0.0)) return exits;
    const double of_high = high_share / all;
    for (std::uint64_t k = 0; k < kPoints; ++k) {
      const CubePoint at = cube_point(k, shift);
      const bool from_high = at.u < of_high;
      const BlockCells& cells = blocks_[from_high ? high : low];
      if (cells.empty()) continue;
      const double u = from_high ? at.u / of_high : (at.u - of_high) / (1.0 - of_high);
      const auto [radial, azimuth] = cells.at(u, at.v, at.w);
      const double to_normal = std::sin(radial) * std::cos(azimuth);
      const double z = std::cos(radial) * std::cos(specular_rad) + to_normal * std::sin(specular_rad);
      if (!(z > 0.0)) continue;  // of a cell that the horizon cuts
      const double x = std::cos(radial) * std::sin(specular_rad) - to_normal * std::cos(specular_rad);
      const double y = std::sin(radial) * std::sin(azimuth);
      // By the cosine to the normal, as cells hold light and not radiance.
      exits.push_back(
          {static_cast<float>(std::acos(std::min(1.0, z))), static_cast<float>(std::atan2(std::abs(y), x))});
    }
    return exits;
  }

 private:
  struct Neighbours {
    std::size_t low, high;
    double part;
  };
  Neighbours neighbours(double specular_rad) const {
    const std::vector<double>& angles = bsdf_.angles.specular;
    const double degrees = specular_rad / core::kDegree;
    const auto above = std::upper_bound(angles.begin(), angles.end(), degrees);
    if (above == angles.begin()) return {0, 0, 0.0};
    const auto low = static_cast<std::size_t>(above - angles.begin()) - 1;
    if (above == angles.end()) return {low, low, 0.0};
    return {low, low + 1, (degrees - angles[low]) / (angles[low + 1] - angles[low])};
  }

  const Bsdf& bsdf_;
  std::vector<BlockCells> blocks_;
};

}  // namespace

optics::SurfaceTable bsdf_table(const Bsdf& reflected, const Bsdf* transmitted,
                                const ImportSettings& settings, const std::string& name) {
  check_indices(settings.index);
  const double ratio = settings.index.inside / settings.index.outside;
  std::set<double> incidences{0.0, 0.5 * core::kPi};
  for (const double degrees : reflected.angles.specular) incidences.insert(degrees * core::kDegree);
  if (transmitted)
    for (const double degrees : transmitted->angles.specular)
      if (const double sine = std::sin(degrees * core::kDegree) / ratio; sine < 1.0)
        incidences.insert(std::asin(sine));
  const Interpolated back(reflected);
  const std::optional<Interpolated> on =
      transmitted ? std::optional<Interpolated>(*transmitted) : std::nullopt;
  std::vector<optics::TableNode> nodes;
  for (const double incidence : incidences) {
    constexpr double kLeastStep_rad = 1e-5;
    if (!nodes.empty() && incidence - nodes.back().incidence_rad < kLeastStep_rad) continue;
    optics::TableNode node;
    node.incidence_rad = node.traced_incidence_rad = incidence;
    const CubePoint shift = random_shift(1, nodes.size(), 4);
    std::vector<optics::ExitAngles> directions = back.directions(incidence, shift);
    node.reflectance = directions.empty() ? 0.0 : std::min(1.0, back.share(incidence));
    node.reflected = optics::quantiles_of(directions);
    double through = 0.0;
    if (const double sine = ratio * std::sin(incidence); on && sine < 1.0) {
      directions = on->directions(std::asin(sine), shift);
      through = directions.empty() ? 0.0 : std::min(1.0 - node.reflectance, on->share(std::asin(sine)));
      node.transmitted = optics::quantiles_of(directions);
    }
    node.absorptance = 1.0 - node.reflectance - through;
    if (through <= 0.0) node.transmitted = {};
    if (node.transmitted.empty()) node.absorptance = 1.0 - node.reflectance;
    nodes.push_back(std::move(node));
  }
  optics::TableProvenance provenance;
  provenance.map = name;
  provenance.preparation =
      std::string("tabulated BSDF with indices given on import; ") +
      (on ? "light beyond the critical angle is not transmitted" : "nothing is transmitted") +
      "; from outside, not in the file: " + core::word_of(kFromOutsideWords, settings.from_outside) +
      "; errors unknown";
  provenance.version = core::version();
  return optics::SurfaceTable(settings.index, std::move(nodes),
                              outside_nodes(settings.index, settings.from_outside), std::move(provenance));
}

}  // namespace scintray::tables
