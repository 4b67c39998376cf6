#include "server.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "core_clock.hpp"
#include "figures.hpp"
#include "measure.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/lane_width.hpp"
#include "work_kind.hpp"

namespace scintray::bench {

using nlohmann::json;

namespace {

/// The word of the kind of work of each place: [library, file, function], the library empty for the program.
json kinds_of(const json& places) {
  json words = json::array();
  for (const json& place : places) {
    const std::string library = place.at(0), file = place.at(1), function = place.at(2);
    // What is inlined has the file of its own, and the function that it is in.
    const WorkKind kind =
        library.empty() ? kind_of_code({{"", file}, {function, ""}}) : kind_of_library(library);
    words.push_back(core::word_of(kWorkKinds, kind));
  }
  return {{"kinds", words}};
}

json machine() {
  return {{"cpu", this_machine().cpu},
          {"cycles_per_ns", core_clock_per_ns()},
          {"lane_widths", core::lane_widths()}};
}

int lane_width_of(const json& request) {
  const int width = request;
  const std::vector<int>& widths = core::lane_widths();
  if (std::find(widths.begin(), widths.end(), width) == widths.end())
    throw core::InputError({{}, "this processor has no lanes of width " + std::to_string(width), ""});
  return width;
}

/// The last scene requested, built.
class Server {
 public:
  json answer(const json& request) {
    if (request.contains("kinds_of")) return kinds_of(request.at("kinds_of"));
    if (request.contains("machine")) return machine();
    build(request);
    if (request.contains("seconds")) return {{"work", calibrate(*workload_, request.at("seconds")).work}};
    const Trace trace = workload_->trace(request.at("work"), request.at("threads"));
    return {{"segments", trace.segments},
            {"photons", trace.photons},
            {"events", trace.events},
            {"wall_s", trace.wall_s},
            {"cpu_s", trace.cpu_s}};
  }

 private:
  void build(const json& request) {
    const std::string name = request.at("scene");
    std::optional<int> lane_width;
    if (request.contains("lane_width")) lane_width = lane_width_of(request.at("lane_width"));
    if (name == name_ && lane_width == lane_width_) return;
    const BenchScene& scene = scene_named(name);
    workload_.reset();
    name_.clear();
    workload_ = std::make_unique<Workload>(scene, lane_width);
    name_ = name;
    lane_width_ = lane_width;
  }

  std::string name_;
  std::optional<int> lane_width_;
  std::unique_ptr<const Workload> workload_;
};

json parsed(const std::string& answer) {
  json node = json::parse(answer, nullptr, false);
  if (node.is_discarded() || !node.is_object())
    throw core::InputError(
        {{},
         "the other program did not answer as a benchmark does: " + core::in_quotes(answer),
         "give a scintray_bench that has --serve"});
  if (node.contains("error")) throw core::InputError({{}, node.at("error").get<std::string>(), ""});
  return node;
}

}  // namespace

void serve(std::istream& requests, std::ostream& answers) {
  Server server;
  for (std::string line; std::getline(requests, line);) {
    json reply;
    try {
      reply = server.answer(json::parse(line));
    } catch (const std::exception& error) {
      reply = {{"error", error.what()}};
    }
    answers << reply.dump() << std::endl;
  }
}

std::string calibration_request(const std::string& scene, double seconds) {
  return json{{"scene", scene}, {"seconds", seconds}}.dump();
}

std::string trace_request(const std::string& scene, std::uint64_t work, const Turn& turn) {
  json request{{"scene", scene}, {"work", work}, {"threads", turn.threads}};
  if (turn.lane_width) request["lane_width"] = *turn.lane_width;
  return request.dump();
}

std::uint64_t work_of_answer(const std::string& answer) { return parsed(answer).at("work"); }

Trace trace_of_answer(const std::string& answer) {
  const json node = parsed(answer);
  Trace trace;
  node.at("segments").get_to(trace.segments);
  node.at("photons").get_to(trace.photons);
  node.at("events").get_to(trace.events);
  node.at("wall_s").get_to(trace.wall_s);
  node.at("cpu_s").get_to(trace.cpu_s);
  return trace;
}

}  // namespace scintray::bench
