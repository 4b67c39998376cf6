#include <algorithm>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/transport/batch.hpp"
#include "scintray/transport/detail/lane_scene.hpp"
#include "scintray/transport/detail/lanes/lane_kernels.hpp"

namespace scintray::transport {

namespace {

void require_width(int lane_width) {
  const std::vector<int>& widths = core::lane_widths();
  if (std::find(widths.begin(), widths.end(), lane_width) == widths.end())
    throw core::InternalError("this processor has no lanes of width " + std::to_string(lane_width));
}

}  // namespace

LaneKinds lane_kinds(const scene::Scene& scene, int lane_width) {
  require_width(lane_width);
  const LaneKernels kernels = lane_kernels(lane_width);
  LaneKinds kinds;
  for (const scene::Region& region : scene.regions) {
    const bool has_kernel =
        region.lanes == LaneKind::surfaces ? kernels.run != nullptr : kernels.propagate != nullptr;
    kinds.push_back(has_kernel ? region.lanes : LaneKind::none);
  }
  return kinds;
}

LanePlan::LanePlan(const scene::Scene& scene, int lane_width, LaneKinds kinds)
    : width_(lane_width), kinds_(std::move(kinds)), scene_(std::make_unique<const LaneScene>(scene, kinds_)) {
  require_width(lane_width);
}

LanePlan::~LanePlan() = default;

}  // namespace scintray::transport
