#include "cli/program.hpp"
#include "io/tabulated.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::optics;
using namespace scintray::test;

TEST_CASE("a table is exported in every format, and the Davis pair imported again") {
  const auto folder = scratch_folder("cli_exchange");
  write_table(folder / "rough.h5", rough_table());
  const Ended davis =
      run_program({"table", "export", "rough.h5", "--format", "davis", "-o", "Rough_LUT.z"}, folder);
  CHECK(davis.exit_code == cli::kSuccess);
  CHECK(contains(davis.output, "Rough_LUTR.z"));
  CHECK(contains(davis.output, "below 1 deg"));
  std::vector<std::string> words{"table", "import",         "Rough_LUT.z",    "--format", "davis",
                                 "-o",    "again.h5",       "--inside-index", "1.82",     "--outside-index",
                                 "1",     "--from-outside", "smooth"};
  const Ended unsaid = run_program(words, folder);
  CHECK(unsaid.exit_code == cli::kBadInput);
  CHECK(contains(unsaid.output, "EFFICIENCY"));
  words.insert(words.end(), {"--unreflected", "transmitted"});
  const Ended read = run_program(words, folder);
  CHECK(read.exit_code == cli::kSuccess);
  const SurfaceTable again = read_table(folder / "again.h5");
  CHECK(again.index_pair().inside == 1.82);
  CHECK(again.reflectance(Side::inside, 0.5) ==
        doctest::Approx(rough_table().reflectance(Side::inside, 0.5)).epsilon(0.02));

  CHECK(run_program({"table", "export", "rough.h5", "--format", "bsdf", "--rays", "1000", "-o", "a.bsdf"},
                    folder)
            .exit_code == cli::kSuccess);
  CHECK(std::filesystem::exists(folder / "a_brdf.bsdf"));
  CHECK(std::filesystem::exists(folder / "a_btdf.bsdf"));
  CHECK(run_program({"table", "export", "rough.h5", "--format", "csv", "-o", "a.csv"}, folder).exit_code ==
        cli::kSuccess);
}

TEST_CASE(
    "a full disk leaves no file of a pair, and an import without its options is refused with the reason") {
  const auto folder = scratch_folder("cli_exchange_full");
  write_table(folder / "rough.h5", rough_table());
  const Ended full = run_program({"table", "export", "rough.h5", "--format", "davis", "-o", "Rough_LUT.dat"},
                                 folder, 1 << 20);
  CHECK(full.exit_code == cli::kSystemFailure);
  CHECK(contains(full.output, "Rough_LUT.dat: cannot write"));
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    CHECK(!contains(entry.path().filename().string(), "LUT"));
  const Ended bare =
      run_program({"table", "import", "groundair.z", "--format", "lbnl", "-o", "a.h5", "--inside-index",
                   "2.15", "--outside-index", "1", "--from-outside", "mirror", "--reflectance", "0.9"},
                  folder);
  CHECK(bare.exit_code == cli::kBadInput);
  CHECK(contains(bare.output, "no data exist"));
}

TEST_CASE("table: tabulated BSDF is read back, with its BTDF, and LBNL's layout holds no transmitted light") {
  const auto folder = scratch_folder("exchange_bsdf");
  write_table(folder / "rough.h5", rough_table());
  REQUIRE(run_program({"table", "export", "rough.h5", "--format", "bsdf", "--rays", "1000", "-o", "a.bsdf"},
                      folder)
              .exit_code == cli::kSuccess);
  std::vector<std::string> words{"table", "import",         "a_brdf.bsdf",    "--format", "bsdf",
                                 "-o",    "back.h5",        "--inside-index", "1.82",     "--outside-index",
                                 "1",     "--from-outside", "smooth"};
  const Ended without = run_program(words, folder);
  CHECK(without.exit_code == cli::kSuccess);
  CHECK(contains(without.output, "nothing is transmitted"));
  CHECK(read_table(folder / "back.h5").opaque());
  std::filesystem::remove(folder / "back.h5");
  words.insert(words.end(), {"--transmitted", "a_btdf.bsdf"});
  CHECK(run_program(words, folder).exit_code == cli::kSuccess);
  CHECK_FALSE(read_table(folder / "back.h5").opaque());
  words.back() = "a_brdf.bsdf";
  const Ended swapped = run_program(words, folder);
  CHECK(swapped.exit_code == cli::kBadInput);
  CHECK(contains(swapped.output, "a_brdf.bsdf:"));
  words.insert(words.end(), {"--reflectance", "0.9"});
  CHECK(contains(run_program(words, folder).output, "the files contain the shares"));
  const Ended through =
      run_program({"table", "export", "rough.h5", "--format", "lbnl", "-o", "GroundTeflon.z"}, folder);
  CHECK(through.exit_code == cli::kBadInput);
  CHECK(contains(through.output, "transmitted"));
}
