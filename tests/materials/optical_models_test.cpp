#include "database_helpers.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/materials/table_key.hpp"
#include "scintray/optics/coherent_layers.hpp"
#include "scintray/optics/wave_scatter.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;

namespace {

SurfaceSpec own_surface(const std::string& text) {
  return database_with(DefinitionKind::surface, "mine", text).surface("mine");
}

std::vector<Problem> own_surface_problems(const std::string& text) {
  const MaterialDatabase database = database_with(DefinitionKind::surface, "mine", text);
  return problems_of([&] { database.surface("mine"); });
}

const std::string kFilm =
    "model = \"thin_film\"\nthin_film = { layers = [{ index = 1.38, thickness = \"99.6 nm\" }, ";

}  // namespace

TEST_CASE("a thin film is a list of layers from the inside, with extinction where they absorb") {
  const auto film = microsurface_of<ThinFilmSurface>(
      own_surface(kFilm + "{ index = 2.1, extinction = 0.2, thickness = \"0.08 um\" }] }\n"));
  REQUIRE(film.layers().size() == 2);
  CHECK(film.layers()[0].index(500.0) == 1.38);
  CHECK(film.layers()[0].thickness_nm == doctest::Approx(99.6));
  CHECK(film.layers()[1].extinction(500.0) == 0.2);
  CHECK(film.layers()[1].thickness_nm == doctest::Approx(80.0));
  const auto wrong = [](const std::string& layer) { return own_surface_problems(kFilm + layer + "] }\n"); };
  CHECK(reports(wrong("{ index = 2.1, thickness = \"2 mm\" }"), 2, "up to 0.1 mm"));
  CHECK(reports(wrong("{ index = 0, thickness = \"2 nm\" }"), 2, "above 0"));
  CHECK(reports(wrong("{ index = 2, extinction = -1, thickness = \"2 nm\" }"), 2, "imaginary part"));
  CHECK(reports(own_surface_problems("model = \"thin_film\"\nthin_film = { layers = [] }\n"), 0,
                "1 to 200 layers"));
}

TEST_CASE("a face with films is smooth, or has facets of a width or of a polish") {
  const auto film = [](const std::string& roughness) {
    return kFilm + "{ index = 2.1, thickness = \"0.08 um\" }]" + roughness + " }\n";
  };
  CHECK(microsurface_of<ThinFilmSurface>(own_surface(film(""))).reciprocal());
  const std::string unified =
      ", sigma_alpha = \"12 deg\", definition = \"solid_angle\", facets = \"geant4\", lobe = 1.0";
  CHECK_FALSE(microsurface_of<ThinFilmSurface>(own_surface(film(unified))).reciprocal());
  CHECK_FALSE(microsurface_of<ThinFilmSurface>(own_surface(film(", polish = 0.8, facets = \"geant4\"")))
                  .reciprocal());
  CHECK(reports(own_surface_problems(film(unified + ", polish = 0.8")), 2,
                "a face with films has both \"sigma_alpha\" and \"polish\""));
}

TEST_CASE("wave scattering has one spectrum of heights, and is refused where it would scatter much light") {
  const auto text = [](const std::string& spectrum) {
    return "model = \"wave_scatter\"\nwave_scatter = { " + spectrum + " }\n";
  };
  CHECK(reports(own_surface_problems(text("")), 2, "gaussian"));
  CHECK(reports(own_surface_problems(text("gaussian = { rms_height = \"2 nm\" }")), 2,
                "no \"correlation_length\""));
  CHECK(reports(own_surface_problems(
                    text("k_correlation = { rms_height = \"2 nm\", knee_length = \"3 um\", exponent = 1 }")),
                2, "expected above 1"));
  Medium crystal, air;
  crystal.index = Curve::constant(1.82);
  air.index = Curve::constant(1.0);
  const auto make = [&](const std::string& rms_height) {
    SurfaceFactory factory{SurfaceFactory::Hooks{}};
    return factory.make(own_surface(text("gaussian = { rms_height = \"" + rms_height +
                                         "\", correlation_length = \"0.3 um\" }")),
                        crystal, air, 420.0, 400.0, 500.0);
  };
  const MadeSurface made = make("3 nm");
  const auto* face = made.surface.microsurface.get_if<WaveScatterSurface>();
  REQUIRE(face);
  CHECK(face->most_scattered() > 0.001);
  CHECK(face->most_scattered() < 0.05);
  CHECK(reports(problems_of([&] { make("40 nm"); }), 2, "would scatter"));
}

TEST_CASE(
    "a film without frustrated transmission reflects all light beyond its critical angle, one that does not "
    "transmit absorbs the rest") {
  // A film of 1.2 between 1.8 and 1.8: its critical angle is 41.8 deg; 20 nm pass most light at 60 deg.
  const auto shares = [](const std::string& options, double degrees) {
    const auto film = microsurface_of<ThinFilmSurface>(
        own_surface("model = \"thin_film\"\nthin_film = { layers = [{ index = 1.2, thickness = \"20 nm\" }]" +
                    options + " }\n"));
    std::array<double, 3> of{};  // inside, outside, absorbed
    constexpr int kRays = 20'000;
    for (int i = 0; i < kRays; ++i) {
      Rng rng(8, StreamKind::other, static_cast<std::uint64_t>(i));
      Ray ray{Vec3(std::sin(degrees * kDegree), 0.0, std::cos(degrees * kDegree)), Vec3::Zero()};
      SurfaceInteraction at{Vec3::UnitZ(), Vec3::Zero(), 450.0, rng};
      const SurfaceOutcome outcome = film.scatter(ray, Side::inside, {1.8, 1.8}, at);
      of[outcome == SurfaceOutcome::inside ? 0 : outcome == SurfaceOutcome::outside ? 1 : 2] += 1.0 / kRays;
      if (outcome == SurfaceOutcome::inside) CHECK(ray.direction.z() < 0.0);
    }
    return of;
  };
  const Film layer{{1.2, 0.0}, 20.0};
  const double law = film_response(std::cos(60.0 * kDegree), 1.8, {&layer, 1}, 1.8, 450.0).transmittance();
  CHECK(law > 0.5);
  const double error = 5.0 * std::sqrt(0.25 / 20'000);  // a false alarm in 1.7 million
  CHECK(std::abs(shares("", 60.0)[1] - law) < error);
  CHECK(shares(", frustrated_transmission = false", 60.0)[0] == doctest::Approx(1.0));
  CHECK(shares(", frustrated_transmission = false", 41.0)[1] > 0.5);
  const auto absorbing = shares(", transmits = false", 60.0);
  CHECK(absorbing[1] == 0.0);
  CHECK(std::abs(absorbing[2] - law) < error);
  CHECK(microsurface_of<ThinFilmSurface>(own_surface(kFilm + "], transmits = false }\n")).opaque());
}

TEST_CASE("light that a reflector transmits undeflected keeps its direction in any medium") {
  const std::string paint =
      "model = \"smooth\"\ngap = 1.0\nreflectance = 0.2\nspecular_share = 0\ntransmittance = 0.7\n";
  const auto through = [&](const std::string& key) {
    SurfaceFactory factory;
    const MaterialDatabase database = database_with(DefinitionKind::surface, "mine", paint + key);
    const Surface surface =
        factory
            .make(database.surface("mine"), database.medium("air"), database.medium("glass"), 450, 400, 500)
            .surface;
    std::size_t same = 0, passed = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      Rng rng(9, StreamKind::other, i);
      const Vec3 before(std::sin(0.6), 0.0, std::cos(0.6));
      Ray ray{before, Vec3::Zero()};
      if (surface.interact(ray, Side::inside, Vec3::UnitZ(), {1.0, 1.5}, 450.0, rng) !=
          SurfaceOutcome::outside)
        continue;
      ++passed;
      same += ray.direction.vec().isApprox(before, 1e-12);
    }
    CHECK(passed > 1000);
    return std::pair(same, passed);
  };
  const auto kept = through("transmitted_light = \"undeflected\"\n");
  CHECK(kept.first == kept.second);
  CHECK(through("").first == 0);
  CHECK(reports(own_surface_problems(paint + "transmitted_light = \"straight\"\n"), 6, "undeflected"));
}

TEST_CASE("a metal has a complex index, or facets, or neither") {
  const auto metal = microsurface_of<MetalSurface>(
      own_surface("model = \"metal\"\nmetal = { n = 0.96, k = 6.69, polish = 0.7, facets = \"geant4\" }\n"));
  REQUIRE(metal.metal);
  CHECK(metal.metal->k(500.0) == 6.69);
  CHECK(metal.facets.smear == doctest::Approx(0.3));
  CHECK_FALSE(microsurface_of<MetalSurface>(own_surface("model = \"metal\"\nmetal = {}\n")).metal);
  CHECK(reports(own_surface_problems("model = \"metal\"\nmetal = { n = 0.96 }\n"), 0, "\"k\""));
  CHECK(
      reports(own_surface_problems("model = \"metal\"\nmetal = { n = 0.96, k = -6.7 }\n"), 2, "k positive"));
  CHECK(reports(own_surface_problems("model = \"metal\"\nmetal = { lobe = 1 }\n"), 2, "\"lobe\""));
}

TEST_CASE("GLISUR's polish is a share, and its facets are weighted as the file states") {
  const auto smeared = microsurface_of<FacetSurface>(
      own_surface("model = \"glisur\"\nglisur = { polish = \"80 %\", facets = \"geant4\" }\n"));
  CHECK(smeared.smear == doctest::Approx(0.2));
  CHECK(smeared.lobe == 1.0);
  CHECK(reports(own_surface_problems("model = \"glisur\"\nglisur = { polish = 1.2, facets = \"geant4\" }\n"),
                2, "between 0 and 1"));
  CHECK(reports(own_surface_problems("model = \"glisur\"\nglisur = { polish = 0.2 }\n"), 0, "\"facets\""));
}

TEST_CASE("a slightly rough face scatters the share of Bennett and Porteus of what it reflects from within") {
  const SurfaceSpec spec =
      own_surface("model = \"slightly_rough\"\nslightly_rough = { rms_height = \"10 nm\" }\n");
  const auto* fixed = spec.microsurface.get_if<FixedMicrosurface>();
  REQUIRE(fixed);
  const Vec3 normal = Vec3::UnitZ(), sideways = Vec3(0.8, 0.0, 0.6);
  for (const Side side : {Side::inside, Side::outside}) {
    std::uint64_t reflected = 0, scattered = 0;
    for (std::uint64_t i = 0; i < 200'000; ++i) {
      Rng rng(3, StreamKind::other, i);
      Ray ray{side == Side::inside ? sideways : Vec3(-sideways), Vec3::Zero()};
      const Vec3 mirrored = mirror(ray.direction, normal);
      SurfaceInteraction at{normal, Vec3::Zero(), 420.0, rng};
      if (fixed->microsurface()->scatter(ray, side, {1.8, 1.0}, at) != outcome_on(side)) continue;
      ++reflected;
      scattered += (ray.direction - mirrored).norm() > 1e-9;
    }
    const double phase = 4.0 * kPi * 10.0 * 1.8 * 0.6 / 420.0;
    const double law = side == Side::inside ? 1.0 - std::exp(-phase * phase) : 0.0;
    CHECK(sigmas(binomial_estimate(scattered, reflected), {law, 0.0}) < test::kSigmas);
  }
  CHECK(reports(own_surface_problems("model = \"slightly_rough\"\nslightly_rough = {}\n"), 0,
                "\"rms_height\""));
}

TEST_CASE("a surface by angle reflects and transmits what its table has between two angles and wavelengths") {
  const std::string band = R"(model = "angular"
[angular]
transmitted = "TRANSMITTED"
at = [
  { angle = "0 deg", transmittance = { wavelength = [400, 500], wavelength_unit = "nm", value = [0.9, 0.5] } },
  { angle = "60 deg", reflectance = 0.6, transmittance = 0.1 },
]
)";
  for (const bool refracted : {false, true}) {
    std::string text = band;
    text.replace(text.find("TRANSMITTED"), 11, refracted ? "refracted" : "undeflected");
    const SurfaceSpec spec = own_surface(text);
    const auto* fixed = spec.microsurface.get_if<FixedMicrosurface>();
    REQUIRE(fixed);
    CHECK_FALSE(fixed->microsurface()->opaque());
    for (const double degrees : {0.0, 15.0, 30.0, 60.0, 80.0}) {
      std::uint64_t reflected = 0, transmitted = 0, wrong = 0;
      const double angle = degrees * kDegree;
      for (std::uint64_t i = 0; i < 100'000; ++i) {
        Rng rng(4, StreamKind::other, i);
        Ray ray{Vec3(std::sin(angle), 0.0, std::cos(angle)), Vec3::Zero()};
        SurfaceInteraction at{Vec3::UnitZ(), Vec3::Zero(), 450.0, rng};
        const SurfaceOutcome outcome = fixed->microsurface()->scatter(ray, Side::inside, {1.0, 1.5}, at);
        reflected += outcome == SurfaceOutcome::inside;
        transmitted += outcome == SurfaceOutcome::outside;
        if (outcome == SurfaceOutcome::outside)
          wrong += std::abs(ray.direction.x() * (refracted ? 1.5 : 1.0) - std::sin(angle)) > 1e-9;
      }
      const double t = std::min(1.0, degrees / 60.0);
      CAPTURE(degrees);
      CHECK(wrong == 0);
      CHECK(sigmas(binomial_estimate(reflected, 100'000), {(1.0 - t) * 0.3 + t * 0.6, 0.0}) < test::kSigmas);
      CHECK(sigmas(binomial_estimate(transmitted, 100'000), {(1.0 - t) * 0.7 + t * 0.1, 0.0}) <
            test::kSigmas);
    }
  }
  const std::string head = "model = \"angular\"\n[angular]\ntransmitted = \"refracted\"\nat = [";
  CHECK(reports(own_surface_problems(head + "]\n"), 0, "without an angle"));
  CHECK(reports(own_surface_problems(head + "{ angle = \"0 deg\" }]\n"), 4, "without reflectance"));
  CHECK(
      reports(own_surface_problems(head + "{ angle = \"0 deg\", reflectance = 0.7, transmittance = 0.4 }]\n"),
              4, "1.1"));
  CHECK(reports(own_surface_problems(head + "{ angle = \"95 deg\", reflectance = 0.7 }]\n"), 4, "90 deg"));
  CHECK(
      reports(own_surface_problems(
                  head + "{ angle = \"9 deg\", reflectance = 1 }, { angle = \"9 deg\", reflectance = 1 }]\n"),
              4, "rise"));
}

TEST_CASE("admitted and undeflected light are shares, at most 1 together, and part of the key of tables") {
  const std::string smooth = "model = \"smooth\"\n";
  const SurfaceSpec surface = own_surface(smooth + "admitted = 0.8\nundeflected = 0.1\n");
  REQUIRE(surface.admission);
  CHECK(surface.admission->undeflected(500.0) == 0.1);
  CHECK(*stack_key(surface) != *stack_key(own_surface(smooth)));
  CHECK(*stack_key(surface) != *stack_key(own_surface(smooth + "admitted = 0.8\n")));
  CHECK(*stack_key(own_surface(smooth)) != *stack_key(own_surface(smooth + "between_media_only = true\n")));
  CHECK(reports(own_surface_problems(smooth + "admitted = 0.8\nundeflected = 0.3\n"), 3, "1.1"));
  CHECK(reports(own_surface_problems(smooth + "undeflected = 0.3\n"), 0, "without \"admitted\""));
  CHECK(reports(own_surface_problems(smooth + "admitted = 80\n"), 2, "between 0 and 1"));
}

TEST_CASE("a surface between media only is smooth between two parts of one medium") {
  const SurfaceSpec spec = own_surface("model = \"smooth\"\nbetween_media_only = true\nadmitted = 0.5\n");
  SurfaceFactory factory{SurfaceFactory::Hooks{}};
  Medium one, two;
  one.name = "one";
  two.name = "two";
  one.index = two.index = Curve::constant(1.5);
  CHECK(factory.make(spec, one, one, 420.0, 400.0, 500.0).surface.plain());
  CHECK(factory.make(spec, one, two, 420.0, 400.0, 500.0).surface.admission.has_value());
}

TEST_CASE("curves of a film, a metal or a surface by angle must cover the wavelengths in use") {
  const std::string table = "{ wavelength = [400, 500], wavelength_unit = \"nm\", value = [1, 1] }";
  Medium glass;
  glass.name = "glass";
  glass.index = Curve::constant(1.5);
  SurfaceFactory factory{SurfaceFactory::Hooks{}};
  for (const std::string& text :
       {"model = \"thin_film\"\nthin_film = { layers = [{ thickness = \"9 nm\", index = " + table + " }] }\n",
        "model = \"metal\"\nmetal = { k = 6, n = " + table + " }\n",
        "model = \"angular\"\nangular = { transmitted = \"refracted\", at = [{ angle = \"0 deg\", "
        "reflectance = " +
            table + " }] }\n"}) {
    const SurfaceSpec spec = own_surface(text);
    CHECK_NOTHROW(factory.make(spec, glass, glass, 450.0, 400.0, 500.0));
    CHECK(reports(problems_of([&] { factory.make(spec, glass, glass, 450.0, 400.0, 510.0); }), 2,
                  "from 400 to 500 nm"));
  }
}

TEST_CASE("the axes of a birefringent medium are read, and checked") {
  const std::string rest = "scattering = { none = true }\n";
  const auto text = [&](const std::string& index, const std::string& absorption) {
    return "index = { " + index + " }\nabsorption = { " + absorption + " }\n" + rest;
  };
  const auto read = [&](const std::string& index, const std::string& absorption) {
    return database_with(DefinitionKind::medium, "mine", text(index, absorption)).medium("mine");
  };
  const auto wrong = [&](const std::string& index, const std::string& absorption) {
    return problems_of([&] { read(index, absorption); });
  };
  CHECK(!read("n = 1.5", "none = true").birefringence);
  const std::string falling = "{ wavelength = [400, 500], wavelength_unit = \"nm\", value = [1.8, 1.7] }";
  const Medium uniaxial = read("n = " + falling + ", z = { n = 1.6, group = 1.65 }",
                               "coefficient = \"0.1 1/mm\", y = { none = true }");
  REQUIRE(uniaxial.birefringence);
  const auto& [x, y, z] = uniaxial.birefringence->axes;
  CHECK(x.index(400.0) == 1.8);
  CHECK(y.index(500.0) == 1.7);
  CHECK(z.index(400.0) == 1.6);
  CHECK(z.group_index.value()(450.0) == 1.65);
  CHECK(uniaxial.index(450.0) == doctest::Approx((1.75 + 1.75 + 1.6) / 3.0));
  CHECK(y.absorption_per_mm(450.0) == 0.0);
  CHECK(z.absorption_per_mm(450.0) == doctest::Approx(0.1));
  CHECK(uniaxial.absorption_per_mm(450.0) == doctest::Approx(0.2 / 3.0));

  CHECK(read("n = 1.5, y = { n = 1.5 }", "none = true").birefringence);  // where a sweep begins
  CHECK(reports(wrong("n = 1.5, y = { n = 1.5 }", "none = true, z = { length = \"3 mm\" }"), 2,
                "all the same"));
  CHECK(reports(wrong("n = 1.5, z = { n = 0.5 }", "none = true"), 1, "between 1 and 5"));
  CHECK(reports(wrong("n = 1.5", "none = true, z = { length = \"3 mm\" }"), 2, "of one refractive index"));
  const std::string other = "{ wavelength = [600, 700], wavelength_unit = \"nm\", value = [1.8, 1.7] }";
  CHECK(reports(wrong("n = " + falling + ", z = { n = " + other + " }", "none = true"), 1,
                "no wavelengths in common"));
}

TEST_CASE("particles, group indices and what a sensor converts are read, and checked") {
  const std::string medium =
      "index = { n = 1.5, group = 1.7 }\nabsorption = { none = true }\nscattering = { none = true }\n";
  const auto read = [&](const std::string& more) {
    return database_with(DefinitionKind::medium, "mine", medium + more).medium("mine");
  };
  const Medium cloudy =
      read("particles = { length = \"2 mm\", forward = 0.9, backward = 0.3, forward_share = 0.8 }\n");
  REQUIRE(cloudy.particles);
  CHECK(cloudy.at(400.0).group_index == 1.7);
  CHECK(cloudy.at(400.0).scattering_per_mm == doctest::Approx(0.5));
  const auto wrong = [&](const std::string& keys) {
    const MaterialDatabase database = database_with(DefinitionKind::medium, "mine", medium + keys);
    return problems_of([&] { database.medium("mine"); });
  };
  CHECK(reports(wrong("particles = { length = \"2 mm\", forward = 1 }\n"), 4, "between -1 and 1"));
  CHECK(reports(wrong("particles = { length = \"2 mm\", forward = 0, forward_share = 2 }\n"), 4,
                "between 0 and 1"));
  CHECK(reports(wrong("particles = { none = true, forward = 0 }\n"), 4, "leave [particles] out"));
  const MaterialDatabase slow = database_with(
      DefinitionKind::medium, "mine",
      "index = { n = 1.5, group = 0.7 }\nabsorption = { none = true }\nscattering = { none = true }\n");
  CHECK(reports(problems_of([&] { slow.medium("mine"); }), 1, "between 1 and 10"));
  const auto sensor = [](const std::string& converts) {
    return database_with(
               DefinitionKind::sensor, "mine",
               converts +
                   "efficiency = { definition = \"internal\", value = 0.3 }\nwindow = { index = 1.5 }\n")
        .sensor("mine");
  };
  CHECK(sensor("").converts == detector::ConvertedLight::entering);
  CHECK(sensor("converts = \"both\"\n").converts_absorbed());
  CHECK_FALSE(sensor("converts = \"absorbed\"\n").converts_entering());
  CHECK(reports(problems_of([&] { sensor("converts = \"all\"\n"); }), 1, "\"absorbed\""));
}
