#pragma once
/// Solids that are made from their own measures only.

#include <optional>

#include "scintray/exchange/gdml/detail/definitions.hpp"
#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::exchange::gdml {

/// The mesh of a solid that is no boolean; nothing for a kind that is not made here. Measures mean what they
/// mean in the GDML User's Guide (CERN), chapter "Solids".
/// @throws InputError for impossible measures, without a place.
std::optional<mesh::TriMesh> make_simple_solid(Node solid, const Definitions& definitions,
                                               const mesh::Tessellation& tessellation);

}  // namespace scintray::exchange::gdml
