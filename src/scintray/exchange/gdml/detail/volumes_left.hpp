#pragma once
/// What the daughters of volumes leave of their mothers.

#include <vector>

#include "scintray/exchange/gdml/detail/solids.hpp"
#include "scintray/exchange/gdml/detail/structure.hpp"

namespace scintray::exchange::gdml {

/// Share of each placed volume, in the order of Structure::placed, that is outside of its daughters, which
/// are taken to be inside their mother and not in each other, as Geant4 requires; 1 where a solid cannot be
/// made.
std::vector<double> shares_left(const Structure& structure, Solids& solids);

/// Shares up to this are rounding.
inline constexpr double kNothingLeft = 1e-9;

}  // namespace scintray::exchange::gdml
