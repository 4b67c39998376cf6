#include "measure.hpp"

#include <algorithm>
#include <cmath>

#include "raw_embree.hpp"

namespace scintray::bench {

namespace {

/// Blocks in the smallest measurement, so that two threads end at about the same time.
constexpr std::uint64_t kFewestBlocks = 8;
constexpr int kFewestRounds = 3;
constexpr std::size_t kMostRays = 200'000;

/// Shares of the time of a scene.
constexpr double kEmbreeShare = 0.1, kProfileShare = 0.5;

double per_cpu_second(std::uint64_t count, const Trace& trace) {
  return static_cast<double>(count) / trace.cpu_s;
}

double per_wall_second(std::uint64_t count, const Trace& trace) {
  return static_cast<double>(count) / trace.wall_s;
}

/// Values of a quantity of traces, in their order.
template <typename Quantity>
std::vector<double> values_of(const std::vector<Trace>& traces, Quantity quantity) {
  std::vector<double> values;
  for (const Trace& trace : traces) values.push_back(quantity(trace));
  return values;
}

/// Rate of a count, by the clock of the number of threads.
Spread rate(const std::vector<Trace>& traces, int threads, std::uint64_t Trace::*count) {
  return spread_of(values_of(traces, [&](const Trace& trace) {
    return threads == 1 ? per_cpu_second(trace.*count, trace) : per_wall_second(trace.*count, trace);
  }));
}

/// The traces of the rounds with each number of threads and each lane width, and what was measured beside
/// them.
class Rounds {
 public:
  Rounds(const Workload& workload, const Workload* reference, const MeasureSettings& settings)
      : workload_(workload),
        reference_(reference),
        raw_(workload.point().scene(), record_rays(workload.point(), kMostRays)) {
    turns_ = turns_of(settings);
    traces_.resize(turns_.size());
    const double turns = static_cast<double>(turns_.size()) + (reference ? 1.0 : 0.0) + kEmbreeShare;
    const double turn_s = settings.seconds / (settings.rounds * turns);
    raw_s_ = kEmbreeShare * turn_s;
    piece_ = calibrate(workload, turn_s);
    if (reference) reference_work_ = calibrate(*reference, turn_s).work;
    const double possible = settings.seconds / (turns * piece_.cpu_s);
    rounds_ = std::clamp(static_cast<int>(std::lround(possible)), std::min(kFewestRounds, settings.rounds),
                         settings.rounds);
    raw_.rays_per_second(0.0);  // warms up
  }

  void run() {
    for (int round = 0; round < rounds_; ++round) {
      const bool forwards = round % 2 == 0;
      if (forwards) trace_each();
      if (reference_) reference_traces_.push_back(reference_->trace(reference_work_, 1));
      if (raw_.rays() > 0) raw_speeds_.push_back(raw_.rays_per_second(raw_s_));
      if (!forwards) trace_each();
    }
  }

  const Piece& piece() const { return piece_; }

  void add_to(SceneFigures& figures) const {
    for (std::size_t i = 0; i < turns_.size(); ++i) figures.runs.push_back(figures_of(i));
    const std::vector<Trace>& one = traces_.front();
    figures.photons = one.front().photons;
    figures.events = one.front().events;
    figures.segments_per_photon =
        static_cast<double>(one.front().segments) / static_cast<double>(one.front().photons);
    for (const std::vector<Trace>& traces : traces_)
      for (const Trace& trace : traces) figures.lost += trace.lost;
    const std::vector<double> speeds = segment_speeds(one);
    figures.recorded_rays = raw_.rays();
    if (!raw_speeds_.empty()) {
      figures.raw_embree_rays_per_s = spread_of(raw_speeds_);
      figures.segments_per_raw_ray = paired_ratio(speeds, raw_speeds_);
    }
    if (reference_)
      figures.relative = RelativeFigures{{}, paired_ratio(speeds, segment_speeds(reference_traces_))};
  }

 private:
  void trace_each() {
    for (std::size_t i = 0; i < turns_.size(); ++i)
      traces_[i].push_back(workload_.trace(piece_.work, turns_[i].threads, turns_[i].lane_width));
  }

  static std::vector<double> segment_speeds(const std::vector<Trace>& traces) {
    return values_of(traces, [](const Trace& trace) { return per_cpu_second(trace.segments, trace); });
  }

  /// The turn on one thread with the narrowest lanes.
  std::size_t narrowest_turn() const {
    std::size_t narrowest = 0;
    for (std::size_t i = 1; i < turns_.size(); ++i)
      if (turns_[i].threads == 1 && turns_[i].lane_width < turns_[narrowest].lane_width) narrowest = i;
    return narrowest;
  }

  RunFigures figures_of(std::size_t number) const {
    const std::vector<Trace>&traces = traces_[number], &one = traces_.front();
    const int threads = turns_[number].threads;
    RunFigures figures;
    figures.lane_width = traces.front().lane_width;
    figures.asked_lane_width = turns_[number].lane_width;
    figures.threads = threads;
    figures.segments_per_s = rate(traces, threads, &Trace::segments);
    figures.photons_per_s = rate(traces, threads, &Trace::photons);
    if (workload_.has_events()) figures.events_per_s = rate(traces, threads, &Trace::events);
    figures.processor_share = spread_of(
        values_of(traces, [&](const Trace& trace) { return trace.cpu_s / (trace.wall_s * threads); }));
    if (threads == 1) {
      const std::size_t narrowest = narrowest_turn();
      if (number != narrowest)
        figures.lane_gain = paired_ratio(segment_speeds(traces), segment_speeds(traces_[narrowest]));
      return figures;
    }
    const auto wall = [](const Trace& trace) { return trace.wall_s; };
    const auto cpu = [](const Trace& trace) { return trace.cpu_s; };
    figures.speedup = paired_ratio(values_of(one, wall), values_of(traces, wall));
    figures.cpu_cost = paired_ratio(values_of(traces, cpu), values_of(one, cpu));
    return figures;
  }

  const Workload& workload_;
  const Workload* reference_;
  RawEmbree raw_;
  std::vector<Turn> turns_;
  double raw_s_ = 0.0;
  Piece piece_;
  std::uint64_t reference_work_ = 0;
  int rounds_ = 0;
  std::vector<std::vector<Trace>> traces_;  ///< by turn, then by round
  std::vector<Trace> reference_traces_;
  std::vector<double> raw_speeds_;
};

}  // namespace

std::vector<Turn> turns_of(const MeasureSettings& settings) {
  const std::vector<int>& widths = settings.lane_widths;
  const std::optional<int> first = widths.empty() ? std::nullopt : std::optional(widths.front());
  std::vector<Turn> turns{{1, first}};
  for (const int threads : settings.threads)
    if (threads != 1) turns.push_back({threads, first});
  for (std::size_t i = 1; i < widths.size(); ++i) turns.push_back({1, widths[i]});
  return turns;
}

Piece calibrate(const Workload& workload, double seconds) {
  const std::uint64_t block = workload.block(), fewest = kFewestBlocks * block;
  Piece piece{fewest, workload.trace(fewest, 1).cpu_s};
  // Twice, since the first trace is slow while caches are cold.
  for (int turn = 0; turn < 2; ++turn) {
    const double wanted = static_cast<double>(piece.work) * seconds / piece.cpu_s;
    const auto blocks = static_cast<std::uint64_t>(std::ceil(wanted / static_cast<double>(block)));
    piece.work = std::max(fewest, blocks * block);
    piece.cpu_s = workload.trace(piece.work, 1).cpu_s;
  }
  return piece;
}

SceneFigures measure(const BenchScene& scene, const Workload& workload, const Workload* reference,
                     const MeasureSettings& settings, std::vector<std::uintptr_t>& samples) {
  SceneFigures figures;
  figures.name = scene.name;
  figures.shows = scene.shows;
  figures.regions = workload.regions();
  figures.triangles = workload.triangles();
  figures.build_s = workload.build_cost().seconds;
  figures.build_MB = workload.build_cost().megabytes;
  Rounds rounds(workload, reference, settings);
  rounds.run();
  rounds.add_to(figures);
  if (figures.relative) figures.relative->to = scene.relative_to;
  if (settings.profile) {
    const Piece& piece = rounds.piece();
    const double repeats = kProfileShare * settings.seconds / piece.cpu_s;
    const auto work = static_cast<std::uint64_t>(std::max(1.0, repeats) * static_cast<double>(piece.work));
    samples = sample_program_counter([&] { workload.trace(work, 1); });
  }
  return figures;
}

}  // namespace scintray::bench
