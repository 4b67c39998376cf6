#include "scintray/optics/composition.hpp"

#include "event_scene.hpp"
#include "scintray/materials/database.hpp"

using namespace scintray;
using namespace scintray::config;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::test;

namespace {

double share_of(const Composition& composition, int atomic_number) {
  for (const ElementShare& share : composition)
    if (share.atomic_number == atomic_number) return share.mass_fraction;
  return 0.0;
}

std::string medium_complaint(const std::string& composition) {
  return complaint([&] {
    MaterialDatabase database = MaterialDatabase::shipped();
    database.add(DefinitionKind::medium, {{"thing", parse_toml(R"(
index = { n = 1.5 }
absorption = { none = true }
scattering = { none = true }
)" + composition,
                                                               "scene.toml")}});
    database.medium("thing");
  });
}

}  // namespace

TEST_CASE("a formula is converted to mass fractions") {
  // Standard atomic weights (IUPAC 2021): Lu 174.967, Si 28.085, O 15.999; Lu2SiO5 weighs 458.01.
  const Composition lso = composition_of_formula("Lu2SiO5");
  CHECK(share_of(lso, 71) == doctest::Approx(0.76403).epsilon(1e-3));
  CHECK(share_of(lso, 14) == doctest::Approx(0.06132).epsilon(1e-3));
  CHECK(share_of(lso, 8) == doctest::Approx(0.17465).epsilon(1e-3));
  CHECK(share_of(composition_of_formula("Lu1.8Y0.2SiO5"), 39) == doctest::Approx(0.0404).epsilon(5e-3));
  CHECK(element_symbol(71) == "Lu");
}

TEST_CASE("what is not a composition is refused with its reason") {
  CHECK(says(complaint([] { composition_of_formula("Lu2Xx"); }), "is not a chemical formula"));
  CHECK(says(complaint([] { composition_of_formula(""); }), "is not a chemical formula"));
  CHECK(says(complaint([] { composition_of_formula("PuO2"); }), "Pu"));
  const std::string text = complaint([] { composition_of_mass_fractions({{"Qq", 0.5}, {"H", -1.0}}); });
  CHECK(says(text, "\"Qq\" is not the symbol"));
  CHECK(says(text, "mass fraction of H is -1"));
  CHECK(says(complaint([] { composition_of_mass_fractions({{"H", 0.2}, {"O", 0.7}}); }), "sum to 0.9"));
}

TEST_CASE("a medium's composition is read, and faults have their place") {
  CHECK(says(medium_complaint("composition = { formula = \"Lu2SiO5\" }"), "needs its density"));
  CHECK(says(medium_complaint("density = { value = \"1 g/cm3\" }\ncomposition = { formula = \"lu2\" }"),
             "scene.toml:6"));
  CHECK(says(medium_complaint("composition = { none = false }"), "can only be true"));
  CHECK(says(medium_complaint("composition = { }"), "formula"));
}

TEST_CASE("every shipped medium has a composition") {
  const MaterialDatabase database = MaterialDatabase::shipped();
  for (const std::string& name : database.names(DefinitionKind::medium)) {
    CAPTURE(name);
    const Medium medium = database.medium(name);
    CHECK(medium.empty_space == (name == "vacuum"));
    if (medium.empty_space) continue;
    REQUIRE(!medium.composition.empty());
    CHECK(medium.density_g_per_cm3 > 0.0);
    double sum = 0.0;
    for (const ElementShare& share : medium.composition) sum += share.mass_fraction;
    CHECK(sum == doctest::Approx(1.0).epsilon(1e-12));
  }
}
