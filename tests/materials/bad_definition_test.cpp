#include "database_helpers.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::materials;

namespace {

std::vector<Problem> medium_problems(const std::string& text) {
  const MaterialDatabase database = database_with(DefinitionKind::medium, "mine", text);
  return problems_of([&] { database.medium("mine"); });
}

const std::string kPlain = R"([absorption]
none = true
[scattering]
none = true
[index]
)";

const std::string kScintillator = kPlain + R"(n = 1.8
[yield]
value = "25 1/keV"
[emission]
spectrum = { wavelength = [400, 450], wavelength_unit = "nm", value = [1, 2] }
)";

}  // namespace

TEST_CASE("an unknown name is reported where it is used, with the nearest one and the folders searched") {
  const auto problems = problems_of([] {
    shipped_database().medium("LSO_roncali2103", {"scene.toml", 7, 3});
  });
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].where.line == 7);
  CHECK(problems[0].hint.find("did you mean \"LSO_roncali2013\"") != std::string::npos);
  CHECK(problems[0].hint.find("BGO") != std::string::npos);
  CHECK(problems[0].hint.find("materials/media") != std::string::npos);
  CHECK(reports(problems_of([] {
                  shipped_database().surface("polish", {"scene.toml", 1, 1});
                }),
                1, "polished"));
  CHECK(reports(problems_of([] { shipped_database().sensor("R6232", {"s", 1, 1}); }), 1, "R6231"));
  CHECK(reports(problems_of([] { shipped_database().reflector("PTFEE", {"s", 1, 1}); }), 1, "PTFE"));
}

TEST_CASE("a name cannot leave the folders of the database") {
  CHECK(reports(problems_of([] { shipped_database().medium("../media/LSO"); }), 0, "there is no medium"));
}

TEST_CASE("a folder that does not exist is reported") {
  CHECK(reports(problems_of([] { MaterialDatabase({"no/such/folder"}); }), 0, "no/such/folder"));
}

TEST_CASE("a database file without a source is refused, block by block; a scene's own is not") {
  const std::string text = kPlain + "n = 1.5\n";
  const TemporaryDatabase files("sources");
  files.write("media/mine.toml", text);
  const MaterialDatabase database({files.folder()});
  const auto problems = problems_of([&] { database.medium("mine"); });
  CHECK(problems.size() == 3);
  CHECK(reports(problems, 1, "[absorption] does not say where its numbers were published"));
  CHECK(reports(problems, 3, "[scattering]"));
  CHECK(reports(problems, 5, "[index]"));
  CHECK(database_with(DefinitionKind::medium, "mine", text).medium("mine").index(420.0) == 1.5);

  files.write("surfaces/mine.toml", "model = \"smooth\"\n");
  CHECK(reports(problems_of([&] { MaterialDatabase({files.folder()}).surface("mine"); }), 0, "source"));
}

TEST_CASE("a medium must have an index, an absorption and a scattering") {
  const auto problems = medium_problems("[density]\nvalue = \"2 g/cm3\"\n");
  CHECK(reports(problems, 0, "\"index\""));
  CHECK(reports(problems, 0, "\"absorption\""));
  CHECK(reports(problems, 0, "\"scattering\""));
}

TEST_CASE("unknown keys, unsorted tables, negative numbers and missing units are located") {
  CHECK(reports(medium_problems(kPlain + "n = 1.5\ncolor = \"red\"\n"), 7, "color"));
  CHECK(reports(
      medium_problems(kPlain +
                      "n = { wavelength = [400, 420, 410], wavelength_unit = \"nm\", value = [2, 2, 2] }\n"),
      6, "not in order"));
  CHECK(reports(medium_problems(kPlain + "n = 0.5\n"), 6, "between 1 and 5"));
  CHECK(reports(
      medium_problems(kPlain + "n = 1.5\nsellmeier = { b = [1.0], c_um2 = [0.01], range = [\"350 nm\", \"700 "
                               "nm\"] }\n"),
      7, "only one of"));
  CHECK(reports(medium_problems("[index]\nn = 1.5\n[scattering]\nnone = true\n[absorption]\nlength = 300\n"),
                6, "with its unit"));
  CHECK(reports(
      medium_problems("[index]\nn = 1.5\n[scattering]\nnone = true\n[absorption]\nlength = \"-3 mm\"\n"), 6,
      "must be positive"));
  CHECK(reports(
      medium_problems("[index]\nn = 1.5\n[scattering]\nlength = \"3 mm\"\n[absorption]\nnone = true\n"), 0,
      "\"kind\""));
  CHECK(reports(medium_problems("[index]\nn = 1.5\n[scattering]\nnone = true\n[absorption]\nnone = false\n"),
                6, "can only be true"));
}

TEST_CASE("a dispersion formula that fails in its range is refused") {
  // The pole of c = 0.2 um^2 lies at 447 nm.
  CHECK(reports(medium_problems(
                    kPlain + "sellmeier = { b = [1.0], c_um2 = [0.2], range = [\"350 nm\", \"700 nm\"] }\n"),
                0, "refractive index"));
  CHECK(reports(
      medium_problems(kPlain +
                      "sellmeier = { b = [1.0, 2.0], c_um2 = [0.01], range = [\"350 nm\", \"700 nm\"] }\n"),
      0, "c_um2"));
  CHECK(reports(medium_problems(kPlain + "cauchy = { a = [1.5], range = [\"700 nm\", \"350 nm\"] }\n"), 6,
                "range"));
  // Two metres, in steps of a nanometre.
  CHECK(reports(medium_problems(kPlain + "cauchy = { a = [1.5], range = [\"310 nm\", \"2147483647 nm\"] }\n"),
                6, "far beyond the light"));
}

TEST_CASE("scintillation is complete or absent") {
  CHECK(reports(medium_problems(kScintillator), 0, "\"decay\""));
  CHECK(reports(
      medium_problems(kScintillator + "[[decay]]\ntime = \"40 ns\"\nrise = \"0 ns\"\nfraction = 0.5\n"), 0,
      "sum to 0.5"));
  CHECK(reports(
      medium_problems(kScintillator + "[[decay]]\ntime = \"-40 ns\"\nrise = \"0 ns\"\nfraction = 1\n"), 12,
      "must be positive"));
  CHECK(reports(medium_problems(
                    kPlain + "n = 1.8\n[yield]\nvalue = \"25 1/keV\"\n[emission]\nspectrum = 1.0\n[[decay]]\n"
                             "time = \"40 ns\"\nrise = \"0 ns\"\nfraction = 1\n"),
                10, "needs wavelengths"));
  CHECK(reports(
      medium_problems(kPlain + "n = 1.8\n[yield]\nvalue = \"0 1/keV\"\n[emission]\nspectrum = { wavelength = "
                               "[400, 450], wavelength_unit = \"nm\", value = [0, -1] }\n"),
      0, "cannot be negative"));
}

TEST_CASE("wavelength shifting is complete, absorbs, and re-emits no more than it absorbs") {
  const std::string start = kPlain + "n = 1.5\n[wavelength_shifting]\n";
  const std::string absorption = "absorption = { length = \"1 mm\" }\n";
  const std::string emission =
      "emission = { spectrum = { wavelength = [480, 560], wavelength_unit = \"nm\", value = [1, 1] } }\n";
  const std::string decay = "decay = [{ time = \"8 ns\", rise = \"0 ns\", fraction = 1 }]\n";
  const std::string yield = "quantum_yield = { value = 0.9 }\n";
  CHECK(database_with(DefinitionKind::medium, "mine", start + absorption + yield + emission + decay)
            .medium("mine")
            .shifter->fluorophores()
            .front()
            .quantum_yield(500.0) == 0.9);
  const auto missing = medium_problems(start);
  CHECK(missing.size() == 4);
  for (const char* key : {"has no \"absorption\"", "has no \"quantum_yield\"", "has no \"emission\"",
                          "does not say when it gives light back"}) {
    CAPTURE(key);
    CHECK(std::any_of(missing.begin(), missing.end(), [&](const Problem& problem) {
      return (problem.what + problem.hint).find(key) != std::string::npos;
    }));
  }
  CHECK(reports(medium_problems(start + absorption + "quantum_yield = { value = 1.2 }\n" + emission + decay),
                9, "a quantum yield lies between 0 and 1"));
  CHECK(reports(medium_problems(start + "absorption = { none = true }\n" + yield + emission + decay), 8,
                "absorbs nothing"));
  CHECK(
      reports(medium_problems(start + absorption + yield +
                              "emission = { spectrum = { wavelength = [480, 560], wavelength_unit = \"nm\", "
                              "value = [0, 0] } }\n" +
                              decay),
              10, "zero everywhere"));
}

TEST_CASE("efficiencies and reflectances stay below one") {
  const auto sensor_problems = [](const std::string& text) {
    const MaterialDatabase database = database_with(DefinitionKind::sensor, "mine", text);
    return problems_of([&] { database.sensor("mine"); });
  };
  CHECK(reports(
      sensor_problems("[window]\nindex = 1.5\n[efficiency]\nvalue = 1.2\ndefinition = \"internal\"\n"), 4,
      "between 0 and 1"));
  CHECK(reports(sensor_problems("[window]\nindex = 1.5\n[efficiency]\nvalue = 0.3\n"), 0, "\"definition\""));
  CHECK(reports(
      sensor_problems("[window]\nindex = 1.5\n[efficiency]\nvalue = 0.3\ndefinition = \"external\"\n"), 0,
      "\"reference_index\""));
  CHECK(
      reports(sensor_problems("[window]\nindex = 3.0\n[efficiency]\nvalue = 0.8\ndefinition = \"external\"\n"
                              "reference_index = 1.0\n"),
              4, "above what the window lets in"));
  const MaterialDatabase database =
      database_with(DefinitionKind::reflector, "mine",
                    "[reflectance]\nvalue = \"110 %\"\n[direction]\nspecular_share = 2\n");
  const auto problems = problems_of([&] { database.reflector("mine"); });
  CHECK(reports(problems, 2, "between 0 and 1"));
  CHECK(reports(problems, 4, "between 0 and 1"));
}

TEST_CASE("a reflector reflects and transmits no more than is incident, and has a published source") {
  const std::string text =
      "[reflectance]\nvalue = 0.95\n[transmittance]\nvalue = \"6 %\"\n[direction]\nspecular_share = 0\n";
  const MaterialDatabase database = database_with(DefinitionKind::reflector, "mine", text);
  CHECK(reports(problems_of([&] { database.reflector("mine"); }), 4, "come to 1.01; together"));

  const TemporaryDatabase files("transmittance");
  files.write("reflectors/mine.toml", text);
  CHECK(reports(problems_of([&] { MaterialDatabase({files.folder()}).reflector("mine"); }), 3,
                "[transmittance] does not say where its numbers were published"));
}
