#include "scintray/exchange/gdml/detail/simple_solids.hpp"

#include "scintray/exchange/gdml/detail/solid_reader.hpp"

namespace scintray::exchange::gdml {

std::optional<mesh::TriMesh> make_simple_solid(Node solid, const Definitions& definitions,
                                               const mesh::Tessellation& tessellation) {
  std::optional<mesh::TriMesh> made = make_flat_solid(solid, definitions, tessellation);
  return made ? std::move(made) : make_round_solid(solid, definitions, tessellation);
}

}  // namespace scintray::exchange::gdml
