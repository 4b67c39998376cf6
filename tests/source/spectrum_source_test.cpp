#include "scintray/source/detail/event_sources.hpp"

#include <fstream>

#include "event_scene.hpp"
#include "scintray/core/statistics.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

std::string with_file(const std::string& csv) {
  const std::filesystem::path file = scratch_folder("gamma_spectrum") / "spectrum.csv";
  std::ofstream(file) << csv;
  return "type = \"gamma_events\"\nevents = 5\nregion = { part = \"crystal\" }\nspectrum = { file = \"" +
         file.string() + "\", energy_unit = \"keV\" }\n";
}

}  // namespace

TEST_CASE("one energy is put where the region says") {
  const Scene scene = lso_cube(10.0);
  const auto source = event_source(
      "type = \"gamma_events\"\nevents = 300\nenergy = \"511 keV\"\n"
      "region = { part = \"crystal\", slab_z = [\"1 mm\", \"2 mm\"] }",
      scene);
  CHECK(source->events() == 300);
  for (std::uint64_t i = 0; i < source->events(); ++i) {
    const Event event = make_event(*source, scene, i);
    REQUIRE(event.deposits.size() == 1);
    CHECK(event.energy_keV == 511.0);
    CHECK(event.deposits[0].energy_keV == 511.0);
    CHECK(event.deposits[0].position.z() >= 1.0);
    CHECK(event.deposits[0].position.z() <= 2.0);
    CHECK(scene.region_names[event.deposits[0].region] == "crystal");
  }
}

TEST_CASE("energies follow the spectrum") {
  // Triangular from 100 to 400 keV, peak at 400: p(E) ~ E - 100, mean 300. Chance of a false alarm 1e-4.
  const Scene scene = lso_cube(10.0);
  const auto source = event_source(with_file("energy,counts\n100,0\n400,30\n"), scene);
  std::vector<std::uint64_t> observed(10, 0);
  std::vector<double> expected;
  constexpr int kEvents = 20000;
  for (std::uint64_t i = 0; i < kEvents; ++i) {
    const double energy_keV = make_event(*source, scene, i).energy_keV;
    ++observed[std::min<std::size_t>(9, static_cast<std::size_t>((energy_keV - 100.0) / 30.0))];
  }
  for (int bin = 0; bin < 10; ++bin) expected.push_back(kEvents * (2.0 * bin + 1.0) / 100.0);
  CHECK(chi_square_test(observed, expected).p_value > 1e-4);
}

TEST_CASE("the shipped spectrum has its photopeak at 511 keV, 22 % wide") {
  const GammaSpec spec = gamma_spec(
      "type = \"gamma_events\"\nevents = 1\nregion = { part = \"crystal\" }\n"
      "spectrum = { file = \"scenes/spectra/lso_511keV.csv\", energy_unit = \"keV\" }");
  const Curve& spectrum = std::get<SpectrumSpec>(spec.kind).spectrum;
  double peak_keV = 400.0;
  for (double e = 400.0; e < 700.0; e += 1.0)
    if (spectrum(e) > spectrum(peak_keV)) peak_keV = e;
  CHECK(std::abs(peak_keV - 511.0) <= 10.0);
  // Well above the peak neither Compton events nor those that lost a K X-ray contribute: a normal tail.
  const double squares = (std::pow(645.0 - 511.0, 2) - std::pow(585.0 - 511.0, 2)) / 2.0;
  const double sigma_keV = std::sqrt(squares / std::log(spectrum(585.0) / spectrum(645.0)));
  CHECK(2.354820 * sigma_keV == doctest::Approx(0.22 * 511.0).epsilon(0.02));
}

TEST_CASE("spectra that are none are refused") {
  CHECK(says(complaint([] { gamma_spec(with_file("100,1\n200,-2\n")); }), "negative"));
  CHECK(says(complaint([] { gamma_spec(with_file("100,0\n200,0\n")); }), "zero everywhere"));
  CHECK(says(complaint([] { gamma_spec(with_file("100,1\n300,1\n200,1\n")); }), "spectrum.csv"));
  CHECK(says(complaint([] { gamma_spec(with_file("-100,1\n300,1\n")); }), "energies lie between"));
  CHECK(says(complaint([] { gamma_spec(with_file("100,1\n3e9,1\n")); }), "check energy_unit"));
  const std::string place = "type = \"gamma_events\"\nevents = 5\nregion = { part = \"crystal\" }\n";
  CHECK(says(complaint([&] { gamma_spec(place); }), "energy"));
  CHECK(says(complaint([&] { gamma_spec(place + "energy = \"0 keV\""); }), "above 0"));
  CHECK(says(complaint([&] { gamma_spec(place + "energy = 511"); }), "keV"));
}

TEST_CASE("energy is put only where it makes light") {
  const Scene scene = scene_of(box_part("block", "glass", Vec3::Constant(5.0)));
  CHECK(says(complaint([&] {
               event_source(
                   "type = \"gamma_events\"\nevents = 1\nenergy = \"1 keV\"\n"
                   "region = { part = \"block\" }",
                   scene);
             }),
             "\"block\" does not scintillate"));
}
