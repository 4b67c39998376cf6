#include "database_helpers.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::config;
using namespace scintray::optics;
using namespace scintray::topography;
using namespace scintray::materials;

namespace {

SurfaceSpec surface_of(const std::string& text) {
  return database_with(DefinitionKind::surface, "mine", text).surface("mine");
}

std::vector<Problem> surface_problems(const std::string& text) {
  const MaterialDatabase database = database_with(DefinitionKind::surface, "mine", text);
  return problems_of([&] { database.surface("mine"); });
}

const std::string kUnified = R"(model = "unified"
[unified]
sigma_alpha = "18 deg"
definition = "polar_angle"
facets = "projected_area"
lobe = 0.7
spike = 0.2
)";

}  // namespace

TEST_CASE("a UNIFIED surface is read with its unit and its definition") {
  const SurfaceSpec surface = surface_of(kUnified);
  const auto unified = microsurface_of<FacetSurface>(surface);
  CHECK(unified.sigma_alpha_rad == doctest::Approx(18.0 * kDegree));
  CHECK(unified.definition == SigmaAlphaDefinition::polar_angle);
  CHECK(unified.sampling == FacetSampling::projected_area);
  CHECK(unified.lobe == 0.7);
  CHECK(unified.spike == 0.2);
  CHECK(unified.backscatter == 0.0);
  CHECK_FALSE(surface.reflector);
}

TEST_CASE("sigma_alpha needs its unit, its definition, and the weighting of facets") {
  const std::string head = "model = \"unified\"\n[unified]\nlobe = 1\n";
  CHECK(reports(
      surface_problems(head + "sigma_alpha = 0.3\ndefinition = \"solid_angle\"\nfacets = \"geant4\"\n"), 4,
      "with its unit"));
  CHECK(reports(surface_problems(head + "sigma_alpha = \"18 deg\"\nfacets = \"geant4\"\n"), 0,
                "\"definition\""));
  CHECK(reports(surface_problems(head + "sigma_alpha = \"18 deg\"\ndefinition = \"solid_angle\"\n"), 0,
                "\"facets\""));
  CHECK(reports(
      surface_problems(head + "sigma_alpha = \"18 deg\"\ndefinition = \"solid\"\nfacets = \"geant4\"\n"), 5,
      "solid_angle"));
  CHECK(reports(surface_problems(
                    head + "sigma_alpha = \"90 deg\"\ndefinition = \"solid_angle\"\nfacets = \"geant4\"\n"),
                4, "between 0 and 90 deg"));
  CHECK(reports(surface_problems(kUnified + "backscatter = 0.2\n"), 0, "above 1"));
}

TEST_CASE("a stack has a gap and a reflector together, and paint has no gap") {
  const SurfaceSpec surface =
      surface_of("model = \"smooth\"\ngap = \"optical_grease\"\nreflector = \"ESR\"\n");
  CHECK(surface.gap == "optical_grease");
  CHECK(surface.gap_index(420.0) == 1.465);
  REQUIRE(surface.reflector);
  CHECK(surface.reflector->name == "ESR");
  CHECK(surface.reflector->specular_share == 1.0);

  const SurfaceSpec mixed =
      surface_of("model = \"smooth\"\ngap = 1.4\nreflectance = 0.95\nspecular_share = \"30 %\"\n");
  CHECK(mixed.gap_index(420.0) == 1.4);
  CHECK(mixed.reflector->reflectance(420.0) == 0.95);
  CHECK(mixed.reflector->specular_share == doctest::Approx(0.3));
  const SurfaceSpec overridden =
      surface_of("model = \"smooth\"\ngap = \"air\"\nreflector = \"ESR\"\nspecular_share = 0.9\n");
  CHECK(overridden.reflector->specular_share == 0.9);

  CHECK(reports(surface_problems("model = \"smooth\"\nreflector = \"ESR\"\n"), 0, "without the gap"));
  CHECK(reports(surface_problems("model = \"smooth\"\ngap = \"calcite\"\nreflector = \"ESR\"\n"), 2,
                "birefringent"));
  CHECK(reports(surface_problems("model = \"smooth\"\ngap = \"air\"\n"), 2, "without a reflector"));
  CHECK(reports(surface_problems("model = \"painted\"\n"), 0, "no reflector"));
  CHECK(reports(surface_problems("model = \"painted\"\ngap = \"air\"\nreflector = \"ESR\"\n"), 2,
                "paint lies on"));
  CHECK(reports(surface_problems("model = \"smooth\"\ngap = \"aire\"\nreflector = \"ERS\"\n"), 2, "\"air\""));
  CHECK(reports(surface_problems("model = \"smooth\"\ngap = \"air\"\nreflector = \"ERS\"\n"), 3, "\"ESR\""));
  CHECK(reports(surface_problems("model = \"smooth\"\ngap = 0.9\nreflector = \"ESR\"\n"), 2,
                "between 1 and 5"));
  CHECK(reports(surface_problems("model = \"smooth\"\ngap = \"air\"\nreflectance = 0.9\n"), 0,
                "specular_share"));
  CHECK(reports(surface_problems("model = \"smooth\"\nspecular_share = 0.9\n"), 2, "no meaning"));
}

TEST_CASE("a reflector may transmit light, its own share or one that the surface sets") {
  const SurfaceSpec own =
      surface_of("model = \"painted\"\nreflectance = 0.9\ntransmittance = \"6 %\"\nspecular_share = 0\n");
  REQUIRE(own.reflector->transmittance);
  CHECK((*own.reflector->transmittance)(420.0) == doctest::Approx(0.06));
  CHECK_FALSE(own.face_of_sheet);
  const SurfaceSpec named =
      surface_of("model = \"smooth\"\ngap = \"air\"\nreflector = \"lambertian_097\"\ntransmittance = 0.02\n");
  CHECK((*named.reflector->transmittance)(420.0) == 0.02);
  CHECK_FALSE(surface_of("model = \"painted\"\nreflector = \"lambertian_097\"\n").reflector->transmittance);
  CHECK_FALSE(surface_of("model = \"painted\"\nreflector = \"lambertian_097\"\ntransmittance = 0\n")
                  .reflector->transmittance);

  const std::string paint = "model = \"painted\"\nspecular_share = 0\nreflectance = ";
  CHECK(reports(surface_problems(paint + "0.9\ntransmittance = 0.2\n"), 4, "come to 1.1; together"));
  CHECK(reports(surface_problems(paint + "0.9\ntransmittance = 1.2\n"), 4, "between 0 and 1"));
  CHECK(reports(surface_problems(paint + "{ wavelength = [400, 500], wavelength_unit = \"nm\", value = [0.5, "
                                         "0.99] }\ntransmittance = 0.05\n"),
                4, "come to 1.04"));
  CHECK(reports(surface_problems("model = \"smooth\"\ntransmittance = 0.1\n"), 2, "no meaning"));
  // What a base's sheet lets through goes with that sheet.
  CHECK_FALSE(
      surface_of("base = \"polished_lambertian_097\"\nreflector = \"ESR\"\n").reflector->transmittance);
}

TEST_CASE("a face of a sheet is painted, and has its share of the sheet") {
  const SurfaceSpec face = surface_of(
      "model = \"painted\"\nreflectance = 0.8\ntransmittance = 0.2\nspecular_share = 0\nface_of_sheet = "
      "true\n");
  CHECK(face.face_of_sheet);
  CHECK(face.reflector->reflectance(420.0) == doctest::Approx(0.8 / 1.2));
  CHECK(reports(
      surface_problems("model = \"smooth\"\ngap = \"air\"\nreflector = \"ESR\"\nface_of_sheet = true\n"), 4,
      "only a painted surface"));
  MaterialDatabase database =
      database_with(DefinitionKind::reflector, "volume",
                    "[reflectance]\nvalue = 0.9\n[transmittance]\nvalue = 0.05\n[direction]\n"
                    "specular_share = 0\n[volume]\nindex = 1.35\n");
  database.add(DefinitionKind::surface,
               {{"mine", parse_toml("model = \"painted\"\nreflector = \"volume\"\nface_of_sheet = "
                                    "true\n",
                                    "scene.toml")}});
  CHECK(reports(problems_of([&] { database.surface("mine"); }), 3, "volume-like"));
}

TEST_CASE("a gap whose medium shifts wavelengths needs a thickness") {
  MaterialDatabase database = database_with(DefinitionKind::medium, "dye", R"(
index = { n = 1.5 }
absorption = { length = "3 mm" }
scattering = { none = true }
[wavelength_shifting]
absorption = { length = "1 mm" }
quantum_yield = { value = 0.9 }
emission = { spectrum = { wavelength = [480, 560], wavelength_unit = "nm", value = [1, 1] } }
decay = [{ time = "8 ns", rise = "0 ns", fraction = 1 }]
)");
  const std::string text = "model = \"smooth\"\ngap = \"dye\"\nreflector = \"ESR\"\n";
  database.add(DefinitionKind::surface,
               {{"thin", parse_toml(text, "scene.toml")},
                {"thick", parse_toml(text + "gap_thickness = \"5 um\"\n", "scene.toml")}});
  CHECK(reports(problems_of([&] { database.surface("thin"); }), 2, "without a thickness absorbs nothing"));
  const SurfaceSpec thick = database.surface("thick");
  REQUIRE(thick.gap_shifter);
  CHECK(thick.gap_absorption_per_mm(500.0) == doctest::Approx(1.0 / 3.0));  // the shifter's is its own
  CHECK(thick.gap_shifter->absorption_per_mm()(500.0) == 1.0);
}

TEST_CASE("tables of another model are refused, not ignored") {
  CHECK(reports(surface_problems("model = \"smooth\"\n[unified]\nlobe = 1\n"), 2, "unified"));
  CHECK(reports(surface_problems("model = \"smooth\"\n[tracing]\nmode = \"table\"\n"), 2, "tracing"));
  CHECK(reports(surface_problems("model = \"smoth\"\n"), 1, "smooth"));
  CHECK(reports(surface_problems("gap = \"air\"\n"), 0, "\"model\""));
}

TEST_CASE("a base has the keys that the derived surface does not set") {
  const SurfaceSpec surface =
      surface_of("base = \"roncali2013_unified_rough\"\n[unified]\nsigma_alpha = \"5 deg\"\n");
  const auto unified = microsurface_of<FacetSurface>(surface);
  CHECK(unified.sigma_alpha_rad == doctest::Approx(5.0 * kDegree));
  CHECK(unified.lobe == 1.0);
  CHECK(surface.name == "mine");
  CHECK(surface.sources.size() == 1);  // the base's

  const SurfaceSpec other = surface_of("base = \"roncali2013_unified_rough\"\nmodel = \"smooth\"\n");
  CHECK(holds_microsurface<SmoothSurface>(other));
  const SurfaceSpec repainted =
      surface_of("base = \"polished_lambertian_097\"\nreflectance = 0.5\nspecular_share = 0\n");
  CHECK(repainted.reflector->reflectance(420.0) == 0.5);
}

TEST_CASE("mistakes in a base and in the derived surface have their own places") {
  CHECK(reports(surface_problems("base = \"polish\"\n"), 1, "polished"));
  CHECK(reports(surface_problems("base = \"mine\"\n"), 1, "based on itself"));
  CHECK(reports(surface_problems("base = \"polished\"\nrough = true\n"), 2, "rough"));
}

TEST_CASE("height maps and recipes are traced as a table unless set otherwise") {
  const TemporaryDatabase files("maps");
  files.write("map.txt", "0 1\n1 0\n");
  MaterialDatabase database = shipped_database();
  const auto add = [&](const std::string& text) {
    database.add(DefinitionKind::surface,
                 {{"mine", parse_toml(text, (files.folder() / "scene.toml").string())}});
  };
  add("model = \"height_map\"\n[height_map]\nfile = \"map.txt\"\nchannel = \"Height\"\npitch = \"0.175 "
      "um\"\nheight_unit = \"1 "
      "nm\"\n"
      "level = \"polynomial\"\ndegree = 2\ntiling = \"mirror\"\n[tracing]\nrays = 100\nincidence_step = \"5 "
      "deg\"\n");
  const SurfaceSpec surface = database.surface("mine");
  const auto map = microsurface_of<HeightMapSpec>(surface);
  CHECK(map.path.filename() == "map.txt");
  CHECK(map.options.channel == "Height");
  CHECK(*map.options.pitch_um == doctest::Approx(0.175));
  CHECK(*map.options.height_unit_um == doctest::Approx(1e-3));
  CHECK(map.preparation.leveling.kind == Leveling::Kind::polynomial);
  CHECK(map.preparation.leveling.degree == 2);
  CHECK(map.tiling == Tiling::mirror);
  REQUIRE(map.table);
  CHECK(map.table->settings.rays == 100);
  CHECK(map.table->settings.incidence_step_rad == doctest::Approx(5.0 * kDegree));

  add("model = \"height_map\"\n[height_map]\nfile = \"nothing.txt\"\nlevel = \"plane\"\n");
  CHECK(reports(problems_of([&] { database.surface("mine"); }), 3, "does not exist"));
  add("model = \"height_map\"\n[height_map]\nfile = \"map.txt\"\n");
  CHECK(reports(problems_of([&] { database.surface("mine"); }), 0, "\"level\""));

  const SurfaceSpec made = surface_of(
      "model = \"recipe\"\n[recipe]\nkind = \"gaussian\"\nrms_height = \"0.9 um\"\ncorrelation_length = "
      "\"4.8 um\"\n"
      "seed = 7\n[tracing]\nmode = \"on_the_spot\"\n");
  const auto recipe = microsurface_of<RecipeSpec>(made);
  CHECK(recipe.recipe.gaussian.rms_height_um == doctest::Approx(0.9));
  CHECK(recipe.recipe.gaussian.correlation_length_um == doctest::Approx(4.8));
  CHECK(recipe.recipe.seed == 7);
  CHECK_FALSE(recipe.table);
  CHECK(reports(
      surface_problems("model = \"recipe\"\n[recipe]\nkind = \"gaussian\"\nrms_height = \"0.9 um\"\n"), 0,
      "correlation_length"));
  CHECK(reports(surface_problems("model = \"recipe\"\n[recipe]\nkind = \"polished\"\n[tracing]\nmode = "
                                 "\"on_the_spot\"\nrays = 5\n"),
                6, "no meaning"));
}

TEST_CASE("a height map is cropped, mended and filtered by its definition") {
  const TemporaryDatabase files("preparation");
  files.write("map.txt", "0 1\n1 0\n");
  MaterialDatabase database = shipped_database();
  const auto add = [&](const std::string& keys) {
    const std::string text =
        "model = \"height_map\"\n[height_map]\nfile = \"map.txt\"\npitch = \"1 um\"\nheight_unit = \"1 um\"\n"
        "level = \"mean\"\n" +
        keys;
    database.add(DefinitionKind::surface,
                 {{"mine", parse_toml(text, (files.folder() / "scene.toml").string())}});
  };
  add("crop = [\"1 um\", \"0 um\", \"40 um\", \"30 um\"]\noutliers = 6\noutlier_radius = 3\nfill_missing = "
      "true\n"
      "median_radius = 2\nloess_width = \"2 um\"\ngaussian_width = \"0.3 um\"\n");
  const auto made = microsurface_of<HeightMapSpec>(database.surface("mine"));
  const Preparation& p = made.preparation;
  const auto& crop = std::get<CropLengths>(p.crop);
  CHECK(crop.x_um == doctest::Approx(1.0));
  CHECK(crop.height_um == doctest::Approx(30.0));
  CHECK(*p.outlier_limit == 6.0);
  CHECK(p.outlier_radius == 3);
  CHECK(p.fill_missing);
  CHECK(*p.median_radius == 2);
  CHECK(*p.loess_width_um == doctest::Approx(2.0));
  CHECK(*p.gaussian_um == doctest::Approx(0.3));
  CHECK(p.leveling.kind == Leveling::Kind::mean);
  add("outliers = 0.5\n");
  CHECK(reports(problems_of([&] { database.surface("mine"); }), 7, "at least 1"));
  add("outlier_radius = 3\n");
  CHECK(reports(problems_of([&] { database.surface("mine"); }), 7, "no meaning"));
  add("crop = [\"1 um\", \"0 um\"]\n");
  CHECK_FALSE(problems_of([&] { database.surface("mine"); }).empty());
}

TEST_CASE("recipes of every kind are read, with what each needs and no key without effect") {
  const auto recipe_of = [](const std::string& keys) {
    return microsurface_of<RecipeSpec>(surface_of("model = \"recipe\"\n[recipe]\n" + keys)).recipe;
  };
  const SynthesisRecipe saw = recipe_of(
      "kind = \"saw_cut\"\nrms_height = \"0.8 um\"\ncorrelation_length = \"2 um\"\nlay_length = \"12 um\"\n"
      "lay_angle = \"30 deg\"\nscratches = { spacing = \"50 um\", length = \"20 um\", depth = \"0.1 um\", "
      "width = "
      "\"0.5 um\" }\n");
  CHECK(saw.gaussian.lay_length_um == doctest::Approx(12.0));
  CHECK(saw.gaussian.lay_angle_rad == doctest::Approx(30 * kDegree));
  CHECK(saw.scratches.spacing_um == doctest::Approx(50.0));
  CHECK(saw.scratches.depth_um == doctest::Approx(0.1));
  const SynthesisRecipe k = recipe_of(
      "kind = \"k_correlation\"\nrms_height = \"0.1 um\"\nknee_length = \"5 um\"\nexponent = 2.5\n");
  CHECK(k.k_correlation.knee_length_um == doctest::Approx(5.0));
  CHECK(k.k_correlation.exponent == 2.5);
  CHECK(k.gaussian.rms_height_um == 0.0);
  CHECK(recipe_of("kind = \"polished\"\n").scratches.spacing_um > 0.0);
  const auto problems = [](const std::string& keys) {
    return surface_problems("model = \"recipe\"\n[recipe]\n" + keys);
  };
  CHECK_FALSE(problems("kind = \"saw_cut\"\nrms_height = \"1 um\"\ncorrelation_length = \"2 um\"\n").empty());
  CHECK(reports(problems("kind = \"polished\"\nspacing = \"3 um\"\n"), 4, "no meaning"));

  const TemporaryDatabase files("spectra");
  files.write("psd.csv", "0.1,1e9\n1,1e7\n");
  files.write("wrong.csv", "0.1,1\n0.05,1\n");
  MaterialDatabase database = shipped_database();
  const auto add = [&](const std::string& file) {
    database.add(DefinitionKind::surface,
                 {{"mine", parse_toml("model = \"recipe\"\n[recipe]\nkind = \"spectrum\"\nspectrum = \"" +
                                          file + "\"\nfrequency_unit = \"1/um\"\ndensity_unit = \"nm4\"\n",
                                      (files.folder() / "scene.toml").string())}});
  };
  add("psd.csv");
  const auto made = microsurface_of<RecipeSpec>(database.surface("mine")).recipe;
  REQUIRE(made.spectrum.density_um4.size() == 2);
  CHECK(made.spectrum.density_um4[0] == doctest::Approx(1e-3));
  CHECK(made.spectrum.frequency_per_um[1] == doctest::Approx(1.0));
  add("wrong.csv");
  CHECK(reports(problems_of([&] { database.surface("mine"); }), 4, "wrong.csv:2"));
}
