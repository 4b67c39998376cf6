#include <cmath>

#include "database_helpers.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;

namespace {

SurfaceSpec with_base(const std::string& base, const std::string& rest) {
  return database_with(DefinitionKind::surface, "mine", "base = \"" + base + "\"\n" + rest).surface("mine");
}

const std::string kGround = "[unified]\nsigma_alpha = \"0.314 rad\"\nspike = 0\nlobe = 1\nbackscatter = 0\n";

}  // namespace

TEST_CASE("every shipped surface loads, or names the keys that the user has to set") {
  const MaterialDatabase& database = shipped_database();
  std::vector<std::string> incomplete;
  for (const std::string& name : database.names(DefinitionKind::surface)) {
    CAPTURE(name);
    try {
      const SurfaceSpec surface = database.surface(name, {"scene.toml", 3, 5});
      CHECK_FALSE(surface.sources.empty());
    } catch (const InputError& error) {
      REQUIRE(error.problems().size() == 1);
      CHECK(error.problems()[0].where.line == 3);
      CHECK(error.problems()[0].what.find("requires parameters that are not given") != std::string::npos);
      CHECK(error.problems()[0].hint.find("base = \"" + name + "\"") != std::string::npos);
      incomplete.push_back(name);
    }
  }
  CHECK(incomplete == std::vector<std::string>{"detect_metal", "detect_paint", "geant4_ground",
                                               "geant4_groundbackpainted", "geant4_groundfrontpainted",
                                               "geant4_polishedbackpainted", "geant4_polishedfrontpainted"});
}

TEST_CASE("Geant4's six finishes mean what they mean there") {
  CHECK(holds_microsurface<SmoothSurface>(shipped_database().surface("geant4_polished")));

  const auto ground = microsurface_of<FacetSurface>(with_base("geant4_ground", kGround));
  CHECK(ground.sigma_alpha_rad == doctest::Approx(0.314));
  CHECK(ground.definition == SigmaAlphaDefinition::solid_angle);
  CHECK(ground.sampling == FacetSampling::geant4);

  for (const auto& [name, share] :
       {std::pair{"geant4_polishedfrontpainted", 1.0}, std::pair{"geant4_groundfrontpainted", 0.0}}) {
    const SurfaceSpec surface = with_base(name, "reflectance = 0.9\n");
    CHECK(holds_microsurface<PaintedSurface>(surface));
    CHECK(surface.reflector->specular_share == share);
    CHECK(surface.reflector->reflectance(420.0) == 0.9);
  }
  for (const auto& [name, share] :
       {std::pair{"geant4_polishedbackpainted", 1.0}, std::pair{"geant4_groundbackpainted", 0.0}}) {
    const SurfaceSpec surface = with_base(name, "gap = 1.0\nreflectance = 0.97\n" + kGround);
    CHECK(holds_microsurface<FacetSurface>(surface));
    CHECK(surface.reflector->specular_share == share);
    CHECK(surface.gap_index(420.0) == 1.0);
  }
}

TEST_CASE("a number missing in a preset is named, at the definition that has to set it") {
  const MaterialDatabase database = database_with(
      DefinitionKind::surface, "mine", "base = \"geant4_groundbackpainted\"\ngap = 1.0\n" + kGround);
  const auto problems = problems_of([&] { database.surface("mine", {"scene.toml", 30, 1}); });
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].where.file == "scene.toml");
  CHECK(problems[0].where.line != 30);
  CHECK(problems[0].what.find("reflectance or reflector") != std::string::npos);
  CHECK(problems[0].what.find("gap") == std::string::npos);
}

TEST_CASE("DETECT's five finishes exist") {
  const MaterialDatabase& database = shipped_database();
  CHECK(holds_microsurface<SmoothSurface>(database.surface("detect_polish")));
  CHECK(holds_microsurface<SmoothSurface>(database.surface("detect_detect")));
  const auto ground = microsurface_of<FacetSurface>(database.surface("detect_ground"));
  CHECK(ground.lobe + ground.spike + ground.backscatter == 0.0);  // Lambertian only
  CHECK(with_base("detect_paint", "reflectance = 0.98\n").reflector->specular_share == 0.0);
  CHECK(with_base("detect_metal", "reflector = \"PTFE\"\n").reflector->specular_share == 1.0);
  CHECK(database.sensor("ideal").conversion_probability(420.0) == 1.0);
}

TEST_CASE("the paper's surfaces are the paper's") {
  const MaterialDatabase& database = shipped_database();
  for (const auto& [name, degrees] :
       {std::pair{"roncali2013_unified_rough", 18.0}, std::pair{"roncali2013_unified_polished", 1.2}}) {
    const auto by_solid_angle = microsurface_of<FacetSurface>(database.surface(name));
    const auto by_polar_angle = microsurface_of<FacetSurface>(database.surface(std::string(name) + "_polar"));
    CHECK(by_solid_angle.sigma_alpha_rad == doctest::Approx(degrees * kDegree));
    CHECK(by_polar_angle.sigma_alpha_rad == by_solid_angle.sigma_alpha_rad);
    CHECK(by_solid_angle.lobe == 1.0);
    CHECK(by_solid_angle.definition == SigmaAlphaDefinition::solid_angle);
    CHECK(by_polar_angle.definition == SigmaAlphaDefinition::polar_angle);
  }
  for (const char* name : {"lso_ground_30um_lambertian_097", "lso_polished_lambertian_097"}) {
    const SurfaceSpec surface = database.surface(name);
    CHECK(holds_microsurface<RecipeSpec>(surface));
    CHECK(surface.gap == "air");
    CHECK(surface.reflector->name == "lambertian_097");
    CHECK(surface.reflector->reflectance(420.0) == 0.97);
    CHECK(surface.sources.size() == 2);
  }
}
