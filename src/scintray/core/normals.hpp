#pragma once
/// Many normal deviates at once.

#include <span>

#include "scintray/core/lane_width.hpp"
#include "scintray/core/philox.hpp"

namespace scintray::core {

/// Standard normal deviates: those of as many calls of sample_normal(), to the last bit.
/// @param lane_width  deviates computed at once, of lane_widths()
void sample_normals(Rng& rng, std::span<double> deviates, int lane_width = default_lane_width());

}  // namespace scintray::core
