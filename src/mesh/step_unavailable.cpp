#include "scintray/mesh/file_checks.hpp"
#include "scintray/mesh/step_import.hpp"

namespace scintray {

RawMesh import_step(const std::filesystem::path& path, const std::string&, const Tessellation&) {
  reject_file(path, "STEP cannot be read: this ScintRay was built without Open CASCADE",
              "build it with libocct-data-exchange-dev and libocct-modeling-algorithms-dev installed, or "
              "export the shape as glTF or STL");
}

}  // namespace scintray
