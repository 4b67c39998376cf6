#include "scintray/transport/detail/lanes/lane_kernels.hpp"

namespace scintray::transport {

LaneKernels lane_kernels(int width) {
  switch (width) {
#if defined(__x86_64__)
    case 2:
      return {propagate_lanes_2, propagate_lanes_in_body_2};
    case 4:
      return {propagate_lanes_4, propagate_lanes_in_body_4, refract_lanes_4, run_lanes_4};
    case 8:
      return {propagate_lanes_8, propagate_lanes_in_body_8, refract_lanes_8, run_lanes_8};
#endif
    default:
      return {};
  }
}

}  // namespace scintray::transport
