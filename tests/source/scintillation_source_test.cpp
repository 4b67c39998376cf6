// The light of deposits: numbers, spread, times and places of photons.
#include <cmath>
#include <map>

#include "event_scene.hpp"
#include "scintray/core/statistics.hpp"
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
  const double per_keV = scene.media[scene.regions[crystal].medium].medium().yield_per_keV;
  CHECK(std::abs(static_cast<double>(light.deposits[0].all) - 300.0 * per_keV) <
        kSigmas * std::sqrt(300.0 * per_keV));

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
