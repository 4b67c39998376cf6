#pragma once
/// Numbers of photons that are propagated at once, one in each lane of a vector register.

#include <vector>

namespace scintray::core {

/// Widths that this build has and this processor can run, ascending, 1 among them: 1, 2 (SSE2), 4 (AVX2) and
/// 8 (AVX-512) doubles on x86-64.
const std::vector<int>& lane_widths();

/// The width used by default: the widest of lane_widths(), but 4 on processors that lower their clock for 8.
int default_lane_width();

}  // namespace scintray::core
