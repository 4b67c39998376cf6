#include "pairing.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "child_program.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/version.hpp"
#include "server.hpp"

namespace scintray::bench {

namespace {

std::string ask(ChildProgram& program, const std::string& request) {
  program.write_line(request);
  const auto answer = program.read_line();
  if (!answer) throw core::SystemError("a benchmark program has ended before its answer");
  return *answer;
}

/// The two programs on one scene.
class Pair {
 public:
  Pair(const std::string& self, const std::string& other, std::string scene)
      : scene_(std::move(scene)), mine_({self, "--serve"}), other_({other, "--serve"}) {}

  /// For turns of one thread: processors of a shared machine differ for minutes, by what its other users do.
  void share_processor() {
    const int here = std::max(0, ::sched_getcpu());
    mine_.keep_on(here);
    other_.keep_on(here);
  }

  /// Work that takes this time; both programs have built the scene and are warm.
  std::uint64_t calibrate(double seconds) {
    const std::uint64_t work = work_of_answer(ask(mine_, calibration_request(scene_, seconds)));
    trace(other_, work, {});
    return work;
  }

  PairedFigures measure(std::uint64_t work, const Turn& turn, int rounds) {
    std::vector<Trace> mine, others;
    for (int round = 0; round < rounds; ++round) {
      const bool mine_first = round % 2 == 0;
      if (mine_first) mine.push_back(trace(mine_, work, turn));
      others.push_back(trace(other_, work, turn));
      if (!mine_first) mine.push_back(trace(mine_, work, turn));
    }
    return paired_figures(scene_, turn, mine, others);
  }

 private:
  Trace trace(ChildProgram& program, std::uint64_t work, const Turn& turn) {
    return trace_of_answer(ask(program, trace_request(scene_, work, turn)));
  }

  std::string scene_;
  ChildProgram mine_, other_;
};

}  // namespace

PairedFigures paired_figures(const std::string& scene, const Turn& turn, const std::vector<Trace>& mine,
                             const std::vector<Trace>& others) {
  PairedFigures figures;
  figures.scene = scene;
  figures.turn = turn;
  std::vector<double> my_s, other_s, speeds;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    my_s.push_back(turn.threads == 1 ? mine[i].cpu_s : mine[i].wall_s);
    other_s.push_back(turn.threads == 1 ? others[i].cpu_s : others[i].wall_s);
    speeds.push_back(static_cast<double>(mine[i].segments) / my_s.back());
    figures.same_photons = figures.same_photons && mine[i].segments == others[i].segments;
  }
  figures.ratio = paired_ratio(other_s, my_s);
  figures.segments_per_s = spread_of(speeds).median;
  return figures;
}

std::vector<PairedFigures> pair_programs(const std::string& self, const std::string& other,
                                         const std::vector<BenchScene>& scenes,
                                         const MeasureSettings& settings,
                                         const std::function<void(const PairedFigures&)>& done) {
  const std::vector<Turn> turns = turns_of(settings);
  std::vector<PairedFigures> pairs;
  const auto add = [&](const PairedFigures& figures) {
    pairs.push_back(figures);
    done(figures);
  };
  for (const BenchScene& scene : scenes) {
    try {
      Pair pair(self, other, scene.name);
      if (std::all_of(turns.begin(), turns.end(), [](const Turn& turn) { return turn.threads == 1; }))
        pair.share_processor();
      const double turn_s = settings.seconds / (2.0 * settings.rounds * static_cast<double>(turns.size()));
      const std::uint64_t work = pair.calibrate(turn_s);
      for (const Turn& turn : turns) add(pair.measure(work, turn, settings.rounds));
    } catch (const core::InputError& error) {
      PairedFigures figures;
      figures.scene = scene.name;
      figures.trouble = error.problems().front().what;
      add(figures);
    }
  }
  return pairs;
}

std::string pair_headings() {
  return fmt::format("{:<18}  {:>7}  {:>5}  {:>10}  {:>12}  {:>16}\n", "scene", "threads", "lanes", "Mseg/s",
                     "this / other", "quartiles");
}

std::string text_of_pair(const PairedFigures& pair) {
  if (!pair.trouble.empty()) return fmt::format("{:<18}  not compared: {}\n", pair.scene, pair.trouble);
  const std::string lanes = pair.turn.lane_width ? std::to_string(*pair.turn.lane_width) : "-";
  return fmt::format("{:<18}  {:>7}  {:>5}  {:>10.2f}  {:>12.3f}  {:>7.3f} to {:.3f}{}\n", pair.scene,
                     pair.turn.threads, lanes, pair.segments_per_s / 1e6, pair.ratio.median, pair.ratio.low,
                     pair.ratio.high, pair.same_photons ? "" : "  (photons differ)");
}

std::string json_of_pairs(const std::string& other, const std::vector<PairedFigures>& pairs) {
  using nlohmann::json;
  json list = json::array();
  for (const PairedFigures& pair : pairs) {
    if (!pair.trouble.empty()) {
      list.push_back({{"scene", pair.scene}, {"trouble", pair.trouble}});
      continue;
    }
    list.push_back({{"scene", pair.scene},
                    {"threads", pair.turn.threads},
                    {"segments_per_s", pair.segments_per_s},
                    {"same_photons", pair.same_photons},
                    {"ratio",
                     {{"median", pair.ratio.median},
                      {"low", pair.ratio.low},
                      {"high", pair.ratio.high},
                      {"values", pair.ratio.values}}}});
    if (pair.turn.lane_width) list.back()["lane_width"] = *pair.turn.lane_width;
  }
  const json node = {{"format", "scintray benchmark pairs"},
                     {"format_version", 1},
                     {"version", core::version()},
                     {"other", other},
                     {"pairs", list}};
  return node.dump(1) + "\n";
}

}  // namespace scintray::bench
