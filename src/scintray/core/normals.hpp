#pragma once
/// Many normal deviates at once.

#include <span>

#include "scintray/core/lane_width.hpp"
#include "scintray/core/philox.hpp"

namespace scintray::core {

/// Standard normal deviates: those of sample_normal_pair() one after the other, to the last bit; of an odd
/// number of them, the second of the last pair is left out.
/// @param lane_width  deviates computed at once, of lane_widths()
void sample_normals(Rng& rng, std::span<double> deviates, int lane_width = default_lane_width());

}  // namespace scintray::core
