/// `scintray goniometer`, `scintray table list` and `scintray table compare`.

#include <algorithm>
#include <cmath>

#include "cli/program.hpp"
#include "scintray/cli/exit_codes.hpp"
#include "support/page_scripts.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::test;

namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string refusal(std::vector<std::string> words, int code = cli::kBadInput) {
  const Ended ended = run_program(words, scratch_folder("goniometer_refusal"));
  CAPTURE(ended.output);
  CHECK(ended.exit_code == code);
  return ended.output;
}

}  // namespace

TEST_CASE("goniometer prints shares, directions and widths, and writes page and tables") {
  const auto folder = scratch_folder("goniometer");
  std::ofstream(folder / "measured.csv") << "angle_deg,value,error\n-60,5,1\n0,10,1\n60,5,1\n";
  const Ended ended = run_program(
      {"goniometer", "polished_lambertian_097", "--angle", "20deg", "--wavelength", "420nm", "--rays",
       "50000", "--measured", "measured.csv", "-o", "out.html", "--csv", "out.csv", "--cells", "cells.csv"},
      folder);
  CAPTURE(ended.output);
  REQUIRE(ended.exit_code == cli::kSuccess);
  for (const std::string part : {"reflected", "transmitted", "absorbed", "mean in plane", "rms across",
                                 "20.000", "The measurement was multiplied by"})
    CHECK(contains(ended.output, part));
  const std::string page = content_of(folder / "out.html");
  for (const std::string part : {"data:image/png;base64,iVBORw0KGgo", "<svg", "measured: measured.csv",
                                 "prefers-color-scheme: dark", "Goniometer: polished_lambertian_097"})
    CHECK(contains(page, part));
  CHECK_FALSE(contains(scripts_of(page).page, "http://"));
  const std::string csv = content_of(folder / "out.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 2 + 180);
  CHECK(contains(content_of(folder / "cells.csv"), "reflected_rays"));
}

TEST_CASE("Ctrl-C and SIGTERM end goniometer with 130, a message, and no file") {
  for (const int signal : {SIGINT, SIGTERM}) {
    CAPTURE(signal);
    const auto folder = scratch_folder("goniometer_stopped");
    const Program program({"goniometer", "polished_lambertian_097", "--angle", "20deg", "--wavelength",
                           "420nm", "--rays", "1000000000000", "-o", "out.html", "--csv", "out.csv"},
                          folder);
    std::this_thread::sleep_for(std::chrono::seconds(3));
    program.signal(signal);
    const Ended ended = program.wait();
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kInterrupted);
    CHECK(contains(ended.output, "stopped"));
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      CHECK(entry.path().filename() == "output.txt");
  }
}

TEST_CASE("goniometer takes several angles, either side, and the surfaces of a scene") {
  const auto folder = scratch_folder("goniometer_scene");
  std::ofstream(folder / "scene.toml") << R"(
ambient = "air"
[media.thick]
index = { n = 2.0 }
absorption = { none = true }
scattering = { none = true }
[surfaces.mine]
model = "smooth"
[[part]]
name = "crystal"
box = ["1 mm", "1 mm", "1 mm"]
medium = "thick"
surface = "mine"
[source]
type = "photons"
region = { part = "crystal" }
direction = "isotropic"
wavelength = "420 nm"
time = "0 ns"
photons = 10
)";
  const Ended ended =
      run_program({"goniometer", "--angle", "0 deg", "mine", "--scene", "scene.toml", "--inside", "thick",
                   "--outside", "vacuum", "--side", "outside", "--angle", "80 deg", "--rays", "200000"},
                  folder);
  CAPTURE(ended.output);
  REQUIRE(ended.exit_code == cli::kSuccess);
  CHECK(contains(ended.output, "n 2.0000"));
  CHECK(contains(ended.output, "light from outside"));
  // ((2 - 1) / (2 + 1))^2 at normal incidence, within 4 standard errors of 200,000 rays.
  const std::string row = "        0.000";
  const std::size_t at = ended.output.find("\n" + row);
  REQUIRE(at != std::string::npos);
  const double law = 1.0 / 9.0;
  CHECK(std::abs(std::stod(ended.output.substr(at + 1 + row.size())) - law) <
        4.0 * std::sqrt(law * (1.0 - law) / 200'000.0));
  CHECK(contains(ended.output, "80.000"));
}

TEST_CASE(
    "a file of definitions alone serves goniometer and table stack, and a table or a map is measured by its "
    "name") {
  const auto folder = scratch_folder("goniometer_definitions");
  std::ofstream(folder / "mine.toml") << R"(
[media.thick]
index = { n = 2.0 }
absorption = { none = true }
scattering = { none = true }
[surfaces.wrapped]
model = "smooth"
gap = "air"
reflectance = 0.9
specular_share = 0
)";
  const auto done = [&](const std::vector<std::string>& words) {
    const Ended ended = run_program(words, folder);
    CAPTURE(ended.output);
    CHECK(ended.exit_code == cli::kSuccess);
    return ended.output;
  };
  done({"table", "stack", "wrapped", "--scene", "mine.toml", "--inside", "thick", "--outside", "air",
        "--wavelength", "420 nm", "--rays", "200", "--incidence-step", "15 deg", "--azimuth-step", "90 deg",
        "-o", "stack.h5"});
  check_contains(done({"goniometer", "wrapped", "--scene", "mine.toml", "--inside", "thick", "--angle",
                       "10 deg", "--rays", "2000"}),
                 {"n 2.0000"});
  check_contains(done({"goniometer", "stack.h5", "--scene", "mine.toml", "--inside", "thick", "--angle",
                       "10 deg", "--rays", "2000"}),
                 {"surface", "stack.h5"});
  const std::string map = source_file("tests/reference/microsurface/gaussian_rough.gsf").string();
  const std::string measured = done({"goniometer", map, "--scene", "mine.toml", "--inside", "thick",
                                     "--angle", "30 deg", "--rays", "2000", "--on-the-spot"});
  check_contains(measured, {"surface", "gaussian_rough.gsf"});
  check_contains(measured, "n 2.0000");
  // Rough: the light that is reflected is spread, where a smooth face sends it all one way.
  const std::size_t at = measured.find("\n  reflected ");
  REQUIRE(at != std::string::npos);
  std::istringstream words(measured.substr(at));
  std::string word, plus_minus;
  double mean = 0.0, error = 0.0, across = 0.0, across_error = 0.0, rms_deg = 0.0;
  words >> word >> mean >> plus_minus >> error >> across >> plus_minus >> across_error >> rms_deg;
  CHECK(rms_deg > 5.0);
}

TEST_CASE("goniometer explains what it cannot do") {
  CHECK(contains(refusal({"goniometer", "polished", "--angle", "90 deg"}), "less than 90 deg"));
  CHECK(contains(refusal({"goniometer", "polished", "--angle", "45"}), "no unit"));
  const std::string unknown = refusal({"goniometer", "polishd", "--angle", "45 deg"});
  CHECK(contains(unknown, "did you mean \"polished\"?"));
  CHECK(contains(refusal({"goniometer", "polished", "--angle", "45 deg", "--wavelength", "900 nm"}),
                 "from 350 to 700 nm"));
  CHECK(contains(refusal({"goniometer", "polished", "--angle", "45 deg", "--measured", "none.csv"}),
                 "none.csv"));
  CHECK(contains(
      refusal({"goniometer", "polished", "--angle", "4 deg", "--angle", "5 deg", "--measured", "x.csv"}),
      "expected one"));
  refusal({"goniometer", "polished"}, cli::kBadUsage);
  refusal({"goniometer", "polished", "--angle", "45 deg", "--side", "above"}, cli::kBadUsage);
  refusal({"table", "compare", "polished"}, cli::kBadUsage);
  CHECK(
      contains(refusal({"table", "compare", "roncali2013_unified_rough", "--slopes", "x.svg"}), "no facets"));
  CHECK(contains(refusal({"table", "list", "--inside", "LS0"}), "did you mean \"LSO\"?"));
}

TEST_CASE("table compare draws reflectances beside Fresnel, and prints what it draws") {
  const auto folder = scratch_folder("table_compare");
  const Ended ended = run_program(
      {"table", "compare", "polished", "detect_ground", "--outside", "air", "--outside",
       "optical_grease_roncali2013", "--rays", "2000", "--reflectance", "r.svg", "--directions", "d.svg"},
      folder);
  CAPTURE(ended.output);
  REQUIRE(ended.exit_code == cli::kSuccess);
  CHECK(contains(ended.output, "critical angle 33."));
  CHECK(contains(ended.output, "optical_grease_roncali2013"));
  CHECK(contains(ended.output, "incidence 45 deg"));
  for (const char* name : {"r.svg", "d.svg"}) {
    const std::string drawing = content_of(folder / name);
    CHECK(contains(drawing, "<svg xmlns=\"http://www.w3.org/2000/svg\""));
    CHECK(contains(drawing, "prefers-color-scheme: dark"));
  }
}

TEST_CASE("table list prints every surface with model, source, needs and reflectances, and shows them") {
  const auto folder = scratch_folder("table_list");
  const WithTablesOfThisRun tables;
  const Ended ended = run_program({"table", "list", "--rays", "200", "--page", "surfaces.html"}, folder);
  CAPTURE(ended.output);
  REQUIRE(ended.exit_code == cli::kSuccess);
  for (const std::string part :
       {"lso_ground_30um\n", "model recipe, based on lso_polished", "M. Born and E. Wolf",
        "required parameters: unified.sigma_alpha", "80 deg 1.00000", "written      surfaces.html"})
    CHECK(contains(ended.output, part));
  const std::string page = content_of(folder / "surfaces.html");
  std::size_t shown = 0;
  for (const auto& file : std::filesystem::directory_iterator(source_file("materials/surfaces")))
    if (contains(page, ">" + file.path().stem().string() + "</h2>")) ++shown;
  CHECK(shown == static_cast<std::size_t>(std::distance(
                     std::filesystem::directory_iterator(source_file("materials/surfaces")), {})));
}
