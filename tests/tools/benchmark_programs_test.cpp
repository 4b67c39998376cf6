// Two benchmark programs that trace in turns, and the lines that they exchange.

#include <doctest/doctest.h>
#include <sched.h>

#include <optional>
#include <sstream>

#include "child_program.hpp"
#include "pairing.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/lane_width.hpp"
#include "server.hpp"
#include "support/folders.hpp"

using namespace scintray;
using namespace scintray::bench;

namespace {

/// Answers of a server to requests.
std::vector<std::string> answers_to(const std::vector<std::string>& requests) {
  std::stringstream in, out;
  for (const std::string& request : requests) in << request << '\n';
  serve(in, out);
  std::vector<std::string> answers;
  for (std::string line; std::getline(out, line);) answers.push_back(line);
  return answers;
}

std::string bench_program() { return (test::build_folder() / "bin" / "scintray_bench").string(); }

}  // namespace

TEST_CASE("A server answers each request with a line, and goes on after an error") {
  const auto answers =
      answers_to({trace_request("polished", 64, {}), trace_request("polishd", 64, {}), "nonsense",
                  calibration_request("polished", 1e-6), trace_request("polished", 64, {2, std::nullopt})});
  REQUIRE(answers.size() == 5);
  const Trace trace = trace_of_answer(answers[0]);
  CHECK(trace.photons == 64);
  CHECK(trace.events == 0);
  CHECK(trace.segments > 64);
  CHECK_THROWS_AS(trace_of_answer(answers[1]), core::InputError);
  CHECK_THROWS_AS(trace_of_answer(answers[2]), core::InputError);
  CHECK(work_of_answer(answers[3]) == 8192);  // never less than eight blocks
  CHECK(trace_of_answer(answers[4]).segments == trace.segments);
}

TEST_CASE("A server traces at the lane width that is asked for, with the same photons") {
  const auto answers = answers_to({R"({"scene": "unified", "work": 64, "threads": 1, "lane_width": 1})",
                                   R"({"scene": "unified", "work": 64, "threads": 1})",
                                   R"({"scene": "unified", "work": 64, "threads": 1, "lane_width": 3})"});
  REQUIRE(answers.size() == 3);
  CHECK(trace_of_answer(answers[0]).segments == trace_of_answer(answers[1]).segments);
  CHECK_THROWS(trace_of_answer(answers[2]));
}

TEST_CASE("A server says the kinds of work of places, and how fast the processor counts") {
  const auto answers =
      answers_to({R"({"kinds_of": [["", "/x/src/scintray/core/xoroshiro.hpp", "scintray::transport::step"],)"
                  R"( ["", "/usr/include/avxintrin.h", "scintray::optics::refract"],)"
                  R"( ["libembree3.so.3", "???", "0x1"], ["libc.so.6", "???", "malloc"]]})",
                  R"({"machine": true})"});
  REQUIRE(answers.size() == 2);
  CHECK(answers[0] == R"({"kinds":["random","surface","ray query","other"]})");
  CHECK(answers[1].find(R"("cycles_per_ns":)") != std::string::npos);
  CHECK(answers[1].find(R"("lane_widths":[1)") != std::string::npos);
}

TEST_CASE("An answer of another program is refused") {
  CHECK_THROWS_AS(trace_of_answer("usage: something"), core::InputError);
  CHECK_THROWS_AS(work_of_answer("[]"), core::InputError);
}

TEST_CASE(
    "Paired figures are the other's time over this one's: processor time of one thread, else elapsed time") {
  const Trace mine{.segments = 100, .wall_s = 2.0, .cpu_s = 1.0};
  Trace other{.segments = 100, .wall_s = 6.0, .cpu_s = 1.5};
  CHECK(paired_figures("s", {}, {mine}, {other}).ratio.median == 1.5);
  CHECK(paired_figures("s", {2, std::nullopt}, {mine}, {other}).ratio.median == 3.0);
  CHECK(paired_figures("s", {}, {mine}, {other}).segments_per_s == 100.0);
  CHECK(paired_figures("s", {}, {mine}, {other}).same_photons);
  other.segments = 101;
  CHECK_FALSE(paired_figures("s", {}, {mine}, {other}).same_photons);
}

TEST_CASE(
    "A program compared with itself traces the same photons; a scene that one lacks is said to be missing") {
  MeasureSettings settings;
  settings.seconds = 0.01;
  settings.rounds = 2;
  BenchScene missing = scene_named("polished");
  missing.name = "missing";
  std::size_t seen = 0;
  const auto pairs = pair_programs(bench_program(), bench_program(), {missing, scene_named("polished")},
                                   settings, [&](const PairedFigures&) { ++seen; });
  REQUIRE(pairs.size() == 3);
  CHECK(seen == 3);
  CHECK(pairs[0].trouble.find("\"missing\"") != std::string::npos);
  CHECK(text_of_pair(pairs[0]).find("\"missing\"") != std::string::npos);
  for (std::size_t i = 1; i < 3; ++i) {
    CHECK(pairs[i].scene == "polished");
    CHECK(pairs[i].turn.threads == static_cast<int>(i));
    CHECK(pairs[i].same_photons);
    CHECK(pairs[i].ratio.values.size() == 2);
  }
}

TEST_CASE("Programs are compared at each lane width that is asked for") {
  MeasureSettings settings;
  settings.seconds = 0.01;
  settings.rounds = 1;
  settings.lane_widths = core::lane_widths();
  const auto pairs = pair_programs(bench_program(), bench_program(), {scene_named("polished")}, settings,
                                   [](const PairedFigures&) {});
  REQUIRE(pairs.size() == settings.lane_widths.size() + 1);  // the first with two threads as well
  CHECK(pairs[1].turn.threads == 2);
  for (const PairedFigures& pair : pairs) {
    CHECK(pair.turn.lane_width.has_value());
    CHECK(pair.same_photons);
  }
  CHECK(pairs.back().turn.lane_width == settings.lane_widths.back());
}

TEST_CASE("A program beside this one runs on the processor that is chosen for it") {
  ChildProgram program({"sh", "-c", "while read line; do grep Cpus_allowed_list /proc/self/status; done"});
  cpu_set_t mine;
  REQUIRE(sched_getaffinity(0, sizeof mine, &mine) == 0);
  for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
    if (!CPU_ISSET(static_cast<std::size_t>(processor), &mine)) continue;
    program.keep_on(processor);
    program.write_line("which");
    CHECK(program.read_line() == "Cpus_allowed_list:\t" + std::to_string(processor));
  }
  CHECK_THROWS_AS(program.keep_on(CPU_SETSIZE - 1), core::SystemError);
}

TEST_CASE("A program beside this one reads and writes lines, and one that does not exist is an error") {
  ChildProgram program({"cat"});
  program.write_line("one");
  program.write_line("two");
  CHECK(program.read_line() == "one");
  CHECK(program.read_line() == "two");
  ChildProgram ended({"true"});
  CHECK_FALSE(ended.read_line().has_value());
  CHECK_THROWS_AS(ChildProgram({"/nowhere/program"}), core::SystemError);
}
