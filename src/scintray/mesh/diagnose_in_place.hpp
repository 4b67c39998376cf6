#pragma once
/// Diagnosing placed meshes.

#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {

/// diagnose() relative to the middle of the mesh, so that the rounding of a part far from the origin does not
/// affect the diagnosis: what is small compared with that rounding may still be a sound film. Positions and
/// bounds are the mesh's own. @throws InputError as diagnose().
[[nodiscard]] MeshDiagnosis diagnose_in_place(const TriMesh& mesh);

}  // namespace scintray::mesh
