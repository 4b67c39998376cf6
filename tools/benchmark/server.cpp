#include "server.hpp"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "measure.hpp"
#include "scintray/core/error.hpp"

namespace scintray::bench {

using nlohmann::json;

namespace {

/// The last scene requested, built.
class Server {
 public:
  json answer(const json& request) {
    const std::string name = request.at("scene");
    if (name != name_) {
      const BenchScene& scene = scene_named(name);
      workload_.reset();
      workload_ = std::make_unique<Workload>(scene);
      name_ = name;
    }
    if (request.contains("seconds")) return {{"work", calibrate(*workload_, request.at("seconds")).work}};
    const Trace trace = workload_->trace(request.at("work"), request.at("threads"));
    return {{"segments", trace.segments},
            {"photons", trace.photons},
            {"events", trace.events},
            {"wall_s", trace.wall_s},
            {"cpu_s", trace.cpu_s}};
  }

 private:
  std::string name_;
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

std::string trace_request(const std::string& scene, std::uint64_t work, int threads) {
  return json{{"scene", scene}, {"work", work}, {"threads", threads}}.dump();
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
