#include "scintray/io/gdml/simple_solids.hpp"

#include "scintray/io/gdml/solid_reader.hpp"

namespace scintray::gdml {

std::optional<TriMesh> make_simple_solid(Node solid, const Definitions& definitions,
                                         const Tessellation& tessellation) {
  std::optional<TriMesh> made = make_flat_solid(solid, definitions, tessellation);
  return made ? std::move(made) : make_round_solid(solid, definitions, tessellation);
}

}  // namespace scintray::gdml
