// A surface model from outside: nothing of ScintRay knows it but the list that the caller passes.
#include "scintray/materials/surface_models.hpp"

#include "database_helpers.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene_file/read_scene.hpp"
#include "support/laws.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::test;

namespace {

/// A perforated mirror: reflects a share of the light, and lets the rest pass as it is.
class ToySurface : public MicrosurfaceModel {
 public:
  explicit ToySurface(double mirrored) : mirrored_(mirrored) {}
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair&,
                         SurfaceInteraction& interaction) const override {
    if (interaction.rng.uniform() >= mirrored_) return outcome_on(other(side));
    reflect(ray, interaction.normal);
    return outcome_on(side);
  }

 private:
  double mirrored_;
};

SurfaceModel toy_surface_model() {
  const auto read = [](const TomlTable& surface) {
    const TomlTable toy = surface.table("toy");
    const double mirrored = toy.quantity("mirrored", Dimension::dimensionless);
    toy.expect("mirrored", mirrored >= 0.0 && mirrored <= 1.0, "a share lies between 0 and 1");
    return FixedMicrosurface(ToySurface(mirrored));
  };
  return {.word = "toy", .table = "toy", .read = read};
}

DefinitionModels with_toy_surface() {
  DefinitionModels models;
  models.surfaces.add(toy_surface_model());
  return models;
}

const std::string kPerforated = "model = \"toy\"\ntoy = { mirrored = \"30 %\" }\n";

MaterialDatabase with_surface(const std::string& text) {
  MaterialDatabase database({source_file("materials")}, with_toy_surface());
  database.add(DefinitionKind::surface, {{"mine", parse_toml(text, "scene.toml")}});
  return database;
}

Surface between_lso_and_air(const MaterialDatabase& database, const SurfaceSpec& spec) {
  return SurfaceFactory()
      .make(spec, database.medium("LSO"), database.medium("air"), 420.0, 420.0, 420.0)
      .surface;
}

constexpr std::uint64_t kToyRays = 100'000;

/// Share of light from inside, 60 deg from the normal, that an interaction has a given outcome for.
Estimate share_of(const Surface& surface, SurfaceOutcome wanted) {
  std::uint64_t count = 0;
  for (std::uint64_t k = 0; k < kToyRays; ++k) {
    Rng rng(1, StreamKind::other, k);
    Ray ray{Vec3(std::sqrt(0.75), 0.0, 0.5), Vec3::Zero()};
    count += surface.interact(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, 420.0, rng) == wanted;
  }
  return binomial_estimate(count, kToyRays);
}

}  // namespace

TEST_CASE("A surface model from outside scatters light as a definition names it") {
  const MaterialDatabase database = with_surface(kPerforated);
  const SurfaceSpec& spec = database.surface("mine");
  CHECK(database.outline("mine").model == "toy");
  const Surface surface = between_lso_and_air(database, spec);
  CHECK_FALSE(surface.plain());
  CHECK_FALSE(surface.opaque());
  check_law("reflected", share_of(surface, SurfaceOutcome::inside), {0.3, 0.0});
  check_law("transmitted", share_of(surface, SurfaceOutcome::outside), {0.7, 0.0});
}

TEST_CASE("Law of passes between a surface model from outside and the reflector behind its gap") {
  // Absorbed (1 - m) (1 - r) (1 + m r + ...), m the model's reflectance, r the mirror's.
  const MaterialDatabase database =
      with_surface(kPerforated + "gap = \"air\"\nreflectance = 0.8\nspecular_share = 1.0\n");
  const Surface surface = between_lso_and_air(database, database.surface("mine"));
  CHECK(surface.opaque());
  check_law("absorbed", share_of(surface, SurfaceOutcome::absorbed), {0.7 * 0.2 / (1.0 - 0.3 * 0.8), 0.0});
}

TEST_CASE("A surface model from outside obeys the rules of definitions") {
  CHECK(reports(
      problems_of([&] { database_with(DefinitionKind::surface, "mine", kPerforated).surface("mine"); }), 1,
      "\"toy\""));
  CHECK(
      reports(problems_of([] { with_surface("model = \"toy\"\ntoy = { mirrored = 3 }\n").surface("mine"); }),
              2, "between 0 and 1"));
  CHECK(reports(problems_of([] { with_surface(kPerforated + "smoth = 1\n").surface("mine"); }), 3, "smoth"));

  // A model of one's own drops the base's table of another model.
  MaterialDatabase database = with_surface(kPerforated);
  database.add(DefinitionKind::surface,
               {{"flat", parse_toml("base = \"mine\"\nmodel = \"smooth\"\n", "scene.toml")},
                {"denser", parse_toml("base = \"mine\"\ntoy = { mirrored = 0.9 }\n", "scene.toml")}});
  CHECK(holds_microsurface<SmoothSurface>(database.surface("flat")));
  check_law("reflected",
            share_of(between_lso_and_air(database, database.surface("denser")), SurfaceOutcome::inside),
            {0.9, 0.0});

  SurfaceModels models;
  models.add(toy_surface_model());
  CHECK_THROWS_AS(models.add(toy_surface_model()), InternalError);
  CHECK_THROWS_AS(models.add({.word = "none", .table = "", .read = nullptr}), InternalError);
}

TEST_CASE("A scene file names a surface model from outside") {
  const auto spec = scene_file::SceneFile::from_text(R"(
ambient = "air"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "4 mm"]
medium = "LSO"
surface = "perforated"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "420 nm"
photons = 1
[surfaces.perforated]
)" + kPerforated,
                                                     source_file("scene.toml").string())
                        .spec(0);
  const scene::Scene scene = scene::SceneBuilder({}, with_toy_surface()).build(spec).scene;
  REQUIRE(scene.surfaces.size() == 1);
  check_law("reflected", share_of(scene.surfaces.front(), SurfaceOutcome::inside), {0.3, 0.0});
}
