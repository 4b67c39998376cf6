#pragma once
/// The optical surfaces of a GDML file as surface definitions.

#include <string>
#include <vector>

#include "scintray/exchange/gdml/detail/definitions.hpp"

namespace scintray::exchange::gdml {

struct ImportedSurface {
  std::string toml;                ///< the keys of [surfaces.NAME]; empty when it cannot be carried over
  std::vector<std::string> notes;  ///< what was not carried over, and why
};

/// An <opticalsurface>, in words or in Geant4's numbers: models glisur and unified, types
/// dielectric_dielectric and dielectric_metal, the six finishes polished to groundbackpainted, as presets
/// geant4_... of the library. Tables (LUT, Davis, dichroic) are not in the file and cannot be carried over.
ImportedSurface import_surface(Node surface, const GdmlFile& file, const Definitions& definitions);

}  // namespace scintray::exchange::gdml
