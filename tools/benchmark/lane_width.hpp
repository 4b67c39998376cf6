#pragma once

namespace scintray::bench {

/// Number of photons that a thread traces at once. One: the tracer has no lanes yet. All figures take their
/// lane width from here.
inline constexpr int kLaneWidth = 1;

}  // namespace scintray::bench
