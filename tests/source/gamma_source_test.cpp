#include "scintray/source/detail/event_sources.hpp"

#include "event_scene.hpp"
#include "scintray/core/statistics.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

const std::string kHere = "position = [\"0 mm\", \"0 mm\", \"0 mm\"]\n";

GammaEventSource emitter(const std::string& keys, const Scene& scene) {
  const GammaSpec spec = gamma_spec("type = \"gammas\"\nevents = 1\n" + keys);
  return {std::get<EmitterSpec>(spec.kind), spec.events, scene};
}

/// The starts of `count` events.
std::vector<GammaEventSource::Start> starts(const GammaEventSource& source, const Scene& scene, int count) {
  std::vector<GammaEventSource::Start> all;
  for (int i = 0; i < count; ++i) {
    Rng rng(3, StreamKind::event, static_cast<std::uint64_t>(i));
    all.push_back(source.start(scene, rng));
  }
  return all;
}

double sum_keV(const GammaEventSource::Start& start) {
  double sum = 0.0;
  for (const Gamma& gamma : start.gammas) sum += gamma.energy_keV;
  return sum;
}

std::string refused(const std::string& keys) {
  return complaint([&] { gamma_spec("type = \"gammas\"\nevents = 1\n" + keys); });
}

}  // namespace

TEST_CASE("an isotropic source is isotropic") {
  // Chi-square of three coordinates in 20 bins each; false alarm 3 in 10 000.
  const Scene scene = lso_cube(5.0);
  const GammaEventSource source =
      emitter(kHere + "emission = \"gamma\"\nenergy = \"511 keV\"\ndirection = \"isotropic\"", scene);
  constexpr int kCount = 20000;
  std::array<std::vector<std::uint64_t>, 3> bins;
  bins.fill(std::vector<std::uint64_t>(20, 0));
  for (const auto& start : starts(source, scene, kCount)) {
    REQUIRE(start.gammas.size() == 1);
    CHECK(start.gammas[0].energy_keV == 511.0);
    for (int axis = 0; axis < 3; ++axis)
      ++bins[static_cast<std::size_t>(axis)][std::min<std::size_t>(
          19, static_cast<std::size_t>((start.gammas[0].direction[axis] + 1.0) * 10.0))];
  }
  const std::vector<double> expected(20, kCount / 20.0);
  for (const auto& observed : bins) CHECK(chi_square_test(observed, expected).p_value > 1e-4);
}

TEST_CASE("beams, cones and planes have their positions and directions") {
  const Scene scene = lso_cube(5.0);
  const std::string gamma = "emission = \"gamma\"\nenergy = \"100 keV\"\n";
  for (const auto& start : starts(emitter(kHere + gamma + "direction = [0, 2, 0]", scene), scene, 10))
    CHECK(start.gammas[0].direction.isApprox(Vec3::UnitY()));
  Moments cosine;
  for (const auto& start :
       starts(emitter(kHere + gamma + "direction = { cone = [0, 0, 1], half_angle = \"60 deg\" }", scene),
              scene, 4000)) {
    CHECK(start.gammas[0].direction.z() >= 0.5 - 1e-12);
    cosine.add(start.gammas[0].direction.z());
  }
  CHECK(std::abs(cosine.mean().value - 0.75) < 4.5 * cosine.mean().error);  // uniform from 0.5 to 1
  const GammaEventSource plane =
      emitter(gamma +
                  "direction = [0, 0, 1]\nplane = { center = [\"1 mm\", \"0 mm\", \"-30 mm\"], "
                  "x = [\"4 mm\", \"0 mm\", \"0 mm\"], y = [\"0 mm\", \"2 mm\", \"0 mm\"] }",
              scene);
  Eigen::AlignedBox3d box;
  for (const auto& start : starts(plane, scene, 4000)) {
    box.extend(start.place.position);
    CHECK(start.place.region == kAmbientRegion);
  }
  CHECK(box.min().isApprox(Vec3(-1.0, -1.0, -30.0), 1e-2));
  CHECK(box.max().isApprox(Vec3(3.0, 1.0, -30.0), 1e-2));
}

TEST_CASE("pairs are back to back, or nearly") {
  const Scene scene = lso_cube(5.0);
  for (const auto& start :
       starts(emitter(kHere + "emission = \"pair\"\ndirection = \"isotropic\"", scene), scene, 100)) {
    REQUIRE(start.gammas.size() == 2);
    CHECK(start.gammas[0].direction.isApprox(-start.gammas[1].direction, 1e-12));
    CHECK(sum_keV(start) == doctest::Approx(2.0 * kElectronMass_keV));
  }
  // FWHM 0.5 deg in each transverse angle: sigma 0.2123 deg, known to 1 in sqrt(2 x 5000).
  const GammaEventSource source =
      emitter(kHere + "emission = \"pair\"\ndirection = [0, 0, 1]\nacollinearity = \"0.5 deg\"", scene);
  Moments angle;
  for (const auto& start : starts(source, scene, 5000)) angle.add(start.gammas[1].direction.x() / kDegree);
  CHECK(angle.standard_deviation() == doctest::Approx(0.5 / 2.354820).epsilon(0.045));
}

TEST_CASE("nuclides emit by their decay data") {
  const Scene scene = lso_cube(5.0);
  constexpr int kCount = 20000;
  std::uint64_t line = 0, pairs = 0;
  for (const auto& start : starts(emitter(kHere + "emission = \"Na22\"", scene), scene, kCount)) {
    for (const Gamma& gamma : start.gammas) line += gamma.energy_keV == kSodiumGamma_keV ? 1 : 0;
    pairs += start.gammas.size() >= 2 ? 1 : 0;
  }
  // Within 4.5 standard errors.
  CHECK(std::abs(static_cast<double>(line) / kCount - 0.9994) < 4.5 * std::sqrt(0.9994 * 0.0006 / kCount));
  CHECK(std::abs(static_cast<double>(pairs) / kCount - 0.9035) < 4.5 * std::sqrt(0.9035 * 0.0965 / kCount));
  std::uint64_t caesium = 0;
  for (const auto& start : starts(emitter(kHere + "emission = \"Cs137\"", scene), scene, kCount))
    caesium += start.gammas.size();
  CHECK(std::abs(static_cast<double>(caesium) / kCount - 0.851) < 4.5 * std::sqrt(0.851 * 0.149 / kCount));
}

TEST_CASE("a decay of lutetium releases its beta and 597 keV") {
  const Scene scene = lso_cube(5.0);
  constexpr int kCount = 20000;
  Moments beta;
  std::array<std::uint64_t, 3> lines{};
  for (const auto& start :
       starts(emitter("region = { part = \"crystal\" }\nemission = \"Lu176\"", scene), scene, kCount)) {
    const double beta_keV = start.local_keV() + sum_keV(start) - (306.78 + 201.83 + 88.34);
    CHECK(beta_keV >= -1e-9);
    CHECK(beta_keV <= kLutetiumBetaEnd_keV);
    beta.add(beta_keV);
    for (const Gamma& gamma : start.gammas)
      ++lines[gamma.energy_keV > 300.0 ? 0u : gamma.energy_keV > 200.0 ? 1u : 2u];
  }
  // Mean of the beta spectrum: 182 keV (H. Alva-Sanchez et al. 2018, Sci. Rep. 8 17310, from ENSDF).
  CHECK(beta.mean().value == doctest::Approx(182.0).epsilon(0.02));
  for (std::size_t i = 0; i < 3; ++i) {
    const double p = kLutetiumTransitions[i].gammas;
    CHECK(std::abs(static_cast<double>(lines[i]) / kCount - p) < 4.5 * std::sqrt(p * (1.0 - p) / kCount));
  }
}

TEST_CASE("a large crystal absorbs all energy of a lutetium decay, a small one less") {
  const auto mean_seen = [](double edge_mm) {
    const Scene scene = lso_cube(edge_mm);
    const auto source = event_source(
        "type = \"gammas\"\nevents = 500\nemission = \"Lu176\"\nregion = { part = \"crystal\" }", scene);
    double seen = 0.0, all = 0.0;
    for (std::uint64_t i = 0; i < source->events(); ++i) {
      const Event event = make_event(*source, scene, i);
      seen += deposited_keV(event);
      all += event.energy_keV;
      CHECK(deposited_keV(event) + event.escaped_keV == doctest::Approx(event.energy_keV).epsilon(1e-12));
    }
    return seen / all;
  };
  CHECK(mean_seen(500.0) > 0.99);
  CHECK(mean_seen(2.0) < 0.9);
}

TEST_CASE("an event depends on its number only") {
  const Scene scene = lso_cube(20.0);
  const auto source = event_source(
      "type = \"gammas\"\nevents = 20\nemission = \"pair\"\ndirection = \"isotropic\"\n" + kHere, scene);
  const auto again = event_source(
      "type = \"gammas\"\nevents = 20\nemission = \"pair\"\ndirection = \"isotropic\"\n" + kHere, scene);
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Event a = make_event(*source, scene, 19 - i), b = make_event(*again, scene, 19 - i);
    REQUIRE(a.deposits.size() == b.deposits.size());
    for (std::size_t k = 0; k < a.deposits.size(); ++k)
      CHECK(a.deposits[k].energy_keV == b.deposits[k].energy_keV);
  }
}

TEST_CASE("sources that are none are refused with what to do") {
  const std::string gamma = "emission = \"gamma\"\n";
  CHECK(
      says(refused(kHere + gamma + "energy = \"5 keV\"\ndirection = [0, 0, 1]"), "between 10 keV and 3 MeV"));
  CHECK(
      says(refused(kHere + gamma + "energy = \"4 MeV\"\ndirection = [0, 0, 1]"), "between 10 keV and 3 MeV"));
  CHECK(says(refused(kHere + "emission = \"Na22\"\nenergy = \"4 MeV\""), "are known"));
  CHECK(says(refused(kHere + "emission = \"Na22\"\ndirection = [0, 0, 1]"), "in all directions"));
  CHECK(says(refused(kHere + "emission = \"Co60\""), "Cs137"));
  CHECK(says(refused("emission = \"pair\"\ndirection = \"isotropic\""), "plane"));
  CHECK(says(
      refused(
          "emission = \"pair\"\ndirection = \"isotropic\"\nplane = { x = [\"1 mm\", \"0 mm\", \"0 mm\"] }"),
      "a plane needs \"center\""));
  CHECK(says(refused(kHere + "emission = \"pair\"\ndirection = [0, 0, 1]\nacollinearity = \"20 deg\""),
             "between 0 and 0.1 rad"));
  const Scene scene = scene_of(box_part("crystal", "BGO", Vec3::Constant(3.0)));
  CHECK(says(complaint([&] { emitter("region = { part = \"crystal\" }\nemission = \"Lu176\"", scene); }),
             "no lutetium in \"crystal\""));
  const Scene dark = scene_of(box_part("crystal", "glass", Vec3::Constant(3.0)));
  CHECK(says(complaint([&] { emitter(kHere + "emission = \"pair\"\ndirection = [0, 0, 1]", dark); }),
             "no part of the scene scintillates"));
}
