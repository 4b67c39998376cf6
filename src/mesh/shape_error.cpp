#include "scintray/mesh/shape_error.hpp"

#include "scintray/core/error.hpp"

namespace scintray {

void reject_shape(const std::string& what, const std::string& hint) {
  throw InputError(Problem{{}, what, hint});
}

}  // namespace scintray
