#pragma once
/// Surface tables for the tests of exchange formats, tabulated from facet models in a moment.

#include <algorithm>
#include <cmath>
#include <vector>

#include "scintray/core/vec.hpp"
#include "scintray/optics/facets.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::test {

inline constexpr optics::IndexPair kLsoToAir{1.82, 1.0};

inline optics::TableNode tabulated_node(const optics::FacetSurface& surface, optics::Side side,
                                        double incidence_rad) {
  constexpr std::uint64_t kRays = 20000;
  optics::TableNode node;
  node.incidence_rad = incidence_rad;
  node.traced_incidence_rad = std::min(incidence_rad, 89.9 * core::kDegree);
  std::vector<optics::ExitAngles> reflected, transmitted;
  const double into = side == optics::Side::inside ? 1.0 : -1.0;
  for (std::uint64_t k = 0; k < kRays; ++k) {
    core::Rng rng(41, core::StreamKind::table, static_cast<std::uint64_t>(incidence_rad * 1e6), k);
    optics::Ray ray{{std::sin(node.traced_incidence_rad), 0.0, into * std::cos(node.traced_incidence_rad)},
                    core::Vec3::Zero()};
    const bool back = surface.scatter(ray, side, core::Vec3::UnitZ(), kLsoToAir, rng) == side;
    (back ? reflected : transmitted)
        .push_back({static_cast<float>(std::acos(std::min(1.0, std::abs(ray.direction.z())))),
                    static_cast<float>(std::abs(std::atan2(ray.direction.y(), ray.direction.x())))});
  }
  node.rays = kRays;
  node.reflectance = static_cast<double>(reflected.size()) / kRays;
  node.reflectance_error = std::sqrt(node.reflectance * (1.0 - node.reflectance) / kRays);
  node.reflected = optics::quantiles_of(reflected);
  node.transmitted = optics::quantiles_of(transmitted);
  return node;
}

/// Facets tilted by `sigma_alpha_rad`, in steps of 3 deg of incidence, LSO to air.
inline optics::SurfaceTable tabulated(double sigma_alpha_rad) {
  optics::FacetSurface surface;
  surface.sigma_alpha_rad = sigma_alpha_rad;
  std::vector<optics::TableNode> nodes[2];
  for (const optics::Side side : {optics::Side::inside, optics::Side::outside})
    for (int k = 0; k <= 30; ++k)
      nodes[static_cast<int>(side)].push_back(
          tabulated_node(surface, side, k == 30 ? 0.5 * core::kPi : 3.0 * k * core::kDegree));
  return optics::SurfaceTable(kLsoToAir, nodes[0], nodes[1], {});
}

inline const optics::SurfaceTable& rough_table() {
  static const optics::SurfaceTable table = tabulated(18.0 * core::kDegree);
  return table;
}

/// Lobes 2 deg wide: one degree more or less of incidence is plain to see.
inline const optics::SurfaceTable& nearly_polished_table() {
  static const optics::SurfaceTable table = tabulated(0.5 * core::kDegree);
  return table;
}

}  // namespace scintray::test
