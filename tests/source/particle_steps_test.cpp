#include <cmath>
#include <fstream>

#include "event_scene.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/source/detail/event_sources.hpp"
#include "scintray/source/detail/scintillation_source.hpp"
#include "support/agreement.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

constexpr double kAlpha = 1.0 / 137.035999;

/// A plastic of index 1.5 with Birks' law, and light of its own for alphas.
const std::string kPlastic = R"(
[media.plastic]
index = { n = 1.5 }
absorption = { none = true }
scattering = { none = true }
density = { value = "1.032 g/cm3" }
composition = { formula = "C9H10" }
yield = { value = "10000 photons/MeV" }
emission = { spectrum = { wavelength = [400, 420, 440], wavelength_unit = "nm", value = [0, 1, 0] } }
decay = [{ time = "2 ns", rise = "0 ns", fraction = 1 }]
birks = { value = "0.126 mm/MeV" }
[[media.plastic.particle_light]]
particle = "alpha"
photons = { energy = [0, 5, 10], energy_unit = "MeV", value = [0, 2000, 6000] }
emission = { spectrum = { wavelength = [430, 435, 440], wavelength_unit = "nm", value = [0, 1, 0] } }
decay = [{ time = "100 ns", rise = "0 ns", fraction = 1 }]
[media.silica]
index = { n = 1.47 }
absorption = { none = true }
scattering = { none = true }
)";

Scene block_of(const std::string& medium) {
  return scene_of(box_part("block", medium, Vec3::Constant(100.0)) +
                  (medium == "silica" ? box_part("tile", "plastic", Vec3::Constant(1.0)) : "") + kPlastic);
}

std::filesystem::path file_with(const std::string& csv) {
  const std::filesystem::path file = scratch_folder("steps") / "steps.csv";
  std::ofstream(file) << csv;
  return file;
}

std::string source_of(const std::string& csv, const std::string& columns) {
  return "type = \"hits\"\nfile = \"" + file_with(csv).string() +
         "\"\nlength_unit = \"mm\"\nenergy_unit = \"MeV\"\ntime_unit = \"ns\"\ncolumns = { " + columns +
         " }\n";
}

ScintillationSource light_of(const std::string& source, const Scene& scene,
                             const LightOptions& options = {}) {
  const scene_file::GammaSpec spec = gamma_spec(source, {"block", "tile"});
  return {make_event_source(spec, scene), scene, options};
}

/// Mean number of photons of the only event of a source.
Estimate photons_of(const ScintillationSource& source, const Scene& scene, int draws = 2000) {
  Moments photons;
  EventLight light;
  for (int i = 0; i < draws; ++i) {
    Rng rng(5, StreamKind::event, static_cast<std::uint64_t>(i));
    source.begin(scene, 0, rng, light);
    photons.add(static_cast<double>(light.photons));
  }
  return photons.mean();
}

const char* const kSteps = "dx = \"dx\", dy = \"dy\", dz = \"dz\"";

}  // namespace

TEST_CASE("Birks' law: the light of steps follows E / (1 + kB dE/dx)") {
  const Scene scene = block_of("plastic");
  for (const double length_mm : {0.01, 0.1, 1.0, 10.0}) {
    const auto source = light_of(
        source_of(fmt::format("event,x,y,z,energy,time,dx,dy,dz\n0,0,0,0,0.5,0,0,0,{}\n", length_mm), kSteps),
        scene);
    const double expected = 10000.0 * 0.5 / (1.0 + 0.126 * 0.5 / length_mm);
    CAPTURE(length_mm);
    CHECK(sigmas(photons_of(source, scene), {expected, 0.0}) < kSigmas);
  }
}

TEST_CASE("Birks' law: electrons that stop have the integral over their stopping power") {
  const Scene scene = block_of("plastic");
  const optics::Medium& medium = scene.media[scene.regions[RegionId(1)].medium].medium();
  const Curve seen = birks_response(medium);
  const ElectronStopping stopping(medium.composition, medium.density_g_per_cm3);
  for (const double energy : {50.0, 511.0, 3000.0}) {
    double sum = 0.0;
    constexpr int kPieces = 20'000;
    for (int i = 0; i < kPieces; ++i) {
      const double at = energy * (i + 0.5) / kPieces;
      sum += energy / kPieces / (1.0 + 0.126e-3 * stopping.keV_per_mm(std::max(at, 10.0)));
    }
    CAPTURE(energy);
    CHECK(seen(energy) == doctest::Approx(sum).epsilon(1e-4));
    CHECK(seen(energy) < energy);
  }
  CHECK(seen(3000.0) / 3000.0 > seen(50.0) / 50.0);  // slow electrons ionise densely
}

TEST_CASE("light by particle is L(T) - L(T - E), and of the steps of one particle together L(T)") {
  const Scene scene = block_of("plastic");
  const std::string columns = std::string(kSteps) + ", particle = \"pdg\", kinetic = \"kinetic\"";
  const std::string head = "event,x,y,z,energy,time,dx,dy,dz,pdg,kinetic\n", alpha = "1000020040";
  // 8 MeV: 2000 + 3 / 5 * 4000 photons in all; from 8 to 6 MeV 1600 of them.
  const auto first = light_of(source_of(head + "0,0,0,0,2,0,0,0,0.01," + alpha + ",8\n", columns), scene);
  CHECK(sigmas(photons_of(first, scene), {1600.0, 0.0}) < kSigmas);
  const auto all = light_of(
      source_of(head + "0,0,0,0,2,0,0,0,0.01," + alpha + ",8\n0,0,0,0.01,6,0,0,0,0.01," + alpha + ",6\n",
                columns),
      scene);
  CHECK(sigmas(photons_of(all, scene), {4400.0, 0.0}) < kSigmas);
  // Its own decay and spectrum; those of an electron are the medium's.
  EventLight light;
  for (const char* particle : {"1000020040", "11"}) {
    const bool is_alpha = std::string(particle) != "11";
    const auto source = light_of(source_of(head + "0,0,0,0,2,0,0,0,1," + particle + ",8\n", columns), scene);
    Rng rng(6, StreamKind::event, 0);
    source.begin(scene, 0, rng, light);
    Moments time, wavelength;
    for (std::uint64_t i = 0; i < light.photons; ++i) {
      Rng own(6, StreamKind::photon, 0, i);
      const Photon photon = source.emit(scene, light, i, own);
      time.add(photon.time_ns);
      wavelength.add(photon.wavelength_nm);
      CHECK(photon.position.vec().z() >= 0.0);
      CHECK(photon.position.vec().z() <= 1.0);
    }
    CHECK(sigmas(time.mean(), {is_alpha ? 100.0 : 2.0, 0.0}) < kSigmas);
    CHECK(sigmas(wavelength.mean(), {is_alpha ? 435.0 : 420.0, 0.0}) < kSigmas);
  }
  const auto beyond = light_of(source_of(head + "0,0,0,0,2,0,0,0,1," + alpha + ",20\n", columns), scene);
  Rng rng(6, StreamKind::event, 0);
  CHECK(says(complaint([&] { beyond.begin(scene, 0, rng, light); }), "whose light is given up to 10000 keV"));
}

TEST_CASE("Cherenkov light of a step: Frank and Tamm's number, on the cone, polarised in its plane") {
  const Scene scene = block_of("silica");
  const double n = 1.47;
  for (const double beta : {0.75, 0.999}) {
    const auto source = light_of(
        source_of(fmt::format("event,x,y,z,energy,time,dx,dy,dz,beta,q\n0,5,5,5,0,3,0,6,8,{},2\n", beta),
                  std::string(kSteps) + ", beta = \"beta\", charge = \"q\"") +
            "cherenkov = true\ncherenkov_range = [\"300 nm\", \"600 nm\"]\n",
        scene, {false, true, std::array{300.0, 600.0}});
    const double sin2 = 1.0 - 1.0 / (beta * beta * n * n);
    const double expected = kTwoPi * kAlpha * 4.0 * sin2 * (1.0 / 300.0 - 1.0 / 600.0) * 1e6 * 10.0;
    CAPTURE(beta);
    const Estimate photons = photons_of(source, scene);
    CHECK(sigmas({photons.value, std::hypot(photons.error, 1e-4 * expected)}, {expected, 0.0}) < kSigmas);
    EventLight light;
    Rng rng(7, StreamKind::event, 0);
    source.begin(scene, 0, rng, light);
    const Vec3 axis(0.0, 0.6, 0.8);
    Moments along, inverse_nm;
    for (std::uint64_t i = 0; i < light.photons; ++i) {
      Rng own(7, StreamKind::photon, 0, i);
      const Photon photon = source.emit(scene, light, i, own);
      const Vec3 direction = photon.ray.direction.vec(), field = photon.ray.polarisation.vec();
      CHECK(direction.dot(axis) == doctest::Approx(1.0 / (beta * n)).epsilon(1e-9));
      CHECK(std::abs(field.dot(direction)) < 1e-9);
      CHECK(std::abs(field.dot(direction.cross(axis))) < 1e-9);
      const double place = (photon.position.vec() - Vec3::Constant(5.0)).dot(axis);
      CHECK(photon.time_ns == doctest::Approx(place / (beta * 299.792458)));
      along.add(place);
      inverse_nm.add(1.0 / photon.wavelength_nm);
    }
    CHECK(sigmas(along.mean(), {5.0, 0.0}) < kSigmas);
    CHECK(sigmas(inverse_nm.mean(), {0.5 * (1.0 / 300.0 + 1.0 / 600.0), 0.0}) < kSigmas);
  }
}

TEST_CASE("a step that slows down below the threshold emits until there") {
  const Scene scene = block_of("silica");
  optics::Medium medium;
  medium.name = "n 1.5";
  medium.index = Curve::constant(1.5);
  const CherenkovTrack track(medium, 300.0, 600.0);
  ParticleStep step;
  step.displacement = Vec3(0.0, 0.0, 10.0);
  step.charge = 1.0;
  step.beta = 0.9;
  step.beta_end = 2.0 / 3.0 - (0.9 - 2.0 / 3.0);  // the threshold is halfway
  double sum = 0.0;
  constexpr int kPieces = 100'000;
  for (int i = 0; i < kPieces; ++i) {
    const double beta = step.beta + (step.beta_end - step.beta) * (i + 0.5) / kPieces;
    sum += std::max(0.0, 1.0 - 1.0 / (beta * beta * 2.25)) / kPieces;
  }
  CHECK(track.mean_photons(step) ==
        doctest::Approx(kTwoPi * kAlpha * sum * (1.0 / 300.0 - 1.0 / 600.0) * 1e7).epsilon(2e-3));
  Rng rng(8, StreamKind::other, 0);
  for (int i = 0; i < 1000; ++i) CHECK(track.sample(step, rng).along < 0.5);
  step.beta = step.beta_end = 0.5;
  CHECK(track.mean_photons(step) == 0.0);
  CHECK(says(complaint([&] { track.sample(step, rng); }), "slower than light"));
}

TEST_CASE("numbers of photons and decay times that another program sampled are taken as they are") {
  const Scene scene = block_of("plastic");
  const auto source = light_of(
      source_of("event,x,y,z,energy,time,dx,dy,dz,beta,q,ns,nc,tau\n0,0,0,0,0.1,0,0,0,1,0.99,-1,700,40,50\n",
                std::string(kSteps) + ", beta = \"beta\", charge = \"q\", scintillation_photons = \"ns\", "
                                      "cherenkov_photons = \"nc\", decay = \"tau\"") +
          "cherenkov = true\n",
      scene, {false, true, std::array{300.0, 600.0}});
  EventLight light;
  Rng rng(9, StreamKind::event, 0);
  source.begin(scene, 0, rng, light);
  CHECK(light.photons == 740);
  REQUIRE(light.deposits.size() == 1);
  CHECK(light.deposits[0].scintillation == 700);
  Moments time;
  for (std::uint64_t i = 0; i < 700; ++i) {
    Rng own(9, StreamKind::photon, 0, i);
    time.add(source.emit(scene, light, i, own).time_ns);
  }
  CHECK(sigmas(time.mean(), {50.0, 0.0}) < kSigmas);
}

TEST_CASE("columns of steps that contradict each other are refused with what is missing") {
  const Scene scene = block_of("plastic");
  const auto refused = [&](const std::string& csv, const std::string& columns) {
    return complaint([&] { light_of(source_of("event,x,y,z,energy,time," + csv, columns), scene); });
  };
  CHECK(says(refused("dx\n0,0,0,0,1,0,1\n", "dx = \"dx\""), "one or two of its three displacements"));
  CHECK(says(refused("dx,dy,dz,beta\n0,0,0,0,1,0,1,0,0,0.9\n", std::string(kSteps) + ", beta = \"beta\""),
             "neither a charge nor a particle"));
  const std::string all = std::string(kSteps) + ", beta = \"beta\", particle = \"pdg\"";
  CHECK(says(refused("dx,dy,dz,beta,pdg\n0,0,0,0,1,0,1,0,0,1.2,11\n", all), "the velocity 1.2"));
  CHECK(says(refused("dx,dy,dz,beta,pdg\n0,0,0,0,1,0,1,0,0,0.9,99\n", all), "no particle with the code 99"));
  CHECK(says(refused("n\n0,0,0,0,1,0,1.5\n", "scintillation_photons = \"n\""), "1.5 photons"));
}
