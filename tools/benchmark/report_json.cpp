#include "report_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"

namespace scintray::bench {

using nlohmann::json;

namespace {

constexpr const char* kFormat = "scintray benchmark";
constexpr int kFormatVersion = 1;

}  // namespace

// Found by argument-dependent look-up, so they are not in the unnamed namespace.

static void to_json(json& node, const Spread& spread) {
  node = {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}, {"values", spread.values}};
}

static void from_json(const json& node, Spread& spread) {
  node.at("median").get_to(spread.median);
  node.at("low").get_to(spread.low);
  node.at("high").get_to(spread.high);
  node.at("values").get_to(spread.values);
}

namespace {

/// Writes an optional value under a key, nothing without a value.
template <typename T>
void put(json& node, const char* key, const std::optional<T>& value) {
  if (value) node[key] = *value;
}

template <typename T>
void get(const json& node, const char* key, std::optional<T>& value) {
  if (node.contains(key)) value = node.at(key).get<T>();
}

}  // namespace

static void to_json(json& node, const WorkShares& work) {
  json shares = json::object();
  for (const auto& kind : kWorkKinds) shares[kind.word] = work.shares[static_cast<std::size_t>(kind.value)];
  node = {{"samples", work.samples}, {"by", work.lines ? "line" : "function"}, {"shares", shares}};
}

static void from_json(const json& node, WorkShares& work) {
  node.at("samples").get_to(work.samples);
  work.lines = node.at("by") == "line";
  for (const auto& kind : kWorkKinds)
    work.shares[static_cast<std::size_t>(kind.value)] = node.at("shares").value(kind.word, 0.0);
}

static void to_json(json& node, const RelativeFigures& relative) {
  node = {{"to", relative.to}, {"segments_per_s", relative.segments_per_s}};
}

static void from_json(const json& node, RelativeFigures& relative) {
  node.at("to").get_to(relative.to);
  node.at("segments_per_s").get_to(relative.segments_per_s);
}

static void to_json(json& node, const RunFigures& run) {
  node = {{"lane_width", run.lane_width},
          {"threads", run.threads},
          {"segments_per_s", run.segments_per_s},
          {"photons_per_s", run.photons_per_s},
          {"processor_share", run.processor_share}};
  put(node, "events_per_s", run.events_per_s);
  put(node, "speedup", run.speedup);
  put(node, "cpu_cost", run.cpu_cost);
  put(node, "asked_lane_width", run.asked_lane_width);
  put(node, "lane_gain", run.lane_gain);
}

static void from_json(const json& node, RunFigures& run) {
  node.at("lane_width").get_to(run.lane_width);
  node.at("threads").get_to(run.threads);
  node.at("segments_per_s").get_to(run.segments_per_s);
  node.at("photons_per_s").get_to(run.photons_per_s);
  node.at("processor_share").get_to(run.processor_share);
  get(node, "events_per_s", run.events_per_s);
  get(node, "speedup", run.speedup);
  get(node, "cpu_cost", run.cpu_cost);
  get(node, "asked_lane_width", run.asked_lane_width);
  get(node, "lane_gain", run.lane_gain);
}

static void to_json(json& node, const SceneFigures& scene) {
  node = {{"name", scene.name},
          {"shows", scene.shows},
          {"regions", scene.regions},
          {"triangles", scene.triangles},
          {"build_s", scene.build_s},
          {"build_MB", scene.build_MB},
          {"photons", scene.photons},
          {"events", scene.events},
          {"lost", scene.lost},
          {"segments_per_photon", scene.segments_per_photon},
          {"recorded_rays", scene.recorded_rays},
          {"runs", scene.runs}};
  put(node, "raw_embree_rays_per_s", scene.raw_embree_rays_per_s);
  put(node, "segments_per_raw_ray", scene.segments_per_raw_ray);
  put(node, "relative", scene.relative);
  put(node, "work", scene.work);
}

static void from_json(const json& node, SceneFigures& scene) {
  node.at("name").get_to(scene.name);
  node.at("shows").get_to(scene.shows);
  node.at("regions").get_to(scene.regions);
  node.at("triangles").get_to(scene.triangles);
  node.at("build_s").get_to(scene.build_s);
  node.at("build_MB").get_to(scene.build_MB);
  node.at("photons").get_to(scene.photons);
  node.at("events").get_to(scene.events);
  node.at("lost").get_to(scene.lost);
  node.at("segments_per_photon").get_to(scene.segments_per_photon);
  node.at("recorded_rays").get_to(scene.recorded_rays);
  node.at("runs").get_to(scene.runs);
  get(node, "raw_embree_rays_per_s", scene.raw_embree_rays_per_s);
  get(node, "segments_per_raw_ray", scene.segments_per_raw_ray);
  get(node, "relative", scene.relative);
  get(node, "work", scene.work);
}

static void to_json(json& node, const Machine& machine) {
  node = {{"cpu", machine.cpu},       {"cores", machine.cores},       {"load_average", machine.load_average},
          {"system", machine.system}, {"compiler", machine.compiler}, {"flags", machine.flags},
          {"embree", machine.embree}};
}

static void from_json(const json& node, Machine& machine) {
  node.at("cpu").get_to(machine.cpu);
  node.at("cores").get_to(machine.cores);
  node.at("load_average").get_to(machine.load_average);
  node.at("system").get_to(machine.system);
  node.at("compiler").get_to(machine.compiler);
  node.at("flags").get_to(machine.flags);
  node.at("embree").get_to(machine.embree);
}

std::string json_of(const Report& report) {
  json node = {{"format", kFormat},       {"format_version", kFormatVersion}, {"version", report.version},
               {"date", report.date},     {"machine", report.machine},        {"seconds", report.seconds},
               {"rounds", report.rounds}, {"scenes", json::array()}};
  if (!report.note.empty()) node["note"] = report.note;
  // One line a scene: some hundred numbers each. No text of the report can hold this with its quotes.
  const std::string empty = "\"scenes\": []";
  std::string text = node.dump(1), lines;
  for (const SceneFigures& scene : report.scenes)
    lines += (lines.empty() ? "\n  " : ",\n  ") + json(scene).dump();
  text.replace(text.find(empty), empty.size(), "\"scenes\": [" + lines + "\n ]");
  return text + "\n";
}

Report report_of_json(const std::string& text, const std::string& name) {
  const auto refuse = [&](const std::string& what) {
    return core::InputError({{name}, what, "give a file that tools/bench --json has written"});
  };
  try {
    const json node = json::parse(text);
    if (node.value("format", "") != kFormat) throw refuse("this is no report of the benchmark");
    if (const int version = node.at("format_version"); version != kFormatVersion)
      throw refuse(fmt::format("a report of format {}; this program reads {}", version, kFormatVersion));
    Report report;
    node.at("version").get_to(report.version);
    node.at("date").get_to(report.date);
    report.note = node.value("note", "");
    node.at("machine").get_to(report.machine);
    node.at("seconds").get_to(report.seconds);
    node.at("rounds").get_to(report.rounds);
    node.at("scenes").get_to(report.scenes);
    return report;
  } catch (const json::exception& error) {
    throw refuse(std::string("this is no report of the benchmark: ") + error.what());
  }
}

Report load_report(const std::filesystem::path& path) {
  const auto text = core::read_whole_file(path);
  if (!text)
    throw core::InputError(
        {{path.string()}, "this file cannot be read", "give a file that tools/bench --json has written"});
  return report_of_json(*text, path.string());
}

}  // namespace scintray::bench
