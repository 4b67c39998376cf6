#include "scintray/exchange/gdml/detail/volumes_left.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"

namespace scintray::exchange::gdml {

std::vector<double> shares_left(const Structure& structure, Solids& solids) {
  std::vector<double> shares;
  for (const PlacedVolume& placed : structure.placed) {
    double volume_mm3 = 0.0;
    try {
      volume_mm3 = std::abs(placed.to_world.linear().determinant()) *
                   solids.mesh(placed.solid, placed.element).volume();
    } catch (const core::InputError&) {
      // Stated where its part is made.
    }
    shares.push_back(volume_mm3);
  }
  std::vector<double> taken(shares.size(), 0.0);
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (const auto& mother = structure.placed[i].mother) taken[*mother] += shares[i];
  for (std::size_t i = 0; i < shares.size(); ++i)
    shares[i] = shares[i] > 0.0 ? std::max(0.0, 1.0 - taken[i] / shares[i]) : 1.0;
  return shares;
}

}  // namespace scintray::exchange::gdml
