#pragma once
/// Results of the benchmark as plain data.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "profile.hpp"
#include "spread.hpp"

namespace scintray::bench {

/// Speed of a scene with one number of threads and one lane width.
struct RunFigures {
  int lane_width = 1;
  std::optional<int>
      asked_lane_width;  ///< by an option; lane_width is 1 in a scene that has nothing for lanes
  int threads = 1;
  /// Per second: of processor time for one thread, of elapsed time for more.
  Spread segments_per_s, photons_per_s;
  std::optional<Spread> events_per_s;  ///< of an event source
  /// Processor time over elapsed time x threads: below 1 the machine did other work, or threads had none.
  Spread processor_share;
  std::optional<Spread>
      speedup;  ///< over one thread in the same round, both by elapsed time; not of one thread
  std::optional<Spread> cpu_cost;  ///< processor time a segment over that of one thread in the same round
  /// Segments/s over those of the narrowest lane width asked for, in the same round, both on one thread.
  std::optional<Spread> lane_gain;
};

/// Comparison with another scene whose one-threaded runs took turns with this one's.
struct RelativeFigures {
  std::string to;         ///< name of the other scene
  Spread segments_per_s;  ///< this over the other
};

struct SceneFigures {
  std::string name, shows;
  std::size_t regions = 0;
  std::size_t triangles = 0;  ///< of all distinct accelerators
  double build_s = 0.0;       ///< reading and building, tables included
  double build_MB = 0.0;      ///< resident memory that it took
  std::uint64_t photons = 0;  ///< in each measurement
  std::uint64_t events = 0;   ///< in each measurement, of an event source
  std::uint64_t lost = 0;     ///< photons without a fate, in all measurements
  double segments_per_photon = 0.0;
  std::vector<RunFigures> runs;  ///< in the order of turns_of()
  std::size_t recorded_rays = 0;
  std::optional<Spread> raw_embree_rays_per_s;  ///< on the recorded rays, one thread, processor time
  std::optional<Spread> segments_per_raw_ray;   ///< segments/s of one thread over that, in the same round
  std::optional<RelativeFigures> relative;
  std::optional<WorkShares> work;  ///< nothing: not sampled, or not attributable
};

/// The machine and the program.
struct Machine {
  std::string cpu;
  unsigned cores = 0;  ///< that this program may use
  double load_average =
      0.0;  ///< over the last minute, at the start: above 0.2 or so the machine was not idle
  std::string system;
  std::string compiler, flags;
  std::string embree;
};

/// The machine that this program runs on.
Machine this_machine();

/// All that one run of the benchmark measured.
struct Report {
  std::string version;  ///< ScintRay's
  std::string date;     ///< of the start, UTC, "2026-01-31T12:00:00Z"
  std::string note;     ///< by an option: what a reader of the figures should know
  Machine machine;
  double seconds = 0.0;  ///< timed tracing per scene, as requested
  int rounds = 0;        ///< at most
  std::vector<SceneFigures> scenes;
};

}  // namespace scintray::bench
