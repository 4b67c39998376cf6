#include <cmath>

#include "physics/traced.hpp"
#include "scintray/transport/step.hpp"
#include "support/photon_source.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::transport;
using namespace scintray::tally;
using namespace scintray::test;

namespace {

constexpr double kLength_mm = 2.0;  ///< of absorption by the shifter
constexpr double kYield = 0.8;

/// A dye that absorbs at 400 nm only and re-emits 480 to 560 nm, which the medium absorbs with
/// `clear_per_mm`, in a medium without surfaces to vacuum.
std::string dye(double clear_per_mm, double yield = kYield) {
  return fmt::format(R"(
[media.dye]
index = {{ n = 1.0 }}
absorption = {{ coefficient = {{ wavelength = [400, 450, 460, 600], wavelength_unit = "nm", value = [0, 0, {0}, {0}], value_unit = "1/mm" }} }}
scattering = {{ none = true }}
[media.dye.wavelength_shifting]
absorption = {{ coefficient = {{ wavelength = [400, 440, 450, 600], wavelength_unit = "nm", value = [{1}, {1}, 0, 0], value_unit = "1/mm" }} }}
quantum_yield = {{ value = {2} }}
emission = {{ spectrum = {{ wavelength = [480, 520, 560], wavelength_unit = "nm", value = [0, 1, 0] }} }}
decay = [{{ time = "10 ns", rise = "2 ns", fraction = 1 }}]
)",
                     clear_per_mm, 1.0 / kLength_mm, yield);
}

/// A wide slab between z = 0 and `thickness`, lit along z from its lower face, between two sensors.
std::string slab_scene(double thickness_mm, const std::string& medium) {
  return fmt::format(R"(
ambient = "vacuum_n1"
[[part]]
name = "slab"
box = {{ low = ["-500 mm", "-500 mm", "0 mm"], high = ["500 mm", "500 mm", "{0} mm"] }}
medium = "dye"
surface = "flat"
[[part]]
name = "below"
box = {{ low = ["-500 mm", "-500 mm", "-1 mm"], high = ["500 mm", "500 mm", "0 mm"] }}
medium = "vacuum_n1"
sensor = "perfect_n1"
[[part]]
name = "above"
box = {{ low = ["-500 mm", "-500 mm", "{0} mm"], high = ["500 mm", "500 mm", "{1} mm"] }}
medium = "vacuum_n1"
sensor = "perfect_n1"
[source]
type = "photons"
position = ["0 mm", "0 mm", "1e-9 mm"]
direction = [0, 0, 1]
wavelength = "400 nm"
photons = 200_000
)",
                     thickness_mm, thickness_mm + 1.0) +
         medium;
}

MediumId medium_id(const Scene& scene, const std::string& name) {
  for (const MediumId id : scene.media.ids())
    if (scene.media[id].medium().name == name) return id;
  FAIL("no medium " << name);
  return MediumId::none();
}

Estimate detected_in(const Traced& traced, const std::string& part) {
  std::uint64_t detected = 0;
  for (const SensorFaceCount& count : traced.result.sensor_faces)
    if (traced.built.scene.parts[count.part].name == part) detected += count.detected;
  return binomial_estimate(detected, traced.result.photons);
}

/// Exponential integral E2(x) = integral over t from 0 to 1 of exp(-x / t), by the midpoint rule.
double e2(double x) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += std::exp(-x * kSteps / (i + 0.5));
  return sum / kSteps;
}

/// Share of the light of exp(-z / length) that is re-emitted and leaves through a face at depth `face`.
double leaves_through(double face_mm, double thickness_mm, double clear_per_mm) {
  constexpr int kSteps = 400;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = thickness_mm * (i + 0.5) / kSteps;
    sum += std::exp(-z / kLength_mm) / kLength_mm * 0.5 * e2(clear_per_mm * std::abs(face_mm - z));
  }
  return kYield * sum * thickness_mm / kSteps;
}

}  // namespace

TEST_CASE("Law: a slab with a dye, re-emitted light leaves through both faces by E2") {
  constexpr double kThickness = 3.0, kClear = 0.1;
  const Traced traced = trace(slab_scene(kThickness, dye(kClear)));
  const double passes = std::exp(-kThickness / kLength_mm);
  const ShiftCount& shifted = traced.result.shifted_in_medium[medium_id(traced.built.scene, "dye")];
  check_law("absorbed by the dye", binomial_estimate(shifted.absorbed, traced.result.photons),
            {1.0 - passes, 0.0});
  check_law("re-emitted", binomial_estimate(shifted.emitted, traced.result.photons),
            {kYield * (1.0 - passes), 0.0});
  check_law("upwards", detected_in(traced, "above"),
            {passes + leaves_through(kThickness, kThickness, kClear), 0.0});
  check_law("downwards", detected_in(traced, "below"), {leaves_through(0.0, kThickness, kClear), 0.0});
}

TEST_CASE("Every photon that a shifter absorbs is re-emitted or absorbed, and so is its energy") {
  const Traced traced = trace(slab_scene(3.0, dye(0.0)));
  const PointResult& result = traced.result;
  const MediumId dyed = medium_id(traced.built.scene, "dye");
  const ShiftCount& shifted = result.shifted_in_medium[dyed];
  // Nothing else absorbs, and no photon is absorbed twice.
  CHECK(shifted.absorbed - shifted.emitted == result.absorbed_in_medium[dyed]);
  CHECK(result.count(Fate::absorbed_in_medium) == result.absorbed_in_medium[dyed]);
  CHECK(result.shifted().absorbed == shifted.absorbed);
  const double energy = photon_energy_eV(400.0);
  // The same for any number of threads, to the last bit.
  CHECK((trace(slab_scene(3.0, dye(0.0)), 1).result.shifted_in_medium == result.shifted_in_medium));
  CHECK(shifted.before_eV == doctest::Approx(energy * static_cast<double>(shifted.emitted)).epsilon(1e-9));
  CHECK(shifted.kept_eV ==
        doctest::Approx(energy * static_cast<double>(shifted.absorbed - shifted.emitted)).epsilon(1e-9));
  // Mean of 1 / wavelength over the triangle of 480 to 560 nm about 520 nm.
  const auto xlogx = [](double x) { return x * std::log(x); };
  const double inverse = (xlogx(480.0) + xlogx(560.0) - 2.0 * xlogx(520.0)) / (40.0 * 40.0);
  const double mean_eV = 1239.8419843320026 * inverse;
  // The spread of photon energy is below 0.05 eV (480 to 560 nm: 2.21 to 2.58 eV).
  check_law("mean energy re-emitted, eV",
            {shifted.after_eV / static_cast<double>(shifted.emitted),
             0.05 / std::sqrt(static_cast<double>(shifted.emitted))},
            {mean_eV, 0.0});
}

TEST_CASE("Law: a yield of 1 where nothing else absorbs loses no photon, also past a table's last zero") {
  // The dye's absorption falls to zero within 0.2 nm, between two wavelengths of the grid of bulk optics, in
  // the middle of its own emission: 1 % of the light comes to lie there.
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "ball"
sphere = { radius = "50 mm", subdivisions = 3 }
medium = "dye"
surface = "flat"
[source]
type = "photons"
position = ["0 mm", "0 mm", "0 mm"]
wavelength = "400 nm"
photons = 20_000
[media.dye]
index = { n = 1.0 }
absorption = { none = true }
scattering = { none = true }
[media.dye.wavelength_shifting]
absorption = { coefficient = { wavelength = [400, 450, 450.2, 480], wavelength_unit = "nm", value = [10, 10, 0, 0], value_unit = "1/mm" } }
quantum_yield = { value = 1 }
emission = { spectrum = { wavelength = [440, 480], wavelength_unit = "nm", value = [1, 1] } }
decay = [{ time = "10 ns", rise = "0 ns", fraction = 1 }]
)");
  const Scene& scene = traced.built.scene;
  const MediumId dyed = medium_id(scene, "dye");
  CHECK(traced.result.count(Fate::absorbed_in_medium) == 0);
  CHECK(traced.result.count(Fate::escaped) == traced.result.photons);
  const ShiftCount& shifted = traced.result.shifted_in_medium[dyed];
  CHECK(shifted.absorbed == shifted.emitted);
  // The part of the shifter and the whole, in every bit, at and between the wavelengths of the grid.
  for (double nm = 449.0; nm < 451.0; nm += 0.03)
    CHECK(scene.optics.shifting_at(dyed, nm) == scene.optics.at(dyed, nm).absorption_per_mm);
}

TEST_CASE("Law: light that a dye absorbs repeatedly, 1 / (1 - yield) times in all") {
  // A cube of 1 m with light in its middle, 0.1 mm of absorption at every wavelength: nothing leaves.
  const Traced traced = trace(R"(
ambient = "vacuum_n1"
[[part]]
name = "cube"
box = ["1 m", "1 m", "1 m"]
medium = "dense"
surface = "flat"
[source]
type = "photons"
position = ["0 mm", "0 mm", "500 mm"]
wavelength = "400 nm"
photons = 50_000
[media.dense]
index = { n = 1.0 }
absorption = { none = true }
scattering = { none = true }
[media.dense.wavelength_shifting]
absorption = { length = "0.1 mm" }
quantum_yield = { value = 0.7 }
emission = { spectrum = { wavelength = [480, 560], wavelength_unit = "nm", value = [1, 1] } }
decay = [{ time = "10 ns", rise = "0 ns", fraction = 1 }]
)");
  const ShiftCount shifted = traced.result.shifted();
  const auto photons = static_cast<double>(traced.result.photons);
  CHECK(traced.result.count(Fate::absorbed_in_medium) == traced.result.photons);
  CHECK(shifted.absorbed - shifted.emitted == traced.result.photons);
  // A geometric number of times: variance yield / (1 - yield)^2.
  check_law("times absorbed",
            {static_cast<double>(shifted.absorbed) / photons, std::sqrt(0.7 / photons) / 0.3},
            {1.0 / 0.3, 0.0});
  CHECK(shifted.after_eV < shifted.before_eV);
  // Law of repeated re-emission: the share 1 - u of the flat spectrum that is left is a product of uniform
  // numbers, so that all re-emissions of a photon together have the density y w^-y of w = 1 - u. With w =
  // v^(1 / (1 - y)):
  constexpr int kSteps = 100'000;
  double energy_eV = 0.0;
  for (int i = 0; i < kSteps; ++i)
    energy_eV += photon_energy_eV(560.0 - 80.0 * std::pow((i + 0.5) / kSteps, 1.0 / 0.3)) / kSteps;
  // Energies lie within 2.21 to 2.58 eV; as if each photon had one of its own.
  check_law("mean energy of repeatedly re-emitted light, eV",
            {shifted.after_eV / static_cast<double>(shifted.emitted), 0.1 / std::sqrt(photons)},
            {energy_eV, 0.0});
}

TEST_CASE(
    "Re-emitted light is isotropic, across its polarisation, late by its decay, and never gains energy") {
  for (const std::string polarisation : {"random", "unpolarised"}) {
    std::string text = slab_scene(1000.0, dye(0.0, 1.0));
    text.insert(text.find("photons ="), "polarisation = \"" + polarisation + "\"\n");
    const SceneSpec spec = scene_spec(text);
    SceneBuilder builder;
    const BuiltScene built = builder.build(spec);
    const PhotonSource source(spec.source, built.scene);
    constexpr std::size_t kCosines = 10, kAzimuths = 12;
    constexpr std::uint64_t kPhotons = 60'000;
    std::vector<std::uint64_t> counts(kCosines * kAzimuths, 0);
    Moments delay;
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 0; i < kPhotons; ++i) {
      Rng rng(17, StreamKind::photon, i);
      Photon photon = source.emit(built.scene, rng);
      const Step taken = step(built.scene, photon, rng);
      const double depth = photon.position.z();
      const Vec3& d = photon.ray.direction;
      const bool unpolarised = photon.ray.polarisation.isZero(0.0);
      wrong += taken.event != StepEvent::re_emitted || is_final(taken.event) ||
               photon.wavelength_nm < 480.0 || photon.wavelength_nm > 560.0 ||
               unpolarised != (polarisation == "unpolarised") ||
               std::abs(photon.ray.polarisation.dot(d)) > 1e-9 || photon.optics.absorption_per_mm != 0.0;
      const auto cosine = std::min<std::size_t>(kCosines - 1, static_cast<std::size_t>(5.0 * (d.z() + 1.0)));
      const double turn = (std::atan2(d.y(), d.x()) + kPi) / kTwoPi;
      const auto azimuth = std::min<std::size_t>(kAzimuths - 1, static_cast<std::size_t>(turn * kAzimuths));
      ++counts[cosine * kAzimuths + azimuth];
      delay.add(photon.time_ns - depth / kSpeedOfLight_mm_per_ns);
    }
    CHECK(wrong == 0);
    const std::vector<double> even(counts.size(), static_cast<double>(kPhotons) / (kCosines * kAzimuths));
    // False alarm once in 10,000.
    CHECK(chi_square_test(counts, even).p_value > 1e-4);
    check_law("decay and rise, ns", delay.mean(), {12.0, 0.0});
  }
}

TEST_CASE("A coating on a face is in the ledger of its surface, and its light is the light that leaves") {
  // A crystal with phosphor between one end and a mirror; light at 400 nm, the coating 3 deep.
  const std::string scene = R"(
ambient = "vacuum_n1"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "5 mm"]
medium = "lso_clear"
surface = "flat"
[[part.face]]
name = "far"
select = { normal = [0, 0, 1] }
surface = "phosphor"
[[part]]
name = "sensor"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
medium = "lso_clear"
sensor = "perfect"
[source]
type = "photons"
region = { part = "crystal" }
wavelength = "400 nm"
photons = 50_000
[surfaces.phosphor]
model = "smooth"
gap = "dye"
gap_thickness = "6 mm"
reflectance = 0.9
specular_share = 1
[[tally]]
type = "count"
name = "colour"
at = "detected"
axes = [{ variable = "wavelength", from = "399 nm", to = "599 nm", bins = 2 }]
[run]
max_interactions = 1000
)" + dye(0.0);
  const Traced traced = trace(scene);
  const PointResult& result = traced.result;
  ShiftCount phosphor;
  for (const SurfaceId id : result.shifted_at_surface.ids())
    if (traced.built.scene.surfaces[id].name.starts_with("phosphor"))
      phosphor += result.shifted_at_surface[id];
  CHECK(phosphor.absorbed > 2'000);
  CHECK(phosphor.emitted < phosphor.absorbed);
  CHECK(result.shifted().absorbed == phosphor.absorbed);
  // The mirror takes the others that end at a surface.
  CHECK(phosphor.absorbed - phosphor.emitted <= result.count(Fate::absorbed_at_surface));
  CHECK(phosphor.before_eV ==
        doctest::Approx(photon_energy_eV(400.0) * static_cast<double>(phosphor.emitted)));
  // Detected at 480 nm and more: some, and no more than were re-emitted.
  REQUIRE(result.tallies.size() == 1);
  CHECK(result.tallies[0].sum[0] > 0.0);
  CHECK(result.tallies[0].sum[1] > 1'000.0);
  CHECK(result.tallies[0].sum[1] <= static_cast<double>(phosphor.emitted));
}

TEST_CASE("A scene whose media or sensors do not cover the wavelengths of re-emission is refused") {
  std::string text = slab_scene(1.0, dye(0.0));
  const auto message = [&] {
    SceneBuilder builder;
    try {
      builder.build(scene_spec(text));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("built");
  };
  CHECK(message() == "built");
  const std::string before = text;
  text.replace(
      text.find("quantum_yield = { value = 0.8 }"), 31,
      "quantum_yield = { value = { wavelength = [390, 500], wavelength_unit = \"nm\", value = [1, 1] } }");
  CHECK(
      message().find("medium \"dye\" has quantum yields from 390 to 500 nm, but light of 400 to 560 nm is in "
                     "use") != std::string::npos);
  text = before;
  text +=
      "[sensors.narrow]\nwindow = { index = 1.0 }\nefficiency = { definition = \"internal\", value = { "
      "wavelength = [390, 450], wavelength_unit = \"nm\", value = [1, 1] } }\n";
  text.replace(text.find("sensor = \"perfect_n1\""), 21, "sensor = \"narrow\"");
  CHECK(
      message().find("sensor \"narrow\" has an efficiency from 390 to 450 nm, but light of 400 to 560 nm") !=
      std::string::npos);
}
