#include "scintray/mesh/import/detail/step_import.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {

RawMesh import_step(const std::filesystem::path& path, const std::string&, const Tessellation&) {
  reject_file(path, "STEP cannot be read: this ScintRay was built without Open CASCADE",
              "build it with libocct-data-exchange-dev and libocct-modeling-algorithms-dev installed, or "
              "export the shape as glTF or STL");
}

}  // namespace scintray::mesh
