#include <cmath>

#include "physics/traced.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;

namespace {

/// A beam along z in a medium of particles; further keys of its [particles] and of the medium.
std::string cloud(const std::string& particles, const std::string& scattering, const std::string& source) {
  return R"(
ambient = "vacuum_n1"
[[part]]
name = "cloud"
box = ["10 m", "10 m", "10 m"]
medium = "cloud"
surface = "flat"
[source]
type = "photons"
position = ["0 mm", "0 mm", "5000 mm"]
direction = [0, 0, 1]
wavelength = "400 nm"
photons = 1
)" + source +
         R"([media.cloud]
index = { n = 1.0 }
absorption = { none = true }
scattering = )" +
         scattering + "\nparticles = { length = \"1 mm\", " + particles + " }\n";
}

struct Scattered {
  Moments cosine, square;
  std::uint64_t wrong = 0;
};

Scattered scatter_once(const std::string& text) {
  const scene_file::SceneSpec spec = scene_spec(text);
  scene::SceneBuilder builder;
  const scene::BuiltScene built = builder.build(spec);
  const PhotonSource source(spec.source, built.scene);
  Scattered scattered;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    Rng rng(41, StreamKind::photon, i);
    source::Photon photon = source.emit(built.scene, rng);
    const transport::Step taken = transport::step(built.scene, photon, rng);
    const Vec3 direction = photon.ray.direction;
    scattered.wrong += taken.event != StepEvent::scattered || std::abs(direction.norm() - 1.0) > 1e-9 ||
                       std::abs(photon.ray.polarisation.dot(direction)) > 1e-9;
    scattered.cosine.add(direction.z());
    scattered.square.add(direction.z() * direction.z());
  }
  return scattered;
}

}  // namespace

TEST_CASE("Henyey and Greenstein: the mean cosine is g, the mean of its square (1 + 2 g^2) / 3") {
  // The second Legendre coefficient of their phase function is g^2.
  for (const double g : {-0.6, 0.0, 0.3, 0.9, 0.99}) {
    const Scattered scattered =
        scatter_once(cloud(fmt::format("forward = {}", g), "{ none = true }", "polarisation = \"random\"\n"));
    CHECK(scattered.wrong == 0);
    check_law(fmt::format("mean cosine, g = {}", g), scattered.cosine.mean(), {g, 0.0});
    check_law(fmt::format("mean square, g = {}", g), scattered.square.mean(),
              {(1.0 + 2.0 * g * g) / 3.0, 0.0});
  }
}

TEST_CASE("Particles of two lobes: the backward lobe is counted from the reversed ray") {
  const Scattered scattered = scatter_once(cloud("forward = 0.9, backward = 0.4, forward_share = 0.7",
                                                 "{ none = true }", "polarisation = \"unpolarised\"\n"));
  check_law("mean cosine", scattered.cosine.mean(), {0.7 * 0.9 - 0.3 * 0.4, 0.0});
}

TEST_CASE("Particles beside Rayleigh scattering: each scatters by its coefficient") {
  // 1/mm by particles and 1/(0.5 mm) by molecules, whose mean cosine is 0: the mean is a third of g.
  const Scattered scattered = scatter_once(
      cloud("forward = 0.9", "{ kind = \"rayleigh\", length = \"0.5 mm\" }", "polarisation = \"random\"\n"));
  CHECK(scattered.wrong == 0);
  check_law("mean cosine", scattered.cosine.mean(), {0.3, 0.0});
}

TEST_CASE("A group index that is given sets the time of flight, whatever the slope of the index") {
  std::string text = cloud("forward = 0", "{ none = true }", "");
  text.replace(text.find("index = { n = 1.0 }"), 19,
               "index = { n = { wavelength = [300, 500], wavelength_unit = \"nm\", value = [1.9, 1.5] }, "
               "group = 2.25 }");
  const scene_file::SceneSpec spec = scene_spec(text);
  scene::SceneBuilder builder;
  const scene::BuiltScene built = builder.build(spec);
  const PhotonSource source(spec.source, built.scene);
  Rng rng(42, StreamKind::photon, 0);
  source::Photon photon = source.emit(built.scene, rng);
  CHECK(photon.optics.index == doctest::Approx(1.7));
  transport::step(built.scene, photon, rng);
  CHECK(photon.path_mm > 0.0);
  CHECK(photon.time_ns == doctest::Approx(2.25 * photon.path_mm / kSpeedOfLight_mm_per_ns));
}
