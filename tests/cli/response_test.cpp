#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "scintray/results/results.hpp"
#include "support/shared.hpp"
#include "support/small_crystal.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::results;
using namespace scintray::test;

namespace {

std::string page_of(const std::filesystem::path& path) {
  std::ifstream page(path);
  return {std::istreambuf_iterator<char>(page), {}};
}

}  // namespace

TEST_CASE("A map is built, events are made from it, and its result is reported like any other") {
  const auto folder = scratch_folder("response_program");
  std::ofstream(folder / "scene.toml") << kSmallCrystal;
  const auto did = [&](const std::vector<std::string>& command, int code, const std::string& words) {
    const Ended ended = run_program(command, folder);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == code);
    CHECK(contains(ended.output, words));
  };
  did({"response", "build", "scene.toml", "-o", "map.h5", "--pitch", "1 mm", "--photons", "100"},
      cli::kSuccess, "crystal: 2 x 2 x 4 cells");
  did({"response", "run", "scene.toml", "map.h5", "-o", "result.h5", "--events", "500"}, cli::kSuccess,
      "500 events");
  CHECK(contains(page_of(folder / "result.html"), "without tracing photons"));
  CHECK(contains(page_of(folder / "result.html"), "events/s"));
  CHECK_FALSE(contains(page_of(folder / "result.html"), "0 photons/s"));
  CHECK(read_events(folder / "result.h5", 0, 1'000).size() == 500);
  did({"report", "result.h5", "--text"}, cli::kSuccess, "Lost photons: 0");
  did({"report", "result.h5"}, cli::kSuccess, "result.html");
  did({"report", "result.h5", "--json"}, cli::kSuccess, "\"not_included\"");
  did({"analyze", "result.h5", "--json"}, cli::kSuccess, "\"photopeak\"");
  did({"response", "run", "scene.toml", "map.h5", "-o", "again.h5", "--events", "500", "--seed", "77"},
      cli::kSuccess, "500 events");
  did({"report", "result.h5", "again.h5"}, cli::kSuccess, "result.comparison.html");
  CHECK(contains(page_of(folder / "result.comparison.html"), "mean light of a pulse"));
  did({"report", "result.h5", "again.h5", "--text"}, cli::kSuccess, "root mean square");
  did({"report", "result.h5", "again.h5", "--json"}, cli::kSuccess,
      "\"quantity\": \"mean light of a pulse\"");
  did({"report", "result.h5", "again.h5", "-o", "again.h5"}, cli::kBadInput, "would replace");
  did({"analyze", "result.h5"}, cli::kSuccess, "pulses: 500 of 500 events");
  const std::string text = page_of(folder / "result.html");
  CHECK(contains(text, ">Events</h2>"));
  CHECK_FALSE(contains(text, "Where every photon ended"));  // none was traced
  did({"response", "build", "scene.toml", "-o", "map.h5", "--pitch", "1"}, cli::kBadUsage, "has no unit");
  did({"response", "run", "scene.toml", "result.h5", "-o", "other.h5"}, cli::kBadInput, "not a response map");
}
