#include "scintray/mesh/shapes/shape_error.hpp"

#include "scintray/core/error.hpp"

namespace scintray::mesh {

void reject_shape(const std::string& what, const std::string& hint) {
  throw core::InputError(core::Problem{{}, what, hint});
}

}  // namespace scintray::mesh
