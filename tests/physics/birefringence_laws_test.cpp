/// Birefringent media in whole scenes, against closed forms.

#include <cmath>

#include "physics/traced.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/source/photon_optics.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;

namespace {

constexpr double kOrdinary = 1.66, kExtraordinary = 1.49;

/// A beam along z through a plate of 5 mm, whose optic axis is at 45 deg to the beam in the x-z plane,
/// polarised at an azimuth to x.
std::string plate(double azimuth_rad, const std::string& absorption = "{ none = true }",
                  const std::string& scattering = "{ none = true }") {
  return fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "plate"
box = ["10 mm", "10 mm", "5 mm"]
medium = "spar"
surface = "flat"
principal_axes = {{ z = [1, 0, 1] }}
[source]
type = "photons"
position = ["0 mm", "0 mm", "-1 mm"]
direction = [0, 0, 1]
polarisation = [{}, {}, 0]
wavelength = "500 nm"
photons = 1
[media.spar]
index = {{ n = {}, z = {{ n = {} }} }}
absorption = {}
scattering = {}
)",
                     std::cos(azimuth_rad), std::sin(azimuth_rad), kOrdinary, kExtraordinary, absorption,
                     scattering);
}

/// What arrives behind a plate without reflection at its back.
struct Behind {
  std::uint64_t photons = 0, ordinary = 0, extraordinary = 0, absorbed = 0;
  Moments ordinary_ns, extraordinary_ns;
  std::uint64_t astray = 0;  ///< photons at neither of the two places
};

/// @param shift_mm  of the extraordinary ray along x behind the plate
Behind trace_plate(const std::string& text, double shift_mm) {
  const scene_file::SceneSpec spec = scene_spec(text);
  scene::SceneBuilder builder;
  const scene::BuiltScene built = builder.build(spec);
  const PhotonSource source(spec.source, built.scene);
  Behind behind;
  for (std::uint64_t i = 0; i < 100'000; ++i) {
    Rng rng(17, StreamKind::photon, i);
    source::Photon photon = source.emit(built.scene, rng);
    ++behind.photons;
    if (transport::step(built.scene, photon, rng).event != StepEvent::transmitted) continue;
    const double start_ns = photon.time_ns;
    const transport::Step last = transport::step(built.scene, photon, rng);
    behind.absorbed += last.event == StepEvent::absorbed_in_medium;
    if (last.event != StepEvent::transmitted) continue;
    constexpr double kPlace_mm = 1e-9;
    const double x = photon.position.x(), time_ns = photon.time_ns - start_ns;
    behind.astray += std::abs(photon.position.y()) > kPlace_mm ||
                     (photon.ray.direction.vec() - Vec3::UnitZ()).norm() > kPlace_mm;
    if (std::abs(x) < kPlace_mm) {
      ++behind.ordinary;
      behind.ordinary_ns.add(time_ns);
    } else if (std::abs(x - shift_mm) < kPlace_mm) {
      ++behind.extraordinary;
      behind.extraordinary_ns.add(time_ns);
    } else {
      ++behind.astray;
    }
  }
  return behind;
}

const double kOrdinary2 = kOrdinary * kOrdinary, kExtraordinary2 = kExtraordinary * kExtraordinary;
/// Extraordinary wave at 45 deg to the optic axis.
const double kIndexAt45 = 1.0 / std::sqrt(0.5 / kOrdinary2 + 0.5 / kExtraordinary2);
const double kTanWalkOff = (kOrdinary2 - kExtraordinary2) / (kOrdinary2 + kExtraordinary2);

double through_two_faces(double n) { return std::pow(4.0 * n / ((1.0 + n) * (1.0 + n)), 2); }

}  // namespace

TEST_CASE("Birefringent plate: two rays, by Malus's law, at the splitting angle, each with its delay") {
  for (const double azimuth : {0.0, 0.5, 1.2}) {
    const Behind behind = trace_plate(plate(azimuth), -5.0 * kTanWalkOff);
    CHECK(behind.astray == 0);
    check_law(fmt::format("ordinary, azimuth {}", azimuth),
              binomial_estimate(behind.ordinary, behind.photons),
              {through_two_faces(kOrdinary) * std::pow(std::sin(azimuth), 2), 0.0});
    check_law(fmt::format("extraordinary, azimuth {}", azimuth),
              binomial_estimate(behind.extraordinary, behind.photons),
              {through_two_faces(kIndexAt45) * std::pow(std::cos(azimuth), 2), 0.0});
    if (azimuth > 0.0)
      CHECK(behind.ordinary_ns.mean().value ==
            doctest::Approx(5.0 * kOrdinary / kSpeedOfLight_mm_per_ns).epsilon(1e-9));
    // The energy goes a longer way, with the speed along the ray: the delay is that of the wave.
    CHECK(behind.extraordinary_ns.mean().value ==
          doctest::Approx(5.0 * kIndexAt45 / kSpeedOfLight_mm_per_ns).epsilon(1e-9));
  }
}

TEST_CASE("Dichroic plate: each ray is attenuated with the coefficient of its field") {
  const double along_x = 0.2, along_z = 0.05;  // per mm
  const Behind behind = trace_plate(
      plate(0.7, fmt::format("{{ coefficient = \"{} 1/mm\", z = {{ coefficient = \"{} 1/mm\" }} }}", along_x,
                             along_z)),
      -5.0 * kTanWalkOff);
  check_law("ordinary", binomial_estimate(behind.ordinary, behind.photons),
            {through_two_faces(kOrdinary) * std::pow(std::sin(0.7), 2) * std::exp(-5.0 * along_x), 0.0});
  // A wave of imaginary index: 1 / n^2 = cos^2 / n_o^2 + sin^2 / n_e^2 with complex n_o and n_e, to first
  // order.
  const double per_mm = 0.5 * std::pow(kIndexAt45, 3) *
                        (along_x / std::pow(kOrdinary, 3) + along_z / std::pow(kExtraordinary, 3));
  check_law("extraordinary", binomial_estimate(behind.extraordinary, behind.photons),
            {through_two_faces(kIndexAt45) * std::pow(std::cos(0.7), 2) * std::exp(-5.0 * per_mm), 0.0});
}

TEST_CASE("Scattering of a mode: Rayleigh's with the emission along its field, particles without") {
  const std::string scattering =
      "{ length = \"10 mm\", kind = \"rayleigh\" }\nparticles = { length = \"5 mm\", forward = 0.9 }";
  const scene_file::SceneSpec spec = scene_spec(plate(0.0, "{ none = true }", scattering));
  scene::SceneBuilder builder;
  const scene::BuiltScene built = builder.build(spec);
  Rng rng(18, StreamKind::photon, 0);
  source::Photon photon = PhotonSource(spec.source, built.scene).emit(built.scene, rng);
  photon.region = RegionId(1);  // the plate
  photon.ray.direction = Vec3(Vec3::UnitY());
  const double mean_index =
      built.scene.optics.at(built.scene.regions[photon.region].medium, photon.wavelength_nm).index;
  const double along = 4.0 * kOrdinary2 / (kExtraordinary2 + 3.0 * kOrdinary2);  // relative to across
  for (const bool extraordinary : {false, true}) {
    photon.ray.polarisation = Vec3(1.0, 0.0, extraordinary ? 1.0 : -1.0).normalized();
    source::take_mode(built.scene, photon, rng);
    const double n = extraordinary ? kExtraordinary : kOrdinary,
                 emission = 3.0 * (extraordinary ? along : 1.0) / (2.0 + along);
    CHECK(source::scattering_by_particles(built.scene, photon) ==
          doctest::Approx(0.2 * mean_index / n).epsilon(1e-9));
    CHECK(photon.optics.scattering_per_mm ==
          doctest::Approx((0.2 + 0.1 * emission) * mean_index / n).epsilon(1e-7));
  }
}

TEST_CASE(
    "Kirchhoff: light between a birefringent crystal and a scattering medium around it, in equilibrium") {
  // Absorption in proportion to 1 / index by axis is that of dipoles of random orientation, as is the
  // emission: then the share that the crystal absorbs of the light of the medium, times what the medium emits
  // in equilibrium, is the share the other way times what the crystal emits, whatever the surfaces and
  // scattering.
  const double no = 1.4, ne = 2.4, host = 1.3, crystal_per_mm = 0.02, host_per_mm = 0.01;
  const auto absorbed_elsewhere = [&](const std::string& start, const std::string& kind) {
    const Traced traced =
        trace(fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "host"
box = ["16 mm", "16 mm", "16 mm"]
medium = "host"
surface = "white"
[[part]]
name = "crystal"
box = ["9 mm", "8 mm", "8 mm"]
translate = ["0.5 mm", "0 mm", "4 mm"]
rotate = [{{ axis = [1, 2, 3], angle = "10 deg" }}]
medium = "crystal"
surface = "flat"
principal_axes = {{ z = [1, 2, -1], x = [1, 0, 1] }}
[source]
type = "photons"
region = {{ part = "{}" }}
wavelength = "500 nm"
photons = 100000
[media.host]
index = {{ n = {} }}
absorption = {{ coefficient = "{} 1/mm" }}
scattering = {{ length = "10 mm", kind = "rayleigh" }}
[media.crystal]
index = {{ n = {}, z = {{ n = {} }} }}
absorption = {{ coefficient = "{} 1/mm", z = {{ coefficient = "{} 1/mm" }} }}
scattering = {{ length = "2 mm", kind = "{}" }}
)",
                          start, host, host_per_mm, no, ne, crystal_per_mm / no, crystal_per_mm / ne, kind));
    const scene::Scene& scene = traced.built.scene;
    std::uint64_t elsewhere = 0, all = 0;
    const std::string other = start == "host" ? "crystal" : "host";
    for (const scene::Region& region : scene.regions) {
      if (!region.part.has_value()) continue;
      const std::uint64_t count = traced.result.absorbed_in_medium[region.medium];
      all += count;
      if (scene.parts[region.part].name == other) elsewhere += count;
    }
    CHECK(all == 100'000);
    return binomial_estimate(elsewhere, 100'000);
  };
  // What the crystal emits: n / cos^2 for each of its waves, over the sphere, cos that of the angle between
  // ray and wave normal; in the plane of the optic axis E = D / n_i^2.
  double crystal = 0.0;
  constexpr int kSteps = 10'000;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps, across = std::sqrt(1.0 - u * u);
    const double ex = u / (no * no), ez = across / (ne * ne);
    const double n = 1.0 / std::sqrt(u * ex + across * ez);
    crystal += (no + n * (ex * ex + ez * ez) / std::pow(u * ex + across * ez, 2)) / kSteps;
  }
  const double crystal_mm3 = 9.0 * 8.0 * 8.0, host_mm3 = 16.0 * 16.0 * 16.0 - crystal_mm3;
  const double emitted = crystal_mm3 * crystal * crystal_per_mm,
               emitted_by_host = host_mm3 * 2.0 * host * host * host_per_mm;
  for (const std::string kind : {"isotropic", "rayleigh"}) {
    const Estimate to_crystal = absorbed_elsewhere("host", kind),
                   to_host = absorbed_elsewhere("crystal", kind);
    const double ratio = to_crystal.value / to_host.value;
    const double error =
        ratio * std::hypot(to_crystal.error / to_crystal.value, to_host.error / to_host.value);
    check_law(kind + " scattering: share into the crystal over share out of it", {ratio, error},
              {emitted / emitted_by_host, 0.0});
  }
}
