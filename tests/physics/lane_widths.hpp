#pragma once
/// Photons of a scene by every width of the lanes, compared bit by bit.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "scintray/core/lane_width.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::test {

/// A result, and the photons detected.
struct TracedPhotons {
  tally::PointResult result;
  std::vector<tally::DetectedPhoton> list;
};

inline bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

inline bool same_bits(const tally::DetectedPhoton& a, const tally::DetectedPhoton& b) {
  return a.event == b.event && a.photon == b.photon && a.position_mm == b.position_mm &&
         a.direction == b.direction && a.time_ns == b.time_ns && a.path_mm == b.path_mm &&
         a.wavelength_nm == b.wavelength_nm && a.interactions == b.interactions;
}

/// Equal to the last bit.
inline void check_same(const TracedPhotons& a, const TracedPhotons& b) {
  using tally::PointResult;
  CHECK(a.result.photons == b.result.photons);
  CHECK(a.result.fates == b.result.fates);
  CHECK(a.result.absorbed_in_medium == b.result.absorbed_in_medium);
  CHECK(a.result.absorbed_at_surface == b.result.absorbed_at_surface);
  CHECK(a.result.segments == b.result.segments);
  CHECK(a.result.scatterings == b.result.scatterings);
  CHECK(a.result.resolved_misses == b.result.resolved_misses);
  CHECK(a.result.detected_path_histogram == b.result.detected_path_histogram);
  for (const auto moments : {&PointResult::interactions, &PointResult::detected_path_mm,
                             &PointResult::detected_time_ns, &PointResult::detected_interactions}) {
    CHECK((a.result.*moments).count == (b.result.*moments).count);
    CHECK(same_bits((a.result.*moments).sum, (b.result.*moments).sum));
    CHECK(same_bits((a.result.*moments).sum_of_squares, (b.result.*moments).sum_of_squares));
  }
  REQUIRE(a.list.size() == b.list.size());
  bool same = true;
  for (std::size_t i = 0; i < a.list.size(); ++i) same = same && same_bits(a.list[i], b.list[i]);
  CHECK(same);
}

/// The first block of a point's photons, or its first event. Only the ends of the photons are recorded, since
/// others are traced one by one at any width.
inline TracedPhotons first_block(const simulation::SimulationPoint& point, int lane_width) {
  scene_file::SceneSpec spec = point.spec();
  spec.tallies.clear();
  spec.run.photon_history = false;
  spec.run.photon_list = true;
  spec.run.threads = 1;
  spec.run.lane_width = lane_width;
  const simulation::SimulationPoint again(std::move(spec), point.built());
  TracedPhotons traced;
  simulation::RunHooks hooks;
  hooks.detected = [&](const std::vector<tally::DetectedPhoton>& photons) {
    traced.list.insert(traced.list.end(), photons.begin(), photons.end());
  };
  hooks.range = [&](const tally::BlockRange&, tally::PointSums sums) { traced.result = sums.result(); };
  again.trace({0, std::min<std::uint64_t>(again.source().blocks(), 1)}, hooks);
  return traced;
}

/// Checks that all widths of the lanes have the same photons, to the last bit.
inline void check_same_in_all_widths(const simulation::SimulationPoint& point) {
  const std::vector<int>& widths = core::lane_widths();
  if (widths.size() < 2) return;
  const TracedPhotons alone = first_block(point, 1);
  for (const int width : widths) {
    if (width == 1) continue;
    CAPTURE(width);
    check_same(alone, first_block(point, width));
  }
}

}  // namespace scintray::test
