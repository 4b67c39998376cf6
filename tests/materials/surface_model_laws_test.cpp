// Laws of the surface models that are named in definitions: metals, surfaces by angle, slightly rough faces.
// Those of optics have theirs in tests/physics/surface_laws_test.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "database_helpers.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "scintray/optics/coherent_layers.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;

namespace {

constexpr IndexPair kIndex{1.82, 1.0};
constexpr double kNm = 420.0;
constexpr int kBins = 20;
const Vec3 kNormal(0.48, -0.6, 0.64);

Surface surface_of(const std::string& text) {
  Medium inside, outside;
  inside.index = Curve::constant(kIndex.inside);
  outside.index = Curve::constant(kIndex.outside);
  SurfaceFactory factory{SurfaceFactory::Hooks{}};
  return factory
      .make(database_with(DefinitionKind::surface, "mine", text).surface("mine"), inside, outside, kNm, kNm,
            kNm)
      .surface;
}

int bin_of(double cosine) { return std::min(kBins - 1, static_cast<int>((1.0 - cosine * cosine) * kBins)); }

/// Where Lambertian, unpolarised light from one side goes, by bins that are even in the square of the sine.
struct Light {
  std::uint64_t absorbed = 0;
  std::array<std::uint64_t, kBins> arrived{}, reflected{},
      transmitted{};         ///< by the angle of incidence or exit
  std::uint64_t turned = 0;  ///< reflected at another angle than that of incidence

  static std::uint64_t sum(const std::array<std::uint64_t, kBins>& bins) {
    std::uint64_t all = 0;
    for (const std::uint64_t count : bins) all += count;
    return all;
  }
};

Light illuminate(const Surface& surface, Side side, std::uint64_t rays) {
  Light light;
  const Vec3 into = side == Side::inside ? kNormal : Vec3(-kNormal);
  for (std::uint64_t i = 0; i < rays; ++i) {
    Rng rng(51, StreamKind::other, i, static_cast<std::uint64_t>(side));
    Ray ray{sample_lambertian(into, rng), Vec3::Zero()};
    const double before = std::abs(ray.direction.dot(kNormal));
    ++light.arrived[static_cast<std::size_t>(bin_of(before))];
    const SurfaceOutcome outcome = surface.interact(ray, side, kNormal, kIndex, kNm, rng);
    if (outcome == SurfaceOutcome::absorbed) {
      ++light.absorbed;
      continue;
    }
    const double along = ray.direction.dot(kNormal);
    REQUIRE(std::abs(ray.direction.norm() - 1.0) < 1e-6);
    REQUIRE((outcome == SurfaceOutcome::inside ? along < 0.0 : along > 0.0));
    const bool back = outcome == outcome_on(side);
    ++(back ? light.reflected : light.transmitted)[static_cast<std::size_t>(bin_of(std::abs(along)))];
    light.turned += back && std::abs(std::abs(along) - before) > 1e-9 ? 1 : 0;
  }
  return light;
}

/// Chi-square of isotropic light on both sides: what leaves to the inside is Lambertian and as much as came.
ChiSquare equilibrium(const Surface& surface, std::uint64_t inside_rays) {
  const double ratio = std::pow(kIndex.outside / kIndex.inside, 2);
  const auto outside_rays =
      static_cast<std::uint64_t>(std::llround(static_cast<double>(inside_rays) * ratio));
  const Light in = illuminate(surface, Side::inside, inside_rays),
              out = illuminate(surface, Side::outside, outside_rays);
  std::vector<std::uint64_t> leaving;
  for (std::size_t i = 0; i < kBins; ++i) leaving.push_back(in.reflected[i] + out.transmitted[i]);
  return chi_square_test(leaving, std::vector<double>(kBins, static_cast<double>(inside_rays) / kBins));
}

const std::string kMetal = "model = \"metal\"\nmetal = { n = 0.96, k = 6.69";
const std::string kSlightlyRough =
    "model = \"slightly_rough\"\nslightly_rough = { rms_height = \"40 nm\" }\n";
const std::string kEvenSplitter =
    "model = \"angular\"\nangular = { transmitted = \"refracted\", at = [{ angle = \"0 deg\", reflectance = "
    "0.3 }] }\n";
const std::string kDichroic =
    "model = \"angular\"\nangular = { transmitted = \"undeflected\", at = [{ angle = \"0 deg\", reflectance "
    "= 0.9, "
    "transmittance = 0.05 }, { angle = \"90 deg\", reflectance = 0.4, transmittance = 0.5 }] }\n";

}  // namespace

TEST_CASE("Law of metals, slightly rough faces and surfaces by angle: energy") {
  struct Case {
    std::string name, text;
    bool absorbs, transmits;
  };
  constexpr std::uint64_t kRays = 40'000;
  for (const Case& model :
       {Case{"metal", kMetal + " }\n", true, false},
        Case{"rough metal", kMetal + ", polish = 0.7, facets = \"geant4\" }\n", true, false},
        Case{"slightly rough", kSlightlyRough, false, true}, Case{"splitter", kEvenSplitter, false, true},
        Case{"dichroic", kDichroic, true, true}}) {
    const Surface surface = surface_of(model.text);
    for (const Side side : {Side::inside, Side::outside}) {
      CAPTURE(model.name);
      const Light light = illuminate(surface, side, kRays);
      CHECK(Light::sum(light.reflected) + Light::sum(light.transmitted) + light.absorbed == kRays);
      CHECK((light.absorbed > 0) == model.absorbs);
      CHECK((Light::sum(light.transmitted) > 0) == model.transmits);
    }
  }
}

TEST_CASE("Law of a smooth metal: a mirror with Fresnel's reflectance at each angle, from either side") {
  const Surface surface = surface_of(kMetal + " }\n");
  constexpr std::uint64_t kRays = 200'000;
  for (const Side side : {Side::inside, Side::outside}) {
    const Light light = illuminate(surface, side, kRays);
    CHECK(light.turned == 0);
    for (int bin = 0; bin < kBins; ++bin) {
      double law = 0.0;
      constexpr int kSteps = 100;
      for (int i = 0; i < kSteps; ++i)
        law += film_response(std::sqrt(1.0 - (bin + (i + 0.5) / kSteps) / kBins), kIndex.on(side), {},
                             {0.96, 6.69}, kNm)
                   .reflectance() /
               kSteps;
      CAPTURE(bin);
      const auto at = static_cast<std::size_t>(bin);
      // 40 comparisons at 4 sigma: a false alarm in one of 400 such tests.
      CHECK(sigmas(binomial_estimate(light.reflected[at], light.arrived[at]), {law, 0.0}) < test::kSigmas);
    }
  }
}

TEST_CASE("Law of lossless models by name: reciprocity of the diffuse means, n1^2 T12 = n2^2 T21") {
  constexpr std::uint64_t kRays = 200'000;
  for (const std::string& text : {kSlightlyRough, kEvenSplitter}) {
    const Surface surface = surface_of(text);
    const Estimate in = binomial_estimate(Light::sum(illuminate(surface, Side::inside, kRays).transmitted),
                                          kRays),
                   out = binomial_estimate(Light::sum(illuminate(surface, Side::outside, kRays).transmitted),
                                           kRays);
    const double n1 = kIndex.inside * kIndex.inside, n2 = kIndex.outside * kIndex.outside;
    CAPTURE(text);
    CHECK(sigmas({n1 * in.value, n1 * in.error}, {n2 * out.value, n2 * out.error}) < test::kSigmas);
  }
}

TEST_CASE(
    "Isotropic light stays isotropic at a splitter, not at a slightly rough face, whose rule is Geant4's") {
  CHECK(equilibrium(surface_of(kEvenSplitter), 200'000).p_value > 6.3e-5);
  // It scatters a share that falls with the angle by Lambert's law, which no reciprocal surface can.
  CHECK(equilibrium(surface_of(kSlightlyRough), 200'000).p_value < 1e-6);
}

TEST_CASE("Law of DETECT's finishes: what each does with unpolarised light of an angle") {
  // What a user of DETECT2000 described (gate-users, April 2009): METAL mirrors, PAINT scatters by Lambert's
  // law, both whatever the next medium is; POLISH and GROUND are Fresnel's, reflecting as a mirror and by
  // Lambert's law.
  struct Finish {
    std::string name, definition;
    bool fresnel, diffuse;
  };
  constexpr double kCoefficient = 0.9;
  std::uint64_t seed = 90;
  constexpr std::uint64_t kRays = 100'000;
  const std::string reflects = fmt::format("reflectance = {}\n", kCoefficient);
  for (const Finish& finish :
       {Finish{"METAL", "detect_metal", false, false}, Finish{"PAINT", "detect_paint", false, true},
        Finish{"POLISH", "detect_polish", true, false}, Finish{"GROUND", "detect_ground", true, true}})
    for (const double angle_deg : {20.0, 50.0}) {
      const Surface surface =
          surface_of("base = \"" + finish.definition + "\"\n" + (finish.fresnel ? "" : reflects));
      const double cosine = std::cos(angle_deg * kDegree), sine = std::sin(angle_deg * kDegree);
      const FresnelCoefficients law = fresnel(cosine, kIndex.inside, kIndex.outside);
      const Vec3 incident = cosine * Vec3::UnitZ() + sine * Vec3::UnitX();
      ++seed;
      std::uint64_t reflected = 0;
      Moments out;
      for (std::uint64_t i = 0; i < kRays; ++i) {
        Rng rng(seed, StreamKind::other, i);
        Ray ray{incident, Vec3::Zero()};
        const SurfaceOutcome outcome = surface.interact(ray, Side::inside, Vec3::UnitZ(), kIndex, kNm, rng);
        if (outcome == SurfaceOutcome::inside) {
          ++reflected;
          out.add(-ray.direction.z());
        } else if (outcome == SurfaceOutcome::outside) {
          REQUIRE(finish.fresnel);
          REQUIRE(std::abs(ray.direction.z() - law.cos_refracted) < 1e-6);
        }
      }
      CAPTURE(finish.name);
      CAPTURE(angle_deg);
      const double share = finish.fresnel ? law.unpolarised() : kCoefficient;
      const Estimate measured = binomial_estimate(reflected, kRays);
      CHECK(sigmas(measured, {share, 0.0}) < test::kSigmas);
      const double mean_cosine = finish.diffuse ? 2.0 / 3.0 : cosine;
      const Estimate mean = finish.diffuse ? out.mean() : Estimate{out.mean().value, 1e-7};
      CHECK(sigmas(mean, {mean_cosine, 0.0}) < test::kSigmas);
      test::evidence("detect_finishes",
                     {finish.name, fmt::format("{:g}", angle_deg), fmt::format("{:.4f}", share),
                      fmt::format("{:.4f} ± {:.4f}", measured.value, measured.error),
                      fmt::format("{:.1f}", sigmas(measured, {share, 0.0})),
                      fmt::format("{:.4f}", mean_cosine), fmt::format("{:.4f}", out.mean().value),
                      finish.diffuse ? fmt::format("{:.1f}", sigmas(mean, {mean_cosine, 0.0})) : "exact"});
    }
}
