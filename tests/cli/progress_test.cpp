// Progress on a terminal and in a log.
#include "scintray/cli/progress.hpp"

#include <doctest/doctest.h>

#include <sstream>
#include <thread>

#include "support/words.hpp"

using namespace scintray;
using namespace scintray::cli;
using namespace scintray::test;

namespace {

/// A progress line with a clock that the test sets.
struct Watched {
  explicit Watched(bool terminal)
      : line(true, {terminal, &text, [this] { return ProgressOutput::Clock::time_point(now); }}) {}

  std::chrono::seconds now{1000};
  std::ostringstream text;
  ProgressLine line;
};

}  // namespace

TEST_CASE("a log gets one line a minute, and none of short work") {
  Watched log(false);
  for (int second = 0; second < 59; ++second) {
    log.now += std::chrono::seconds(1);
    log.line.show("point 1/1", second, 1000.0, "photons");
  }
  CHECK(log.text.str().empty());
  for (int second = 59; second < 185; ++second) {
    log.now += std::chrono::seconds(1);
    log.line.show("point 1/1", second, 1000.0, "photons");
  }
  log.line.clear();
  const std::string text = log.text.str();
  CHECK(std::count(text.begin(), text.end(), '\n') == 3);
  check_contains(text, {"point 1/1", "6 %", "photons/s", "left"});
  CHECK_FALSE(contains(text, "\r"));
  CHECK_FALSE(contains(text, "\033"));
}

TEST_CASE("a terminal gets one line that is written over and removed") {
  Watched terminal(true);
  for (int second = 0; second < 3; ++second) {
    terminal.now += std::chrono::seconds(1);
    terminal.line.show("point 1/1", second, 1000.0, "photons");
  }
  terminal.line.clear();
  const std::string text = terminal.text.str();
  CHECK(std::count(text.begin(), text.end(), '\n') == 0);
  CHECK(std::count(text.begin(), text.end(), '\r') == 4);
}

TEST_CASE("work that is quiet shows nothing") {
  std::ostringstream text;
  ProgressLine line(false, {true, &text, ProgressOutput::Clock::now});
  line.show("point 1/1", 1.0, 2.0, "photons");
  CHECK(text.str().empty());
}

TEST_CASE("Work that reports nothing is named again once a minute in a log, with how long it has taken") {
  Watched log(false);
  log.line.show("looking for crossing triangles", 0.0, 0.0, "");
  for (int second = 0; second < 150; ++second) {
    log.now += std::chrono::seconds(1);
    log.line.repeat();
  }
  const std::string text = log.text.str();
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
  check_contains(text, {"looking for crossing triangles", "1 min 00 s"});
  check_contains(text, {"looking for crossing triangles", "2 min 00 s"});
  log.line.clear();
  log.now += std::chrono::seconds(100);
  log.line.repeat();  // there is nothing to repeat
  CHECK(log.text.str() == text);
}

TEST_CASE("A step of the work shows how far it is, also when repeated") {
  Watched log(false);
  log.now += std::chrono::seconds(61);
  log.line.show("placing parts: guide", 30.0, 120.0, "");
  check_contains(log.text.str(), {"placing parts: guide", "25 %", "left"});
  log.now += std::chrono::seconds(61);
  log.line.repeat();
  check_contains(log.text.str(), {"for 1 min 01 s"});
}

TEST_CASE("Activities of the own thread are shown, and only while they are watched") {
  Watched terminal(true);
  {
    const ActivityWatch watch(terminal.line, std::chrono::hours(1));
    terminal.now += std::chrono::seconds(1);
    core::report_activity("placing parts: a", 3, 12);
    std::thread([] { core::report_activity("another thread", 1, 2); }).join();
  }
  terminal.now += std::chrono::seconds(1);
  core::report_activity("after the end");
  check_contains(terminal.text.str(), {"placing parts: a", "25 %"});
  CHECK_FALSE(contains(terminal.text.str(), "another thread"));
  CHECK_FALSE(contains(terminal.text.str(), "after the end"));
}
