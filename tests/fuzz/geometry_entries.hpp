#pragma once
/// Entries for the readers of meshes, CAD files and GDML. What is read must be whole: indices in range,
/// coordinates finite.

#include "entries.hpp"

namespace scintray::fuzz {

std::span<const Entry> geometry_entries();

}  // namespace scintray::fuzz
