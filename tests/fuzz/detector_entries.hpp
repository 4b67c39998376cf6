#pragma once
/// Files of other programs about a detector or a surface: GATE's, scattering functions, columns of hits.

#include <span>

#include "entries.hpp"

namespace scintray::fuzz {

std::span<const Entry> detector_entries();

}  // namespace scintray::fuzz
