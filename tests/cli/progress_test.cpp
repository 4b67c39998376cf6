// Progress on a terminal and in a log.
#include "scintray/cli/progress.hpp"

#include <doctest/doctest.h>

#include <sstream>

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
