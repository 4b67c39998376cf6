// Parameters found again from made-up measurements, each traced with another seed and blurred.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "bad_input/marked_text.hpp"
#include "physics/crystal_scene.hpp"
#include "physics/traced.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/simulation/fit.hpp"
#include "scintray/simulation/simulation.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::tally;
using namespace scintray::analysis;
using namespace scintray::simulation;
using namespace scintray::test;

namespace {

struct FittedKey {
  std::string key, start, low, high;
  double truth = 0.0;
};

/// A scene, what of it is to be found, and how it is measured.
struct FitCase {
  std::string name, scene;
  std::string fit;  ///< keys of [fit] beside the measurement
  std::vector<double> positions;
  std::vector<FittedKey> keys;
  double error = 0.01;  ///< of each measured value, over it
  double scale = 1.0;   ///< measured units over simulated ones
  std::uint64_t photons = 10'000, photons_measured = 100'000;
  bool events = false;  ///< these are numbers of events
};

std::string fit_scene_text(const FitCase& c, const std::filesystem::path& csv) {
  std::string text =
      c.scene + kDatabase + fmt::format("[fit]\nmeasurement = \"{}\"\n{}", csv.string(), c.fit);
  for (const FittedKey& key : c.keys)
    text += fmt::format("[[fit.parameter]]\nkey = \"{}\"\nstart = {}\nlow = {}\nhigh = {}\n", key.key,
                        key.start, key.low, key.high);
  return text;
}

std::filesystem::path write_points(const std::filesystem::path& csv, const FitCase& c,
                                   const ModelCurve* curve) {
  std::ofstream stream(csv);
  Rng rng(4242, StreamKind::other, 0);
  for (std::size_t i = 0; i < c.positions.size(); ++i) {
    const double light = curve ? (*curve)[i].value.value : 1.0;
    const double seen = light * (1.0 + c.error * sample_normal(rng));
    // The errors of a measurement are its own: that of the made-up curve's photons is in them.
    const double error = curve ? std::hypot(c.error * light, (*curve)[i].value.error) : 1.0;
    stream << fmt::format("{},{},{}\n", c.positions[i], c.scale * seen, c.scale * error);
  }
  return csv;
}

struct TruthModel {
  SceneFile file;
  FitSpec spec;
  MeasuredCurve positions;
  FitModelSettings settings;
  std::unique_ptr<FitModel> model;
};

/// The scene's curve with a seed and photons of its own.
std::unique_ptr<TruthModel> truth_model(const FitCase& c, std::uint64_t seed, std::uint64_t photons) {
  const auto folder = scratch_folder("fit_" + c.name);
  const auto csv = write_points(folder / "light.csv", c, nullptr);
  auto truth = std::make_unique<TruthModel>(TruthModel{
      SceneFile::from_text(fit_scene_text(c, csv), (folder / "scene.toml").string()), {}, {}, {}, {}});
  truth->spec = *truth->file.spec(0).fit;
  truth->positions = read_measured_curve(csv);
  truth->settings.run.seed = seed;
  (c.events ? truth->settings.run.events : truth->settings.run.photons) = photons;
  truth->settings.run.surface_hooks.cache.clear();
  truth->model = make_fit_model(truth->file, truth->spec, truth->positions, truth->settings);
  return truth;
}

std::vector<double> truth_of(const FitCase& c) {
  std::vector<double> truth;
  for (const FittedKey& key : c.keys) truth.push_back(key.truth);
  return truth;
}

/// Measures with the truth, fits from elsewhere, compares. A p-value below that of four standard errors is a
/// false alarm as rare as theirs.
CurveFit check_recovered(const FitCase& c) {
  const auto folder = scratch_folder("fit_" + c.name);
  const auto csv = folder / "light.csv";
  {
    const auto truth = truth_model(c, 77, c.photons_measured);
    const auto curve = truth->model->trace(truth_of(c), 0);
    REQUIRE(curve);
    write_points(csv, c, &*curve);
  }
  const SceneFile file = SceneFile::from_text(fit_scene_text(c, csv), (folder / "scene.toml").string());
  SceneFitOptions options;
  (c.events ? options.model.run.events : options.model.run.photons) = c.photons;
  options.model.run.surface_hooks.cache.clear();
  const FitRecord record = fit_scene(file, options);
  REQUIRE(record.fit.has_errors);
  CHECK(record.fit.end == FitEnd::converged);
  for (const FittedParameter& p : record.fit.parameters) CHECK(p.determined);
  for (std::size_t j = 0; j < c.keys.size(); ++j)
    check_law(c.keys[j].key, record.fit.parameters[j].value, {c.keys[j].truth, 0.0});
  CHECK(record.fit.goodness.p_value > 6e-5);
  CHECK(record.fit.steps.back().evaluations < 120);
  return record.fit;
}

const std::vector<double> kFitDepths{1, 4, 7, 10, 13, 16, 19};

const std::string kAtDepth =
    "quantity = \"detected_fraction\"\nat = \"source.region.slab_z.center\"\nunit = \"mm\"\n";

std::string fitted_crystal(const std::string& surfaces) {
  return crystal_scene({"crystal_medium", "sides", slab(10.0), 1000}) + R"(
[media.crystal_medium]
index = { n = 1.82 }
absorption = { length = "60 mm" }
scattering = { none = true }
)" + surfaces;
}

const std::string kUnifiedSides = R"([surfaces.sides]
model = "unified"
unified = { sigma_alpha = "12 deg", definition = "solid_angle", facets = "projected_area", lobe = 1.0 }
)";

const FittedKey kSigmaAlpha{"surfaces.sides.unified.sigma_alpha", "\"6 deg\"", "\"1 deg\"", "\"40 deg\"",
                            12.0};

FitCase ground_case() {
  FitCase c{"ground",
            fitted_crystal(kUnifiedSides),
            kAtDepth + "scale = \"fixed\"\n",
            kFitDepths,
            {kSigmaAlpha,
             {"media.crystal_medium.absorption.length", "\"200 mm\"", "\"10 mm\"", "\"1000 mm\"", 60.0}}};
  c.photons = 40'000;
  return c;
}

}  // namespace

TEST_CASE(
    "Facet width and absorption length of a ground crystal are found together from light against depth") {
  check_recovered(ground_case());
}

TEST_CASE("The reflectance of a reflector is found from light in arbitrary units") {
  FitCase c{"reflector",
            fitted_crystal(R"([surfaces.sides]
model = "painted"
reflector = "wrap"
[reflectors.wrap]
reflectance = { value = "96 %" }
direction = { specular_share = 0.0 }
)"),
            kAtDepth + "scale = \"free\"\n",
            {1, 2, 3, 4, 5, 6, 8, 10},
            {{"reflectors.wrap.reflectance.value", "\"85 %\"", "\"50 %\"", "\"100 %\"", 96.0}}};
  c.scale = 5000.0;
  const CurveFit fit = check_recovered(c);
  CHECK(std::abs(fit.scale.value - c.scale) < kSigmas * fit.scale.error);
}

TEST_CASE("The share of a coupling in a mixture is found, and the other takes the rest") {
  FitCase c{"mixture",
            fitted_crystal(R"([surfaces.sides]
mixture = [{ surface = "glued", share = 0.35 }, { surface = "loose" }]
[surfaces.glued]
model = "painted"
reflectance = 0.9
specular_share = 0.0
[surfaces.loose]
model = "smooth"
gap = "vacuum_n1"
reflectance = 0.9
specular_share = 0.0
)"),
            kAtDepth + "scale = \"fixed\"\n",
            kFitDepths,
            {{"surfaces.sides.mixture.glued.share", "0.8", "0", "1", 0.35}}};
  check_recovered(c);
}

TEST_CASE("Facet width is found from the reflectance against incidence") {
  check_recovered({"reflectance",
                   fitted_crystal(kUnifiedSides),
                   R"(quantity = "reflectance"
unit = "deg"
scale = "fixed"
[fit.goniometer]
surface = "sides"
inside = "crystal_medium"
outside = "vacuum_n1"
wavelength = "420 nm"
side = "inside"
)",
                   {0, 10, 20, 25, 30, 35, 40, 50, 60},
                   {kSigmaAlpha}});
}

TEST_CASE("An absorption length is found from light per keV, too") {
  FitCase c{"events",
            fitted_crystal("[surfaces.sides]\nmodel = \"smooth\"\n"),
            R"(quantity = "light_per_keV"
at = "source.region.slab_z.center"
unit = "mm"
scale = "fixed"
)",
            {2, 6, 10, 14, 18},
            {{"media.crystal_medium.absorption.length", "\"200 mm\"", "\"10 mm\"", "\"1000 mm\"", 60.0}}};
  c.scene =
      replaced(c.scene, "scattering = { none = true }\n[surfaces.sides]", R"(scattering = { none = true }
yield = { value = "2 1/keV" }
emission = { spectrum = { wavelength = [400, 420, 440], wavelength_unit = "nm", value = [0, 1, 0] } }
decay = [{ time = "40 ns", rise = "0 ns", fraction = 1 }]
[surfaces.sides])");
  c.scene = replaced(c.scene, "type = \"photons\"", "type = \"gamma_events\"");
  c.scene = replaced(c.scene, "wavelength = \"420 nm\"\nphotons = 1000", "energy = \"100 keV\"\nevents = 10");
  c.events = true;
  c.photons = 100;
  c.photons_measured = 1000;
  check_recovered(c);
}

TEST_CASE("Common random numbers lessen the noise of differences of curves") {
  const FitCase c = ground_case();
  // Curves less than an error of the fit above apart, of one seed and of two.
  const std::vector<double> low{11.8, 59.0}, high{12.2, 61.0};
  constexpr std::uint64_t kSeeds = 12;
  const auto points = kFitDepths.size();
  std::vector<Moments> one_seed(points), two_seeds(points);
  std::optional<ModelCurve> before;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto crystal = truth_model(c, seed, 2000);
    const auto a = crystal->model->trace(low, 0), b = crystal->model->trace(high, 0);
    REQUIRE(a);
    REQUIRE(b);
    for (std::size_t i = 0; i < points; ++i) {
      one_seed[i].add((*b)[i].value.value - (*a)[i].value.value);
      if (before) two_seeds[i].add((*b)[i].value.value - (*before)[i].value.value);
    }
    before = a;
  }
  double common = 0.0, independent = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    common += std::pow(one_seed[i].standard_deviation(), 2);
    independent += std::pow(two_seeds[i].standard_deviation(), 2);
  }
  // The logarithm of a ratio of variances of f1 and f2 degrees of freedom has an error of sqrt(2/f1 + 2/f2).
  const auto n = static_cast<double>(points);
  const double error = std::sqrt(2.0 / (n * 11.0) + 2.0 / (n * 10.0));
  INFO("variance of differences, independent over common: " << independent / common);
  CHECK(std::log(independent / common) > kSigmas * error);
}

TEST_CASE("The made-up measurement that is shipped is what its scene gives with the seed it names") {
  const SceneFile file = SceneFile::load(source_file("scenes/fit_depth_curve.toml"));
  SimulationOptions options;
  options.seed = 7;
  const RunResult run = Simulation(file, options).run_all();
  const MeasuredCurve measured = read_measured_curve(source_file("scenes/fit_depth_curve.csv"));
  REQUIRE(run.points.size() == measured.points.size());
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    const Estimate light = run.points[i].fraction(Fate::detected);
    // Five decimals are printed.
    CHECK(std::abs(light.value - measured.points[i].y.value) < 0.51e-5);
    CHECK(std::abs(light.error - measured.points[i].y.error) < 0.51e-5);
  }
}
