#pragma once
/// The one place of the exchange formats that knows how a node keeps what its surface absorbs.

#include <string>

#include "scintray/core/error.hpp"
#include "scintray/surface/table.hpp"

namespace scintray {

/// Share of the light met at a node that is absorbed; 0 for nodes of lossless tables.
template <class Node>
double absorptance_of(const Node& node) {
  if constexpr (requires { node.absorptance; })
    return node.absorptance;
  else
    return 0.0;
}

/// InputError when the tables of this version hold no absorption and `share` is not zero.
template <class Node>
void set_absorptance(Node& node, double share) {
  if constexpr (requires { node.absorptance; })
    node.absorptance = share;
  else if (share > 0.0)
    throw InputError({{},
                      "a surface that absorbs " + std::to_string(share) +
                          " of the light; the surface tables of this version are lossless",
                      "import it with a reflectance of 1, and put the reflector's losses into the stack"});
}

}  // namespace scintray
