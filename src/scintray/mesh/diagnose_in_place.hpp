#pragma once
/// Diagnosing placed meshes.

#include "scintray/mesh/diagnosis.hpp"

namespace scintray::mesh {

/// diagnose() about the middle of the mesh, so that a part far from the origin is not evaluated by the
/// rounding of its distance: what is short against that may still be a sound film. Places and bounds are
/// the mesh's own. @throws InputError as diagnose().
[[nodiscard]] MeshDiagnosis diagnose_in_place(const TriMesh& mesh);

}  // namespace scintray::mesh
