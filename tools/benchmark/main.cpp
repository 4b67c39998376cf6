/// tools/bench: speed of the tracer on a fixed set of scenes. docs/performance.md describes what is measured.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include "measure.hpp"
#include "pairing.hpp"
#include "ray_comparison.hpp"
#include "report_json.hpp"
#include "report_text.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/lane_width.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/version.hpp"
#include "server.hpp"

namespace {

using namespace scintray;
using namespace scintray::bench;

struct Options {
  std::vector<std::string> scenes;
  std::filesystem::path json, baseline, against;
  std::vector<std::string> lane_widths;
  std::string note;
  MeasureSettings measure;
  bool list = false, quick = false, no_profile = false, rays = false, serve = false;
};

constexpr const char* kAll = "all";

std::vector<std::string> lane_width_words() {
  std::vector<std::string> words{kAll};
  for (const int width : core::lane_widths()) words.push_back(std::to_string(width));
  return words;
}

/// The widths that are asked for, each once; of all the default first.
std::vector<int> lane_widths_of(const std::vector<std::string>& words) {
  std::vector<int> asked;
  const bool all = std::find(words.begin(), words.end(), kAll) != words.end();
  if (all) {
    asked = core::lane_widths();
    asked.insert(asked.begin(), core::default_lane_width());
  } else {
    for (const std::string& word : words) asked.push_back(std::stoi(word));
  }
  std::vector<int> widths;
  for (const int width : asked)
    if (std::find(widths.begin(), widths.end(), width) == widths.end()) widths.push_back(width);
  return widths;
}

void add_options(CLI::App& app, Options& options) {
  MeasureSettings& measure = options.measure;
  app.add_flag("--list", options.list, "print the scenes, measure nothing");
  app.add_option("--scene", options.scenes, "measure this scene; * stands for any characters; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app.add_option("--threads", measure.threads, "numbers of threads beside one, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option(
         "--lane-width", options.lane_widths,
         "photons propagated at once, where a scene allows it, separated by commas, or all; by default 8 on "
         "processors that keep their clock with it, else the widest up to 4")
      ->delimiter(',')
      ->check(CLI::IsMember(lane_width_words()));
  app.add_option("--seconds", measure.seconds, "timed tracing per scene, about")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  app.add_option("--rounds", measure.rounds, "measurements of each figure, at most")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_flag("--quick", options.quick, "three rounds in half a second per scene, no shares of time");
  app.add_flag("--no-profile", options.no_profile, "no shares of time by kind of work");
  app.add_option("--json", options.json, "write all figures to this file")->type_name("FILE");
  app.add_option("--note", options.note, "a sentence for the report, and for the file of --json")
      ->type_name("TEXT");
  CLI::Option* baseline =
      app.add_option("--baseline", options.baseline, "print ratios to the figures of such a file")
          ->type_name("FILE");
  app.add_option("--against", options.against,
                 "trace the same photons with another scintray_bench in turns, and print ratios only")
      ->type_name("BINARY")
      ->excludes(baseline);
  CLI::Option* rays =
      app.add_flag("--rays", options.rays, "compare ways to find where rays leave regions, and nothing else");
  for (const char* other : {"--list", "--scene", "--threads", "--lane-width", "--no-profile", "--json",
                            "--baseline", "--against"})
    rays->excludes(app.get_option(other));
  app.add_flag("--serve", options.serve, "answer requests on standard input, for --against")->group("");
}

void list_scenes(const std::vector<BenchScene>& scenes) {
  for (const BenchScene& scene : scenes)
    std::cout << fmt::format("{:<18}  {}{}\n", scene.name, scene.shows,
                             scene.relative_to.empty() ? "" : ", compared with " + scene.relative_to);
}

/// Workloads of scenes that others are compared with, each built once and kept.
class References {
 public:
  /// @param lane_width  nothing: the default
  explicit References(std::optional<int> lane_width) : lane_width_(lane_width) {}
  const Workload* of(const BenchScene& scene) {
    if (scene.relative_to.empty()) return nullptr;
    auto& mine = built_[scene.relative_to];
    if (!mine) mine = std::make_unique<Workload>(scene_named(scene.relative_to), lane_width_);
    return mine.get();
  }

 private:
  std::optional<int> lane_width_;
  std::map<std::string, std::unique_ptr<const Workload>> built_;
};

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

/// Attributes the samples of all scenes; addr2line reads the program once.
void attribute_all(Report& report, const std::vector<std::vector<std::uintptr_t>>& samples) {
  std::vector<std::uintptr_t> all;
  for (const auto& of_scene : samples) all.insert(all.end(), of_scene.begin(), of_scene.end());
  if (all.empty()) return;
  const auto places = find_code(all);
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (!samples[i].empty()) report.scenes[i].work = attribute(samples[i], places);
}

/// A report of this program on this machine, without scenes.
Report empty_report(const MeasureSettings& settings, const std::string& note) {
  Report report;
  report.version = core::version();
  report.date = now_utc();
  report.machine = this_machine();
  report.seconds = settings.seconds;
  report.rounds = settings.rounds;
  report.note = note;
  return report;
}

void measure_all(const std::vector<BenchScene>& scenes, const MeasureSettings& settings, Report& report) {
  const std::optional<int> lane_width = turns_of(settings).front().lane_width;
  References references(lane_width);
  std::vector<std::vector<std::uintptr_t>> samples(scenes.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    std::cerr << fmt::format("[{}/{}] {}\n", i + 1, scenes.size(), scenes[i].name);
    const Workload workload(scenes[i], lane_width);
    report.scenes.push_back(measure(scenes[i], workload, references.of(scenes[i]), settings, samples[i]));
  }
  attribute_all(report, samples);
}

void print(const Report& report, const Options& options) {
  std::cout << text_of_machine(report) << '\n';
  if (options.baseline.empty()) {
    std::cout << text_of_figures(report, nullptr);
    return;
  }
  const Report baseline = load_report(options.baseline);
  std::cout << text_of_differences(report, baseline)
            << fmt::format("(x ratio to {}, {}, {})\n\n", options.baseline.string(), baseline.version,
                           baseline.date)
            << text_of_figures(report, &baseline);
}

void compare_programs(const std::vector<BenchScene>& scenes, const Options& options) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  std::cout << pair_headings();
  const auto done = [](const PairedFigures& pair) { std::cout << text_of_pair(pair) << std::flush; };
  const auto pairs = pair_programs(self, options.against, scenes, options.measure, done);
  if (!options.json.empty()) core::write_whole_file(options.json, json_of_pairs(options.against, pairs));
}

void compare_all_rays(const MeasureSettings& settings, const std::string& note) {
  const Report report = empty_report(settings, note);
  std::vector<RayRegionFigures> figures;
  for (const RayRegion& region : ray_regions()) {
    std::cerr << region.name << '\n';
    figures.push_back(compare_rays(region, settings.seconds, settings.rounds));
  }
  std::cout << text_of_machine(report) << '\n' << text_of_rays(figures);
}

void run(const Options& options) {
  if (options.serve) return serve(std::cin, std::cout);
  if (options.rays) return compare_all_rays(options.measure, options.note);
  const std::vector<BenchScene> scenes = select_scenes(options.scenes);
  if (options.list) return list_scenes(scenes);
  if (!options.against.empty()) return compare_programs(scenes, options);
  if (!options.baseline.empty()) load_report(options.baseline);  // its errors come before the measurement
  Report report = empty_report(options.measure, options.note);
  measure_all(scenes, options.measure, report);
  print(report, options);
  if (!options.json.empty()) core::write_whole_file(options.json, json_of(report));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Speed of ScintRay on a fixed set of scenes (docs/performance.md)", "tools/bench");
  Options options;
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  if (options.quick) {
    options.measure.seconds = 0.5;
    options.measure.rounds = 3;
  }
  options.measure.lane_widths = lane_widths_of(options.lane_widths);
  options.measure.profile = !options.quick && !options.no_profile;
  try {
    run(options);
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems()) std::cerr << problem.text() << '\n';
    return EXIT_FAILURE;
  } catch (const core::SystemError& error) {
    std::cerr << "error: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
