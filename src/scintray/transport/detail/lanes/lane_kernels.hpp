#pragma once
/// The kernels for lanes of one width.

#include "scintray/transport/detail/lanes/lane_kernel.hpp"
#include "scintray/transport/detail/lanes/lane_pool.hpp"

namespace scintray::transport {

/// All null for width 1.
struct LaneKernels {
  PropagateLanes propagate = nullptr;
  PropagateLanesInBody propagate_in_body = nullptr;
  // Null for width 2 as well.
  RefractLanes refract = nullptr;
  RunLanes run = nullptr;  ///< of two lanes slower than photons one by one
};

/// @param width  of lane_widths()
LaneKernels lane_kernels(int width);

}  // namespace scintray::transport
