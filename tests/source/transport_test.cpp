#include "scintray/source/detail/gamma/transport.hpp"

#include <algorithm>

#include "event_scene.hpp"
#include "scintray/core/statistics.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

std::string gammas(const std::string& energy, int events, const std::string& more = "") {
  return fmt::format(
      "type = \"gammas\"\nemission = \"gamma\"\nenergy = \"{}\"\nevents = {}\n"
      "position = [\"0 mm\", \"0 mm\", \"0 mm\"]\n{}\n",
      energy, events, more);
}

/// A beam along z from 50 mm below the origin.
std::string beam(const std::string& energy, int events, const std::string& more = "") {
  return fmt::format(
      "type = \"gammas\"\nemission = \"gamma\"\nenergy = \"{}\"\nevents = {}\n"
      "position = [\"0.001 mm\", \"0.002 mm\", \"-50 mm\"]\ndirection = [0, 0, 1]\n{}\n",
      energy, events, more);
}

const std::string kNoFluorescence = "fluorescence = false";

/// Checks a share of `all` against its law, within 4.5 standard errors (false alarm 1 in 150 000).
void check_share(std::uint64_t count, std::uint64_t all, double law, double bias = 0.0) {
  CAPTURE(count);
  CAPTURE(all);
  CAPTURE(law);
  const double error = std::sqrt(law * (1.0 - law) / static_cast<double>(all));
  CHECK(std::abs(static_cast<double>(count) / static_cast<double>(all) - law) < 4.5 * error + bias);
}

GammaMatter lso_matter() { return {composition_of_formula("Lu2SiO5"), 7.4}; }

/// True when all deposits of an event are those of one interaction.
bool at_one_place(const Event& event) {
  return !event.deposits.empty() &&
         std::all_of(event.deposits.begin(), event.deposits.end(), [&](const Deposit& deposit) {
           return deposit.position == event.deposits.front().position;
         });
}

/// Energy deposited by the first interaction of an event.
double deposited_at_first_keV(const Event& event) {
  double sum = 0.0;
  for (const Deposit& deposit : event.deposits)
    if (deposit.position == event.deposits.front().position) sum += deposit.energy_keV;
  return sum;
}

}  // namespace

TEST_CASE("a narrow beam is attenuated as exp(-mu x)") {
  // Water 100 mm thick in the place of a crystal: at 1 MeV the Rayleigh share is below 1e-4.
  const Scene scene = scene_of(box_part("crystal", "LSO", {1000.0, 1000.0, 50.0}));
  const int events = 20000;
  const auto source = event_source(
      beam("1 MeV", events, "[[matter]]\npart = \"crystal\"\nformula = \"H2O\"\ndensity = \"2 g/cm3\""),
      scene);
  std::uint64_t through = 0;
  for (int i = 0; i < events; ++i)
    if (make_event(*source, scene, static_cast<std::uint64_t>(i)).deposits.empty()) ++through;
  const GammaMatter water(composition_of_formula("H2O"), 2.0);
  check_share(through, events, std::exp(-50.0 * water.total_per_mm(1000.0)), 1e-4);
}

TEST_CASE("in a speck the photofraction is the ratio of cross sections, and the Compton edge is sharp") {
  // A cube of 0.1 mm: a scattered gamma interacts again with a chance below 0.01, which is the bias.
  const Scene scene = lso_cube(0.1);
  const int events = 300000;
  const auto source =
      event_source(gammas("511 keV", events, kNoFluorescence + "\ndirection = [0, 0, 1]"), scene);
  const double edge_keV = 511.0 * (1.0 - 1.0 / (1.0 + 2.0 * 511.0 / kElectronMass_keV));
  std::uint64_t seen = 0, full = 0;
  for (int i = 0; i < events; ++i) {
    const Event event = make_event(*source, scene, static_cast<std::uint64_t>(i));
    if (event.deposits.empty()) continue;
    ++seen;
    const double first_keV = deposited_at_first_keV(event);
    if (at_one_place(event) && event.escaped_keV == 0.0) ++full;
    CHECK((std::abs(first_keV - 511.0) < 1e-9 || first_keV <= edge_keV + 1e-9));
    // A photoelectron lacks the binding energy of the K shell, which is a deposit of its own, or is an outer
    // one.
    if (std::abs(first_keV - 511.0) < 1e-9 && event.deposits.size() > 1) {
      CHECK(event.deposits.size() == 2);
      CHECK(event.deposits[1].energy_keV < 63.4);
    }
  }
  CHECK(seen > 1000);
  const GammaMatter lso = lso_matter();
  const double photoelectric = lso.per_mm(GammaProcess::photoelectric, 511.0);
  check_share(full, seen, photoelectric / (photoelectric + lso.per_mm(GammaProcess::compton, 511.0)), 0.01);
}

TEST_CASE("K X-rays leave a speck as often as lutetium makes them") {
  const Scene scene = lso_cube(0.01);
  const int events = 60000;
  const auto source = event_source(gammas("100 keV", events, "direction = [0, 0, 1]"), scene);
  std::uint64_t absorbed = 0, escaped = 0;
  for (int i = 0; i < events; ++i) {
    const Event event = make_event(*source, scene, static_cast<std::uint64_t>(i));
    if (event.deposits.empty() || event.deposits[0].energy_keV < 30.0) continue;  // Compton: up to 28 keV
    ++absorbed;
    if (event.escaped_keV > 50.0 && event.escaped_keV < 64.0) ++escaped;
  }
  CHECK(absorbed > 500);
  const ElementData lutetium(71);
  const GammaMatter lso = lso_matter();
  const double by_lutetium = composition_of_formula("Lu2SiO5").back().mass_fraction * 0.74 *
                             lutetium.cross_section_cm2_per_g(GammaProcess::photoelectric, 100.0) /
                             lso.per_mm(GammaProcess::photoelectric, 100.0);
  CHECK(by_lutetium > 0.99);
  check_share(escaped, absorbed, by_lutetium * lutetium.k_shell().share * lutetium.k_shell().yield, 0.02);
}

TEST_CASE("energy is conserved in every event") {
  const Scene scene = scene_of(
      box_part("crystal", "LSO", {4.0, 4.0, 10.0}) +
          "[[part]]\nname = \"window\"\nbox = [\"4 mm\", \"4 mm\", \"2 mm\"]\nmedium = \"glass\"\nsurface = "
          "\"flat\"\nplace = { touch = \"crystal\", side = \"-z\" }\n"
          "[[part]]\nname = \"shield\"\nbox = [\"4 mm\", \"4 mm\", \"2 mm\"]\nmedium = \"opaque\"\nsurface = "
          "\"flat\"\nplace = { touch = \"window\", side = \"-z\" }\n",
      "air");
  std::uint64_t seen = 0, non_scintillating = 0, escaped = 0;
  for (const char* energy : {"30 keV", "88 keV", "511 keV", "1274.5 keV", "2.9 MeV"}) {
    const auto source = event_source(
        beam(energy, 2000, "[[matter]]\npart = \"shield\"\nformula = \"Pb\"\ndensity = \"11.35 g/cm3\""),
        scene);
    for (std::uint64_t i = 0; i < source->events(); ++i) {
      const Event event = make_event(*source, scene, i);
      CHECK(deposited_keV(event) + event.escaped_keV + event.non_scintillating_keV ==
            doctest::Approx(event.energy_keV).epsilon(1e-12));
      seen += event.deposits.empty() ? 0 : 1;
      non_scintillating += event.non_scintillating_keV > 0.0 ? 1 : 0;
      escaped += event.escaped_keV > 0.0 ? 1 : 0;
      for (const Deposit& deposit : event.deposits) {
        CHECK(scene.region_names[deposit.region] == "crystal");
        CHECK(std::abs(deposit.position.x()) <= 2.0 + 1e-6);
        CHECK(std::abs(deposit.position.z()) <= 5.0 + 1e-6);
        CHECK(deposit.time_ns >= 45.0 / kSpeedOfLight_mm_per_ns - 1e-9);
      }
    }
  }
  CHECK(seen > 500);
  CHECK(non_scintillating > 500);
  CHECK(escaped > 500);
}

TEST_CASE("pairs are made above their threshold, and one, two or no annihilation gammas escape") {
  const Scene scene = lso_cube(1.0);
  const auto source =
      event_source(gammas("3 MeV", 200000, "direction = [0, 0, 1]\n" + kNoFluorescence), scene);
  std::uint64_t both = 0, all = 0;
  for (std::uint64_t i = 0; i < source->events(); ++i) {
    const Event event = make_event(*source, scene, i);
    ++all;
    if (std::abs(event.escaped_keV - 2.0 * kElectronMass_keV) < 1e-6 && at_one_place(event)) ++both;
  }
  const GammaMatter lso = lso_matter();
  // Over 0.5 mm; annihilation gammas leave with a chance near exp(-0.087 x 0.6 mm) each.
  const double made = 1.0 - std::exp(-0.5 * lso.per_mm(GammaProcess::pair, 3000.0));
  const double share = static_cast<double>(both) / static_cast<double>(all);
  CHECK(share > 0.8 * made);
  CHECK(share < made);
}

TEST_CASE("a medium of unknown composition is named, unless the scene sets it") {
  const Scene scene =
      scene_of(box_part("crystal", "LSO", Vec3::Constant(2.0)) +
               "[[part]]\nname = \"tube\"\nbox = [\"2 mm\", \"2 mm\", \"1 mm\"]\nmedium = "
               "\"opaque\"\nsurface = \"flat\"\nplace = { touch = \"crystal\", side = \"-z\" }\n");
  const std::string plain = gammas("511 keV", 10, "direction = \"isotropic\"");
  CHECK(says(complaint([&] { event_source(plain, scene); }), "the medium \"opaque\" of \"tube\""));
  CHECK(event_source(plain + "vacuum = [\"tube\"]", scene)->events() == 10);
  CHECK(says(complaint([&] { event_source(plain + "vacuum = [\"tub\"]", scene); }), "did you mean"));
  CHECK(says(complaint([&] {
               event_source(plain + "[[matter]]\npart = \"tube\"\nformula = \"Pb\"\ndensity = \"0 g/cm3\"",
                            scene);
             }),
             "density must be positive"));
}

TEST_CASE("the composition of the ambient medium can be set") {
  // In lead all around, nothing of 100 keV comes through to the crystal.
  const Scene scene = lso_cube(2.0);
  const auto source = event_source(
      beam("100 keV", 200, "[[matter]]\npart = \"ambient\"\nformula = \"Pb\"\ndensity = \"11.35 g/cm3\""),
      scene);
  for (std::uint64_t i = 0; i < source->events(); ++i) CHECK(make_event(*source, scene, i).deposits.empty());
}
