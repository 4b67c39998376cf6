#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/mesh_format.hpp"

namespace scintray::mesh {

RawMesh import_step(const MeshFile& file) {
  reject_file(file.path, "STEP cannot be read: this ScintRay was built without Open CASCADE",
              "build it with libocct-data-exchange-dev and libocct-modeling-algorithms-dev installed, or "
              "export the shape as glTF or STL");
}

}  // namespace scintray::mesh
