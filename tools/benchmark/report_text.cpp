#include "report_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

namespace scintray::bench {

namespace {

/// A figure of a scene, and how it is printed.
struct Column {
  std::string heading;
  double unit = 1.0;  ///< by which the figure is divided
  std::function<std::optional<Spread>(const SceneFigures&)> of;
};

/// The first run of a scene with this number of threads and, if given, of this lane width.
const RunFigures* run_of(const SceneFigures& scene, int threads, std::optional<int> lane_width = {}) {
  for (const RunFigures& run : scene.runs)
    if (run.threads == threads && (!lane_width || run.asked_lane_width == lane_width)) return &run;
  return nullptr;
}

/// A figure of the run with this number of threads.
template <typename Member>
auto of_run(int threads, Member member) {
  return [threads, member](const SceneFigures& scene) -> std::optional<Spread> {
    const RunFigures* run = run_of(scene, threads);
    return run ? std::optional<Spread>(run->*member) : std::nullopt;
  };
}

auto of_optional(int threads, std::optional<Spread> RunFigures::*member) {
  return [threads, member](const SceneFigures& scene) -> std::optional<Spread> {
    const RunFigures* run = run_of(scene, threads);
    return run ? run->*member : std::nullopt;
  };
}

/// Speed by lane width, where several were asked for.
std::vector<Column> lane_columns_of(const Report& report) {
  std::set<int> widths;
  for (const SceneFigures& scene : report.scenes)
    for (const RunFigures& run : scene.runs)
      if (run.asked_lane_width) widths.insert(*run.asked_lane_width);
  std::vector<Column> columns;
  if (widths.size() < 2) return columns;
  for (const int width : widths) {
    columns.push_back({fmt::format("{} l: Mseg/s", width), 1e6, [width](const SceneFigures& scene) {
                         const RunFigures* run = run_of(scene, 1, width);
                         return run ? std::optional(run->segments_per_s) : std::nullopt;
                       }});
    columns.push_back(
        {fmt::format("{} l / {} l", width, *widths.begin()), 1.0, [width](const SceneFigures& scene) {
           const RunFigures* run = run_of(scene, 1, width);
           return run ? run->lane_gain : std::nullopt;
         }});
  }
  return columns;
}

std::vector<Column> columns_of(const Report& report) {
  std::vector<Column> columns{
      {"Mseg/s", 1e6, of_run(1, &RunFigures::segments_per_s)},
      {"kphoton/s", 1e3, of_run(1, &RunFigures::photons_per_s)},
      {"event/s", 1.0, of_optional(1, &RunFigures::events_per_s)},
      {"Embree Mray/s", 1e6, [](const SceneFigures& s) { return s.raw_embree_rays_per_s; }},
      {"seg/raw ray", 1.0, [](const SceneFigures& s) { return s.segments_per_raw_ray; }}};
  std::vector<int> numbers;
  for (const SceneFigures& scene : report.scenes)
    for (const RunFigures& run : scene.runs)
      if (run.threads != 1 && std::find(numbers.begin(), numbers.end(), run.threads) == numbers.end())
        numbers.push_back(run.threads);
  for (const int threads : numbers) {
    columns.push_back(
        {fmt::format("{} t: Mseg/s", threads), 1e6, of_run(threads, &RunFigures::segments_per_s)});
    columns.push_back({fmt::format("{} t / 1 t", threads), 1.0, of_optional(threads, &RunFigures::speedup)});
    columns.push_back(
        {fmt::format("{} t: CPU/seg", threads), 1.0, of_optional(threads, &RunFigures::cpu_cost)});
  }
  for (Column& column : lane_columns_of(report)) columns.push_back(std::move(column));
  columns.push_back({"to one crystal", 1.0, [](const SceneFigures& s) {
                       return s.relative ? std::optional(s.relative->segments_per_s) : std::nullopt;
                     }});
  return columns;
}

const SceneFigures* scene_of(const Report* report, const std::string& name) {
  if (!report) return nullptr;
  for (const SceneFigures& scene : report->scenes)
    if (scene.name == name) return &scene;
  return nullptr;
}

/// Three significant digits, "12.3 2%" with half the distance between the quartiles.
std::string text_of_figure(const Spread& figure, double unit) {
  const double value = figure.median / unit;
  const int decimals = value >= 100.0 ? 0 : value >= 10.0 ? 1 : 2;
  return fmt::format("{:.{}f} {:.0f}%", value, decimals, 100.0 * figure.relative());
}

std::string cell(const Column& column, const SceneFigures& scene, const SceneFigures* before) {
  const std::optional<Spread> figure = column.of(scene);
  if (!figure) return "-";
  std::string text = text_of_figure(*figure, column.unit);
  if (before)
    if (const auto ratio = ratio_to_baseline(figure, column.of(*before)))
      text += fmt::format(" (x {:.2f})", *ratio);
  return text;
}

using Row = std::vector<std::string>;

/// Rows with aligned columns, the first to the left, the others to the right. A column that is "-" everywhere
/// is left out.
std::string table(const Row& headings, const std::vector<Row>& rows) {
  std::string text;
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < headings.size(); ++i) {
    std::size_t width = headings[i].size();
    bool empty = true;
    for (const Row& row : rows) {
      width = std::max(width, row[i].size());
      empty = empty && row[i] == "-";
    }
    widths.push_back(empty ? 0 : width);
  }
  const auto add = [&](const Row& row) {
    text += fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t i = 1; i < row.size(); ++i)
      if (widths[i] > 0) text += fmt::format("  {:>{}}", row[i], widths[i]);
    text += '\n';
  };
  add(headings);
  for (const Row& row : rows) add(row);
  return text;
}

std::string text_of_speeds(const Report& report, const Report* baseline) {
  const std::vector<Column> columns = columns_of(report);
  Row headings{"scene"};
  for (const Column& column : columns) headings.push_back(column.heading);
  std::vector<Row> rows;
  for (const SceneFigures& scene : report.scenes) {
    const SceneFigures* before = scene_of(baseline, scene.name);
    Row row{scene.name};
    for (const Column& column : columns) row.push_back(cell(column, scene, before));
    rows.push_back(std::move(row));
  }
  return table(headings, rows);
}

std::string text_of_work(const Report& report) {
  Row headings{"share of time, %"};
  for (const auto& kind : kWorkKinds) headings.emplace_back(kind.word);
  headings.emplace_back("samples");
  std::vector<Row> rows;
  bool functions = false;
  for (const SceneFigures& scene : report.scenes) {
    if (!scene.work) continue;
    functions = functions || !scene.work->lines;
    Row row{scene.name};
    for (const auto& kind : kWorkKinds)
      row.push_back(fmt::format("{:.0f}", 100.0 * scene.work->shares[static_cast<std::size_t>(kind.value)]));
    row.push_back(fmt::format("{}", scene.work->samples));
    rows.push_back(std::move(row));
  }
  if (rows.empty()) return {};
  std::string text = "\n" + table(headings, rows);
  if (functions)
    text +=
        "This program has no line tables: the work of an inlined function counts as that of the function "
        "around it.\n";
  return text;
}

std::string text_of_building(const Report& report) {
  std::vector<Row> rows;
  for (const SceneFigures& scene : report.scenes) {
    if (scene.runs.empty()) continue;
    const RunFigures& widest =
        *std::max_element(scene.runs.begin(), scene.runs.end(),
                          [](const RunFigures& a, const RunFigures& b) { return a.threads < b.threads; });
    rows.push_back({scene.name, fmt::format("{}", scene.regions), fmt::format("{}", scene.triangles),
                    fmt::format("{:.2f}", scene.build_s), fmt::format("{:.0f}", scene.build_MB),
                    fmt::format("{:.1f}", scene.segments_per_photon), fmt::format("{}", scene.photons),
                    fmt::format("{}", widest.segments_per_s.values.size()),
                    fmt::format("{:.0f}", 100.0 * widest.processor_share.median)});
  }
  return "\n" +
         table({"scene", "regions", "triangles", "build s", "MB", "seg/photon", "photons", "rounds", "CPU %"},
               rows);
}

}  // namespace

std::optional<double> ratio_to_baseline(const std::optional<Spread>& now,
                                        const std::optional<Spread>& before) {
  if (!now || !before || now->median == 0.0 || before->median == 0.0) return std::nullopt;
  return now->median / before->median;
}

std::string text_of_machine(const Report& report) {
  const Machine& machine = report.machine;
  return fmt::format(
      "ScintRay {}, {}\n{}, {} cores, load average {:.2f}, {}\n{}, {}; Embree {}\n"
      "{:g} s of timed tracing per scene in up to {} rounds; medians, and half the distance between the "
      "quartiles\n{}",
      report.version, report.date, machine.cpu, machine.cores, machine.load_average, machine.system,
      machine.compiler, machine.flags, machine.embree, report.seconds, report.rounds,
      report.note.empty() ? "" : report.note + "\n");
}

std::string text_of_figures(const Report& report, const Report* baseline) {
  return text_of_speeds(report, baseline) + text_of_work(report) + text_of_building(report);
}

std::string text_of_differences(const Report& report, const Report& baseline) {
  std::string text;
  const auto compare = [&](const char* what, const std::string& now, const std::string& before) {
    if (now != before) text += fmt::format("{}: {}; of the baseline: {}\n", what, now, before);
  };
  compare("processor", report.machine.cpu, baseline.machine.cpu);
  compare("cores", std::to_string(report.machine.cores), std::to_string(baseline.machine.cores));
  compare("compiler", report.machine.compiler, baseline.machine.compiler);
  compare("flags", report.machine.flags, baseline.machine.flags);
  compare("Embree", report.machine.embree, baseline.machine.embree);
  if (!text.empty())
    text = "The baseline was measured elsewhere, so ratios show the difference of the machines as well.\n" +
           text;
  return text;
}

}  // namespace scintray::bench
