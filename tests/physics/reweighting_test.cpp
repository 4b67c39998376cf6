// Results reweighted from their photon histories against runs retraced with the wanted optics.
#include "scintray/simulation/results_file.hpp"
#include "scintray/simulation/reweight.hpp"
#include "scintray/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/traced.hpp"
#include "scintray/results/results.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::results;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

using enum OpticalProperty;

/// Runs a scene into a file of its own.
std::filesystem::path run_scene(const std::string& text, std::uint64_t seed) {
  const auto output = scratch_folder(fmt::format("reweighting_{}", seed)) / "run.h5";
  SimulationOptions options;
  options.surface_hooks = tables_of_this_build();
  ResultsFile results(output);
  Simulation(SceneFile::from_text(text, source_file("test.toml").string()), options).run_all(results);
  return output;
}

/// What is traced, and what is wanted of it.
struct Optics {
  double length_mm = 0.0;
  double reflectance = 0.0;
};

/// A crystal whose free faces have the surface "side", with photons or events, on a detector.
struct Setup {
  std::string side;  ///< definitions; {0} is the reflectance
  std::string source;
  std::string medium = "absorption = {{ length = \"{0} mm\" }}";

  std::string text(const Optics& optics, std::uint64_t seed) const {
    return R"(
title = "A crystal on a detector"
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["3 mm", "3 mm", "10 mm"]
medium = "crystal_lso"
surface = "side"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "flat"
[[part]]
name = "detector"
box = ["3 mm", "3 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
medium = "n15"
sensor = "perfect"
[media.crystal_lso]
index = { n = 1.82 }
scattering = { none = true }
density = { value = "7.4 g/cm3" }
composition = { formula = "Lu2SiO5" }
yield = { value = "10 1/keV" }
emission = { spectrum = { wavelength = [390, 420, 480], wavelength_unit = "nm", value = [0, 1, 0] } }
decay = [{ time = "40 ns", rise = "0 ns", fraction = 1.0 }]
)" + fmt::format(fmt::runtime(medium), optics.length_mm) +
           "\n[source]\nregion = { part = \"crystal\" }\n" + source +
           fmt::format("\n[run]\nphoton_history = true\nseed = {}\n", seed) +
           fmt::format(fmt::runtime(side), optics.reflectance) + kDatabase;
  }

  std::filesystem::path run(const Optics& optics, std::uint64_t seed) const {
    return run_scene(text(optics, seed), seed);
  }
};

const std::string kPhotons = "type = \"photons\"\nwavelength = \"420 nm\"\nphotons = 60_000";
const std::string kBare = "[surfaces.side]\nmodel = \"smooth\"\n";
const std::string kRoughWrapped = R"([surfaces.side]
model = "unified"
unified = {{ sigma_alpha = "12 deg", definition = "solid_angle", facets = "projected_area", lobe = 0.8, spike = 0.1 }}
gap = 1.0
reflectance = {0}
specular_share = 0.3
)";
const std::string kTableWrapped = R"([surfaces.side]
base = "lso_ground_30um"
gap = 1.0
reflectance = {0}
specular_share = 1.0
tracing = {{ rays = 2000, incidence_step = "10 deg", refine = false }}
)";
const std::string kMixture = R"([surfaces.side]
mixture = [{{ surface = "loose", share = 0.6 }}, {{ surface = "glued", share = 0.4 }}]
[surfaces.loose]
model = "smooth"
gap = 1.0
reflector = "film"
[surfaces.glued]
model = "smooth"
gap = 1.5
reflector = "film"
[reflectors.film]
reflectance = {{ value = {0} }}
direction = {{ specular_share = 0.0 }}
)";

std::vector<ReweightedPoint> reweight(const std::filesystem::path& path,
                                      const std::vector<PropertyScan>& scans) {
  return reweight_results(path, read_results(path), scans);
}

PropertyScan length_of_crystal(double length_mm) {
  return {absorption_length, "crystal_lso", false, {length_mm}};
}

/// Reweights one run to others, which are retraced; all must be valid and agree.
void check_retraced(const Setup& setup, const Optics& traced, const std::vector<Optics>& wanted,
                    const std::string& reflector, std::uint64_t seed) {
  const auto path = setup.run(traced, seed);
  for (const Optics& other : wanted) {
    CAPTURE(other.length_mm);
    CAPTURE(other.reflectance);
    std::vector<PropertyScan> scans;
    if (other.length_mm != traced.length_mm) scans.push_back(length_of_crystal(other.length_mm));
    if (other.reflectance != traced.reflectance)
      scans.push_back({reflectance, reflector, false, {other.reflectance}});
    const ReweightedPoint point = reweight(path, scans).at(0);
    const RunResult retraced = read_results(setup.run(other, ++seed));
    CAPTURE(point.light.reason);
    CHECK(point.light.valid);
    check_law("detected", point.light.detected_fraction, retraced.points[0].fraction(Fate::detected));
    CHECK(sigmas(point.light.detected_fraction, point.traced_fraction) > kSigmas);  // something changed
  }
}

}  // namespace

TEST_CASE("Law: a bare crystal reweighted to other absorption lengths is the one retraced") {
  check_retraced({kBare, kPhotons}, {100.0, 0.0}, {{40.0, 0.0}, {400.0, 0.0}}, "", 9100);
}

TEST_CASE("Law: a rough wrapped crystal reweighted is the one retraced") {
  check_retraced({kRoughWrapped, kPhotons}, {100.0, 0.9}, {{60.0, 0.95}, {300.0, 0.8}, {100.0, 0.5}}, "side",
                 9200);
}

TEST_CASE("Law: a table with a reflector behind it, reweighted, is the one retraced") {
  check_retraced({kTableWrapped, kPhotons}, {100.0, 0.9}, {{100.0, 0.96}, {200.0, 0.7}}, "side", 9300);
}

TEST_CASE("Law: a mixture whose parts share a reflector, reweighted, is the one retraced") {
  check_retraced({kMixture, kPhotons}, {100.0, 0.9}, {{100.0, 0.95}, {60.0, 0.8}}, "film", 9400);
}

// Light of a point in a medium that ends at a sensor of its own index and at walls that absorb: the share
// that reaches the plane of the sensor, 8 absorption lengths away, is E_2(8) / 2 = 1.7e-5, as its walls are
// too far away to matter (the integral over the angles to the normal of half exp(-8 / cosine)).
TEST_CASE(
    "Law: rare light of a run with four times the absorption length, by weight, is the exponential "
    "integral") {
  const double tau = 8.0;
  const double exact = 0.5 * (std::exp(-tau) + tau * std::expint(-tau));
  const std::string text = R"(
ambient = "vacuum"
[[part]]
name = "medium"
box = ["400 mm", "400 mm", "100 mm"]
medium = "clouded"
surface = "black"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "flat"
[[part]]
name = "detector"
box = ["400 mm", "400 mm", "1 mm"]
place = { touch = "medium", side = "-z" }
medium = "n15"
sensor = "perfect"
[media.clouded]
index = { n = 1.5 }
absorption = { length = "40 mm" }
scattering = { none = true }
[surfaces.black]
model = "painted"
reflectance = 0.0
specular_share = 0.0
[source]
type = "photons"
position = ["0 mm", "0 mm", "80 mm"]
wavelength = "420 nm"
photons = 400_000
[run]
photon_history = true
seed = 9700
)";
  const ReweightedPoint point =
      reweight(run_scene(text + kDatabase, 9700), {{absorption_length, "clouded", false, {10.0}}}).at(0);
  CHECK(point.light.valid);
  check_law("exponential integral", point.light.detected_fraction, Estimate{exact, 0.0});
  // Seven photons of 400,000 would be detected without weights.
  CHECK(point.light.detected_fraction.error < 0.1 * std::sqrt(exact / 400e3));
}

TEST_CASE("Law: an absorption against wavelength, times two, is the one retraced") {
  Setup setup{
      kBare, "type = \"photons\"\nwavelength = \"emission\"\nphotons = 60_000",
      R"(absorption = {{ length = {{ wavelength = [300, 400, 450, 700], wavelength_unit = "nm", value = [{0}, {0}, 200, 400], value_unit = "mm" }} }})"};
  const auto path = setup.run({30.0, 0.0}, 9500);
  Setup longer = setup;
  longer.medium =
      R"(absorption = {{ coefficient = {{ wavelength = [300, 400, 450, 700], wavelength_unit = "nm", value = [{0}, {0}, 0.0025, 0.00125], value_unit = "1/mm" }} }})";
  const RunResult retraced = read_results(longer.run({0.5 / 30.0, 0.0}, 9501));
  Setup even{kBare, setup.source};
  const RunResult constant = read_results(even.run({80.0, 0.0}, 9502));
  const auto points = reweight(path, {{absorption_length, "crystal_lso", true, {2.0}}});
  CHECK(points.at(0).light.valid);
  // Lengths are tabulated as coefficients, linear between wavelengths.
  check_law("twice", points[0].light.detected_fraction, retraced.points[0].fraction(Fate::detected));
  check_law("constant", reweight(path, {length_of_crystal(80.0)}).at(0).light.detected_fraction,
            constant.points[0].fraction(Fate::detected));
}

TEST_CASE("Law: light per event, reweighted, is that of events retraced") {
  Setup setup{kRoughWrapped, "type = \"gamma_events\"\nenergy = \"20 keV\"\nevents = 150"};
  const auto path = setup.run({100.0, 0.9}, 9600);
  const auto point = reweight(path, {length_of_crystal(200.0), {reflectance, "side", false, {0.95}}}).at(0);
  const RunResult retraced = read_results(setup.run({200.0, 0.95}, 9601));
  CHECK(point.light.valid);
  REQUIRE(point.per_event);
  check_law("per event", *point.per_event, retraced.points[0].energy.detected.mean());
  check_law("fraction", point.light.detected_fraction, retraced.points[0].fraction(Fate::detected));
  CHECK(sigmas(*point.per_event, *point.traced_per_event) > kSigmas);
  // As traced, the weights are one: both means are the same number.
  const auto same = reweight(path, {{absorption_length, "crystal_lso", true, {1.0}}}).at(0);
  CHECK(same.per_event->value == doctest::Approx(same.traced_per_event->value));
  CHECK(same.per_event->error == doctest::Approx(same.traced_per_event->error).epsilon(1e-5));
}

TEST_CASE("Where reweighting would be wrong it is not valid") {
  // Traced with an absorption length below the crystal's: the long ways of a clear one are missing.
  const Setup setup{kRoughWrapped, kPhotons};
  const Estimate truth = read_results(setup.run({1000.0, 0.9}, 9701)).points[0].fraction(Fate::detected);
  std::vector<double> wrong_by;
  for (std::uint64_t seed = 9710; seed < 9719; ++seed) {
    const auto dark = setup.run({3.0, 0.9}, seed);
    const auto clear = reweight(dark, {length_of_crystal(1000.0)}).at(0);
    CHECK_FALSE(clear.light.valid);
    wrong_by.push_back(sigmas(clear.light.detected_fraction, truth));
  }
  // It would have been wrong; in some runs a single photon of great weight makes value and error large.
  std::sort(wrong_by.begin(), wrong_by.end());
  CHECK(wrong_by[wrong_by.size() / 2] > kSigmas);
  const auto black = setup.run({100.0, 0.02}, 9702);
  const auto white = reweight(black, {{reflectance, "side", false, {0.98}}}).at(0);
  CHECK_FALSE(white.light.valid);
  const auto none = setup.run({100.0, 0.0}, 9703);
  const auto some = reweight(none, {{reflectance, "side", false, {0.5}}}).at(0);
  CHECK_FALSE(some.light.valid);
  check_contains(some.light.reason, "reflected nothing when traced");
}
