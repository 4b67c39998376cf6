// The light of deposits: numbers, spread, times and places of photons.
#include <cmath>
#include <map>

#include "event_scene.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/source/detail/gamma/cross_sections.hpp"
#include "scintray/source/detail/scintillation_source.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::scene_file;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

/// Largest deviation in standard errors: a false alarm once in 16,000.
constexpr double kSigmas = 4.0;

Medium scintillator(double yield_per_keV) {
  Medium medium;
  medium.yield_per_keV = yield_per_keV;
  return medium;
}

struct Spread {
  double mean = 0.0, variance = 0.0, mean_error = 0.0, variance_error = 0.0;
};

/// Photon numbers of many deposits; the error of the variance is that of a normal distribution.
Spread photon_numbers(const Medium& medium, double energy_keV, int deposits) {
  Rng rng(7, StreamKind::other, 1);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < deposits; ++i) {
    const auto n = static_cast<double>(sample_photon_number(medium, energy_keV, rng));
    sum += n;
    squares += n * n;
  }
  Spread spread;
  spread.mean = sum / deposits;
  spread.variance = (squares - sum * sum / deposits) / (deposits - 1);
  spread.mean_error = std::sqrt(spread.variance / deposits);
  spread.variance_error = spread.variance * std::sqrt(2.0 / (deposits - 1));
  return spread;
}

}  // namespace

TEST_CASE("The number of photons is Poisson about yield times energy") {
  for (const double energy : {0.1, 1.0, 30.0, 511.0}) {
    CAPTURE(energy);
    const Spread spread = photon_numbers(scintillator(25.0), energy, 20'000);
    CHECK(std::abs(spread.mean - 25.0 * energy) < kSigmas * spread.mean_error);
    // A Poisson variance has fourth moments beyond a normal one's: 1 / mean more.
    const double error = spread.variance * std::sqrt((2.0 + 1.0 / (25.0 * energy)) / 20'000);
    CHECK(std::abs(spread.variance - 25.0 * energy) < kSigmas * error);
  }
  Rng rng(1, StreamKind::other, 1);
  CHECK(sample_photon_number(scintillator(25.0), 0.0, rng) == 0);
}

TEST_CASE("The intrinsic resolution holds at its energy and falls with the square root of others") {
  Medium medium = scintillator(25.0);
  medium.intrinsic_fwhm = 0.09;
  medium.intrinsic_keV = 662.0;
  for (const double energy : {166.0, 662.0}) {
    CAPTURE(energy);
    const Spread spread = photon_numbers(medium, energy, 40'000);
    CHECK(std::abs(spread.mean - 25.0 * energy) < kSigmas * spread.mean_error);
    const double sigma = 0.09 / 2.3548200450309493 * 25.0 * std::sqrt(662.0 * energy);
    CHECK(std::abs(spread.variance - (sigma * sigma + 25.0 * energy)) < kSigmas * spread.variance_error);
  }
}

TEST_CASE("A deposit has the light of its own energy where the response is not proportional") {
  Medium medium = scintillator(25.0);
  medium.relative_yield = Curve({10.0, 100.0, 662.0}, {0.6, 0.9, 1.0});
  for (const auto& row :
       {std::pair{10.0, 0.6}, {55.0, 0.75}, {100.0, 0.9}, {662.0, 1.0}, {5.0, 0.6}, {1000.0, 1.0}}) {
    const auto& energy = row.first;
    const auto& relative = row.second;
    CAPTURE(energy);
    const Spread spread = photon_numbers(medium, energy, 4'000);
    CHECK(std::abs(spread.mean - 25.0 * energy * relative) < kSigmas * spread.mean_error);
  }
}

TEST_CASE("Photons start where and when their deposit is, after the decay of its medium") {
  const Scene scene = lso_cube(10.0);
  class TwoDeposits : public EventSource {
   public:
    explicit TwoDeposits(RegionId region) : region_(region) {}
    std::uint64_t events() const override { return 1; }
    Event make(const Scene&, std::uint64_t, Rng&) const override {
      Event event;
      event.deposits = {{Vec3(1, 2, 3), region_, 300.0, 0.0}, {Vec3(-1, 0, 2), region_, 100.0, 50.0}};
      return event;
    }

   private:
    RegionId region_;
  };
  const RegionId crystal = scene.locate(Vec3::Zero());
  const ScintillationSource source(std::make_unique<TwoDeposits>(crystal), scene);
  EventLight light;
  Rng event_rng(1, StreamKind::event, 0);
  source.begin(scene, 0, event_rng, light);
  REQUIRE(light.deposits.size() == 2);
  CHECK(light.photons == light.deposits.back().all);
  const Medium& lso = scene.media[scene.regions[crystal].medium].medium();
  const double mean = 300.0 * lso.yield_per_keV;
  const double intrinsic =
      lso.intrinsic_fwhm / kFwhmPerSigma * lso.yield_per_keV * std::sqrt(lso.intrinsic_keV * 300.0);
  CHECK(std::abs(static_cast<double>(light.deposits[0].all) - mean) <
        kSigmas * std::sqrt(mean + intrinsic * intrinsic));

  Moments first, second, along;
  for (std::uint64_t i = 0; i < light.photons; ++i) {
    Rng rng(1, StreamKind::photon, 0, i);
    const Photon photon = source.emit(scene, light, i, rng);
    const bool of_first = i < light.deposits[0].all;
    CHECK(photon.position == (of_first ? Vec3(1, 2, 3) : Vec3(-1, 0, 2)));
    CHECK(photon.region == crystal);
    (of_first ? first : second).add(photon.time_ns);
    along.add(photon.ray.direction.z());
    CHECK(std::abs(photon.ray.direction.dot(photon.ray.polarisation)) < 1e-9);
  }
  // LSO decays with 40 ns.
  CHECK(std::abs(first.mean().value - 40.0) < kSigmas * first.mean().error);
  CHECK(std::abs(second.mean().value - 90.0) < kSigmas * second.mean().error);
  CHECK(std::abs(along.mean().value) < kSigmas * along.mean().error);
}

namespace {

/// Mean number of Cherenkov photons of a gamma that is absorbed in LSO, by recursion over its energy: Klein
/// and Nishina's formula for free electrons, K photoelectrons less their binding energy, X-rays without
/// light.
class AbsorbedGamma {
 public:
  AbsorbedGamma(const Medium& medium, const CherenkovEmitter& emitter)
      : matter_(medium.composition, medium.density_g_per_cm3), emitter_(emitter) {}

  double photons(double energy_keV) const {
    constexpr double kLeast_keV = 60.0;  // no electron below is above the threshold of 100 keV
    if (energy_keV < kLeast_keV) return 0.0;
    const ElementData lutetium(71);  // absorbs nearly all
    const double photo = matter_.per_mm(GammaProcess::photoelectric, energy_keV);
    const double compton = matter_.per_mm(GammaProcess::compton, energy_keV);
    const double k = lutetium.k_shell().share;
    const double of_photo = k * emitter_.mean_photons(energy_keV - lutetium.k_shell().edge_keV) +
                            (1.0 - k) * emitter_.mean_photons(energy_keV);
    double sum = 0.0, weights = 0.0;
    constexpr int kCosines = 60;
    for (int i = 0; i < kCosines; ++i) {
      const double cosine = -1.0 + 2.0 * (i + 0.5) / kCosines;
      const double after = compton_energy_keV(energy_keV, cosine), ratio = after / energy_keV;
      const double weight = ratio * ratio * (ratio + 1.0 / ratio - 1.0 + cosine * cosine);
      weights += weight;
      sum += weight * (emitter_.mean_photons(energy_keV - after) + interpolated(after));
    }
    return (photo * of_photo + compton * sum / weights) / (photo + compton);
  }

 private:
  /// Values at 10 keV steps, each made once.
  double interpolated(double energy_keV) const {
    const double step = energy_keV / 10.0;
    const auto below = static_cast<std::size_t>(step);
    return std::lerp(at(below), at(below + 1), step - static_cast<double>(below));
  }
  double at(std::size_t step) const {
    const auto [known, is_new] = known_.try_emplace(step, 0.0);
    if (is_new) {
      const double value = photons(10.0 * static_cast<double>(step));
      known_[step] = value;
      return value;
    }
    return known->second;
  }

  GammaMatter matter_;
  const CherenkovEmitter& emitter_;
  mutable std::map<std::size_t, double> known_;
};

}  // namespace

TEST_CASE("Cherenkov light of an absorbed gamma is that of its electrons, not of one with all its energy") {
  const Scene scene = lso_cube(10.0);
  const auto source = event_source(
      "type = \"gamma_events\"\nevents = 4000\nregion = { part = \"crystal\" }\nenergy = \"511 keV\"\n"
      "cherenkov = true\n",
      scene);
  const Medium& lso = scene.media[scene.regions[scene.locate(Vec3::Zero())].medium].medium();
  const CherenkovEmitter emitter(lso, 400.0, 500.0);
  Moments photons;
  for (std::uint64_t i = 0; i < source->events(); ++i) {
    const Event event = make_event(*source, scene, i);
    CHECK(deposited_keV(event) == doctest::Approx(511.0).epsilon(1e-12));
    double mean = 0.0;
    for (const Deposit& deposit : event.deposits) {
      CHECK(deposit.position == event.deposits.front().position);
      mean += emitter.mean_photons(deposit.energy_keV);
    }
    photons.add(mean);
  }
  const double expected = AbsorbedGamma(lso, emitter).photons(511.0);
  MESSAGE("Cherenkov photons of 511 keV in LSO, 400 to 500 nm: "
          << photons.mean().value << ", of one electron " << emitter.mean_photons(511.0));
  // Electrons bound in atoms take 1 % more or less than free ones.
  CHECK(std::abs(photons.mean().value - expected) < kSigmas * photons.mean().error + 0.02 * expected);
  CHECK(emitter.mean_photons(511.0) > 1.25 * photons.mean().value);

  // One electron where the scene sets it, and where the light does not depend on it.
  for (const std::string other : {"cherenkov = true\nparticle = \"electron\"\n", ""}) {
    const auto one = event_source(
        "type = \"gamma_events\"\nevents = 5\nregion = { part = \"crystal\" }\nenergy = \"511 keV\"\n" +
            other,
        scene);
    CHECK(make_event(*one, scene, 0).deposits.size() == 1);
  }
}

TEST_CASE("Cherenkov light has the wavelengths that the scene states, beyond those of the scintillation") {
  const auto text_of = [](const std::string& range) {
    return "ambient = \"vacuum\"\n" + box_part("crystal", "glowing", Vec3::Constant(10.0)) + R"(
[source]
type = "gamma_events"
events = 1
region = { part = "crystal" }
energy = "511 keV"
)" + range +
           R"([media.glowing]
density = { value = "7.4 g/cm3" }
composition = { formula = "Lu2SiO5" }
index = { n = 1.82 }
absorption = { none = true }
scattering = { none = true }
yield = { value = "25 1/keV" }
emission = { spectrum = { wavelength = [400, 500], wavelength_unit = "nm", value = [1, 1] } }
decay = [{ time = "40 ns", rise = "0 ns", fraction = 1 }]
[surfaces.flat]
model = "smooth"
)";
  };
  const auto build = [&](const std::string& range) {
    return SceneBuilder().build(SceneFile::from_text(text_of(range), scene_path()).spec(0)).scene;
  };
  std::map<double, double> photons;  // by the longest wavelength
  for (const std::string range :
       {"cherenkov = true\n", "cherenkov = true\ncherenkov_range = [\"310 nm\", \"750 nm\"]\n"}) {
    const SceneSpec spec = SceneFile::from_text(text_of(range), scene_path()).spec(0);
    const Scene scene = build(range);
    std::vector<std::string> notes;
    const auto source = make_light_source(spec, scene, &notes);
    CHECK(notes.size() == (scene.high_nm == 500.0 ? 1 : 0));  // the range is stated, or noted
    EventLight light;
    Rng event_rng(1, StreamKind::event, 0);
    source->begin(scene, 0, event_rng, light);
    double prompt = 0.0;
    for (std::uint64_t i = 0; i < light.photons; ++i) {
      Rng rng(1, StreamKind::photon, 0, i);
      const Photon photon = source->emit(scene, light, i, rng);
      CHECK(photon.wavelength_nm >= scene.low_nm);
      CHECK(photon.wavelength_nm <= scene.high_nm);
      prompt += photon.time_ns == 0.0;
    }
    photons[scene.high_nm] = prompt;
  }
  REQUIRE(photons.size() == 2);
  CHECK(photons.contains(750.0));
  // Without dispersion in proportion to 1/low - 1/high: 3.78 times the photons, within 4 sigma of counts.
  const double ratio = (1.0 / 310.0 - 1.0 / 750.0) / (1.0 / 400.0 - 1.0 / 500.0);
  CHECK(std::abs(photons[750.0] - ratio * photons[500.0]) <
        kSigmas * std::sqrt(photons[750.0] + ratio * ratio * photons[500.0]));
  CHECK(says(complaint([&] { build("cherenkov_range = [\"310 nm\", \"750 nm\"]\n"); }),
             "add cherenkov = true"));
  CHECK(says(complaint([&] { build("cherenkov = true\ncherenkov_range = [\"750 nm\", \"310 nm\"]\n"); }),
             "the wavelengths of Cherenkov light rise"));
}

TEST_CASE("Cherenkov light is prompt, and as much as electrons of the deposits' energies make") {
  // The wavelengths in use are those that LSO emits.
  const std::string text = "ambient = \"vacuum\"\n" + box_part("crystal", "LSO", Vec3::Constant(10.0)) + R"(
[source]
type = "gamma_events"
events = 1
region = { part = "crystal" }
energy = "420 keV"
[surfaces.flat]
model = "smooth"
)";
  const Scene scene = SceneBuilder().build(SceneFile::from_text(text, scene_path()).spec(0)).scene;
  REQUIRE(scene.high_nm > scene.low_nm);
  class OneDeposit : public EventSource {
   public:
    explicit OneDeposit(RegionId region) : region_(region) {}
    std::uint64_t events() const override { return 2000; }
    Event make(const Scene&, std::uint64_t, Rng&) const override {
      Event event;
      event.deposits = {{Vec3::Zero(), region_, 420.0, 3.0}};
      return event;
    }

   private:
    RegionId region_;
  };
  const RegionId crystal = scene.locate(Vec3::Zero());
  const ScintillationSource source(std::make_unique<OneDeposit>(crystal), scene, {.cherenkov = true});
  const CherenkovEmitter alone(scene.media[scene.regions[crystal].medium].medium(), scene.low_nm,
                               scene.high_nm);
  double photons = 0.0;
  for (std::uint64_t number = 0; number < source.events(); ++number) {
    EventLight light;
    Rng event_rng(1, StreamKind::event, number);
    source.begin(scene, number, event_rng, light);
    photons += static_cast<double>(light.deposits[0].all - light.deposits[0].scintillation);
    for (std::uint64_t i = light.deposits[0].scintillation; i < light.photons; ++i) {
      Rng rng(1, StreamKind::photon, number, i);
      const Photon photon = source.emit(scene, light, i, rng);
      CHECK(photon.time_ns == 3.0);
      CHECK(photon.wavelength_nm >= scene.low_nm);
      CHECK(photon.wavelength_nm <= scene.high_nm);
    }
  }
  const double expected = 2000.0 * alone.mean_photons(420.0);
  CHECK(expected > 0.0);
  CHECK(std::abs(photons - expected) < kSigmas * std::sqrt(expected));
}
