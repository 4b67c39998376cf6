#pragma once

namespace scintray::bench {

/// Cycles of the processor in a nanosecond, in the middle of some measurements: by additions each of which
/// waits for the one before, and takes one cycle.
double core_clock_per_ns();

}  // namespace scintray::bench
