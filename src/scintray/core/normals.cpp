#include "scintray/core/normals.hpp"

#include "scintray/core/detail/normal_kernels.hpp"

namespace scintray::core {

namespace {

DrawNormals kernel_of(int lane_width) {
  switch (lane_width) {
#if defined(__x86_64__)
    case 4:
      return draw_normals_4;
    case 8:
      return draw_normals_8;
#endif
    default:
      return nullptr;
  }
}

/// Draws as many deviates as a kernel does, and sets the stream to behind them.
void draw(DrawNormals kernel, Rng& rng, NormalLanes& lanes) {
  static_assert(NormalLanes::kLeft == Rng::kDrawn);
  std::copy(rng.drawn().begin(), rng.drawn().end(), lanes.numbers);
  std::copy(rng.counter().begin(), rng.counter().end(), lanes.counter);
  std::copy(rng.key().begin(), rng.key().end(), lanes.key);
  lanes.left = rng.ahead().size();
  kernel(lanes);
  Rng::Numbers last;
  std::copy(std::end(lanes.numbers) - Rng::kDrawn, std::end(lanes.numbers), last.begin());
  rng.skip_blocks(NormalLanes::kBlocks, last);
}

}  // namespace

void sample_normals(Rng& rng, std::span<double> deviates, int lane_width) {
  std::size_t next = 0;
  if (const DrawNormals kernel = kernel_of(lane_width)) {
    NormalLanes lanes;  // NOLINT(cppcoreguidelines-pro-type-member-init): draw() sets what the kernel reads
    for (; deviates.size() - next >= NormalLanes::kDeviates; next += NormalLanes::kDeviates) {
      draw(kernel, rng, lanes);
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
