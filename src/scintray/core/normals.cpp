#include "scintray/core/normals.hpp"

#include "scintray/core/detail/normal_kernels.hpp"

namespace scintray::core {

namespace {

SetNormals kernel_of(int lane_width) {
  switch (lane_width) {
#if defined(__x86_64__)
    case 4:
      return set_normals_4;
    case 8:
      return set_normals_8;
#endif
    default:
      return nullptr;
  }
}

}  // namespace

void sample_normals(Rng& rng, std::span<double> deviates, int lane_width) {
  std::size_t next = 0;
  if (const SetNormals kernel = kernel_of(lane_width)) {
    NormalLanes lanes;  // NOLINT(cppcoreguidelines-pro-type-member-init): set below
    for (; deviates.size() - next >= NormalLanes::kDeviates; next += NormalLanes::kDeviates) {
      Rng stream = rng;  // in registers
      for (std::size_t i = 0; i < NormalLanes::kPairs; ++i) {
        lanes.for_radius[i] = stream.bits();
        lanes.turn[i] = stream.bits();
      }
      rng = stream;
      kernel(lanes);
      std::copy(std::begin(lanes.deviates), std::end(lanes.deviates),
                deviates.begin() + static_cast<std::ptrdiff_t>(next));
    }
  }
  for (; next < deviates.size(); next += 2) {
    const IndependentPair<double> pair = sample_normal_pair(rng);
    deviates[next] = pair.first;
    if (next + 1 < deviates.size()) deviates[next + 1] = pair.second;
  }
}

}  // namespace scintray::core
