#pragma once
/// Measurement of one scene.

#include <optional>
#include <vector>

#include "figures.hpp"
#include "workload.hpp"

namespace scintray::bench {

struct MeasureSettings {
  double seconds = 2.0;         ///< timed tracing per scene, about
  int rounds = 9;               ///< at most; at least 3 are made
  std::vector<int> threads{2};  ///< beside one thread
  /// Of core::lane_widths(), each once: all are measured on one thread, the first also on more. Empty:
  /// the default alone.
  std::vector<int> lane_widths;
  bool profile = true;  ///< sample the kinds of work, in a run of their own
};

/// What one measurement traces with.
struct Turn {
  int threads = 1;
  std::optional<int> lane_width;  ///< nothing: the default
};

/// The first lane width on one thread and on the other numbers of threads, then the other widths on one.
std::vector<Turn> turns_of(const MeasureSettings& settings);

/// Work of one measurement.
struct Piece {
  std::uint64_t work = 0;  ///< photons or events, whole blocks
  double cpu_s = 0.0;      ///< on one thread, about
};

/// The work that takes about this time on one thread, but never less than eight blocks, found by tracing;
/// which warms caches up as well.
Piece calibrate(const Workload& workload, double seconds);

/// Speed of a scene, and its share of Embree's. In every round each number of threads and each lane width has
/// its turn, then Embree, then the scene for comparison, in an order that alternates, so that a change of the
/// machine's speed changes all; ratios are made within rounds.
/// @param reference  workload of the scene for comparison; null: none
/// @param samples    receives samples of the program counter; `work` of the result is left to the caller
SceneFigures measure(const BenchScene& scene, const Workload& workload, const Workload* reference,
                     const MeasureSettings& settings, std::vector<std::uintptr_t>& samples);

}  // namespace scintray::bench
