/// `scintray cache`, and the cache as commands use it.

#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "support/environment.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

/// A folder with a cache of its own, for the programs started while it exists.
class CacheFixture {
 public:
  explicit CacheFixture(const std::string& name)
      : folder_(scratch_folder(name)), place_("SCINTRAY_CACHE", cache().string()) {}

  /// Limits the cache by the value of SCINTRAY_CACHE_SIZE.
  void limit(const std::string& size) const { size_.set(size); }
  std::filesystem::path cache() const { return folder_ / "cache"; }
  const std::filesystem::path& folder() const { return folder_; }

  /// Output of a command that succeeds.
  std::string run(const std::vector<std::string>& words) const {
    const Ended ended = run_program(words, folder_);
    CAPTURE(ended.output);
    REQUIRE(ended.exit_code == cli::kSuccess);
    return ended.output;
  }
  std::string trace_stack(const std::string& output, const std::string& rays = "3") const {
    return run({"table", "stack", "lso_polished_esr_air", "--inside", "LSO", "--outside", "air",
                "--wavelength", "420 nm", "--rays", rays, "--incidence-step", "45 deg", "--no-refine", "-o",
                output});
  }
  std::size_t tables() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(cache()), std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path folder_;
  ScopedVariable place_, size_{"SCINTRAY_CACHE_SIZE", "1 GiB"};
};

}  // namespace

TEST_CASE("a stack is traced once, listed and cleared") {
  const CacheFixture fixture("cache_command");
  CHECK(contains(fixture.run({"cache", "list"}), "0 tables, 0 B of at most 1.0 GiB"));
  fixture.trace_stack("first.h5");
  fixture.trace_stack("second.h5");
  CHECK(fixture.tables() == 1);
  CHECK(fixture.run({"table", "show", "first.h5"}) == fixture.run({"table", "show", "second.h5"}));
  fixture.trace_stack("third.h5", "4");
  CHECK(fixture.tables() == 2);

  const std::string list = fixture.run({"cache", "list"});
  for (const std::string& part :
       {fixture.cache().string(), std::string("lso_polished_esr_air, LSO to air"), std::string("at 420 nm"),
        std::string("last used"), std::string("stack lso_polished_esr_air | air | "),
        std::string("2 tables")}) {
    CAPTURE(part);
    CHECK(contains(list, part));
  }
  const std::string json = fixture.run({"cache", "list", "--json"});
  for (const std::string part : {R"("limit_bytes": 1073741824)", R"("surface": "lso_polished_esr_air")",
                                 R"("wavelength_nm": 420)", R"("readable": true)"})
    CHECK(contains(json, part));

  CHECK(contains(fixture.run({"cache", "clear", "--older-than", "1 day"}), "removed      0 tables"));
  std::ofstream(fixture.cache() / "notes.txt") << "mine";
  CHECK(contains(fixture.run({"cache", "clear"}), "removed      2 tables"));
  CHECK(contains(fixture.run({"cache", "list"}), "0 tables"));
  CHECK(std::filesystem::exists(fixture.cache() / "notes.txt"));
}

TEST_CASE("a table of a map has the content of one that was traced without a cache") {
  const CacheFixture fixture("cache_map");
  std::ofstream(fixture.folder() / "map.txt") << "0 1 0 2\n1 0 3 0\n0 2 0 1\n2 0 1 0\n";
  const auto build = [&](const std::string& output) {
    fixture.run({"table", "build", "map.txt", "--pitch", "1 um", "--unit", "um", "--inside-index", "1.8",
                 "--outside-index", "1", "--rays", "3", "--incidence-step", "45 deg", "-o", output});
  };
  build("traced.h5");
  build("kept.h5");
  CHECK(fixture.tables() == 1);
  fixture.limit("0");
  build("without.h5");
  CHECK(fixture.run({"table", "show", "kept.h5"}) == fixture.run({"table", "show", "without.h5"}));
}

TEST_CASE("a cache that does not work is said and stops nothing") {
  const CacheFixture fixture("cache_broken");
  std::ofstream(fixture.cache()) << "a file where the folder should be";
  CHECK(contains(fixture.trace_stack("out.h5"), "warning: surface tables are not kept for later runs"));
  CHECK(std::filesystem::exists(fixture.folder() / "out.h5"));
  fixture.limit("plenty");
  CHECK(contains(fixture.trace_stack("out.h5"), "warning: SCINTRAY_CACHE_SIZE is \"plenty\""));
  CHECK(contains(fixture.run({"cache", "list"}), "warning: SCINTRAY_CACHE_SIZE is \"plenty\""));
}

TEST_CASE("a time that is none is refused, and nothing is removed") {
  const CacheFixture fixture("cache_time");
  fixture.trace_stack("out.h5");
  for (const std::string wrong : {"30", "days", "30 parsecs", "-1 days", "nan days", "1e300 days"}) {
    CAPTURE(wrong);
    const Ended ended = run_program({"cache", "clear", "--older-than=" + wrong}, fixture.folder());
    CHECK(ended.exit_code == cli::kBadInput);
    CHECK(contains(ended.output, "--older-than is \"" + wrong + "\""));
    CHECK(contains(ended.output, "30 days"));
  }
  CHECK(fixture.tables() == 1);
}
