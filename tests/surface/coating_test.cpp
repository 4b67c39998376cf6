#include <doctest/doctest.h>

#include <functional>

#include "scintray/core/statistics.hpp"
#include "scintray/optics/surface.hpp"
#include "support/agreement.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

constexpr std::uint64_t kShots = 200'000;
constexpr double kThickness_um = 50.0, kDepth = 0.7;  // optical, across the layer

/// Absorbs below 450 nm, gives everything back between 480 and 560 nm.
std::shared_ptr<const WavelengthShifter> phosphor(double yield = 1.0) {
  const double per_mm = kDepth / (kThickness_um * 1e-3);
  return std::make_shared<const WavelengthShifter>(
      Curve({400.0, 450.0, 451.0, 600.0}, {per_mm, per_mm, 0.0, 0.0}), Curve::constant(yield),
      Curve({480.0, 520.0, 560.0}, {0.0, 1.0, 0.0}), std::vector<DecayComponent>{{50.0, 0.0, 1.0}});
}

Surface coated(Curve gap_index, double yield = 1.0) {
  Surface surface;
  surface.gap_index = std::move(gap_index);
  surface.gap_thickness_um = kThickness_um;
  surface.gap_shifter = phosphor(yield);
  return surface;
}

struct Outcomes {
  std::uint64_t inside = 0, outside = 0, absorbed = 0;  ///< of light re-emitted, and lost
  std::uint64_t passed = 0, returned = 0;               ///< of light that kept its wavelength
  std::uint64_t wrong = 0;  ///< other wavelengths without being re-emitted, directions away from their side
  ShiftCount count;
  Moments delay_ns;
};

/// Light of 400 nm from inside at an incidence.
Outcomes shine(const Surface& surface, double incidence, const std::function<IndexPair(double)>& index) {
  Outcomes outcomes;
  for (std::uint64_t i = 0; i < kShots; ++i) {
    Rng rng(23, StreamKind::other, i);
    Ray ray{Vec3(std::sin(incidence), 0.0, std::cos(incidence)), Vec3::Zero()};
    ShiftingLight light;
    light.wavelength_nm = 400.0;
    light.index = index;
    const SurfaceOutcome outcome = surface.interact(ray, Side::inside, Vec3::UnitZ(), light, rng);
    outcomes.count += light.count;
    const bool shifted = light.count.emitted > 0;
    outcomes.wrong += shifted != (light.wavelength_nm >= 480.0);
    if (shifted) outcomes.delay_ns.add(light.delay_ns);
    if (outcome == SurfaceOutcome::absorbed)
      ++outcomes.absorbed;
    else if (outcome == SurfaceOutcome::inside)
      ++(shifted ? outcomes.inside : outcomes.returned);
    else
      ++(shifted ? outcomes.outside : outcomes.passed);
    outcomes.wrong += outcome != SurfaceOutcome::absorbed &&
                      (ray.direction.z() < 0.0) != (outcome == SurfaceOutcome::inside);
  }
  CHECK(outcomes.wrong == 0);
  return outcomes;
}

double distance(std::uint64_t count, std::uint64_t of, double law) {
  return sigmas(binomial_estimate(count, of), {law, 0.0});
}

/// Mean over the cosine of what a flat face lets through from index n1 to n2.
double isotropic_transmittance(double n1, double n2) {
  constexpr int kSteps = 20'000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += 1.0 - fresnel((i + 0.5) / kSteps, n1, n2).unpolarised();
  return sum / kSteps;
}

}  // namespace

TEST_CASE("A coating of the indices around it: exp(-tau / cos) passes, and halves go each way") {
  for (const double incidence : {0.0, 1.0}) {
    const Outcomes outcomes = shine(coated(Curve::constant(1.5)), incidence, [](double) {
      return IndexPair{1.5, 1.5};
    });
    CHECK(outcomes.returned == 0);
    CHECK(outcomes.absorbed == 0);
    CHECK(outcomes.count.absorbed == kShots - outcomes.passed);
    CHECK(outcomes.count.emitted == outcomes.count.absorbed);
    CHECK(distance(outcomes.passed, kShots, std::exp(-kDepth / std::cos(incidence))) < kSigmas);
    CHECK(distance(outcomes.inside, outcomes.inside + outcomes.outside, 0.5) < kSigmas);
    CHECK(sigmas(outcomes.delay_ns.mean(), {50.0, 0.0}) < kSigmas);
  }
}

TEST_CASE("The quantum yield of a coating: light that is not re-emitted is absorbed") {
  const Outcomes outcomes = shine(coated(Curve::constant(1.5), 0.6), 0.0, [](double) {
    return IndexPair{1.5, 1.5};
  });
  CHECK(outcomes.absorbed == outcomes.count.absorbed - outcomes.count.emitted);
  CHECK(distance(outcomes.count.emitted, outcomes.count.absorbed, 0.6) < kSigmas);
}

TEST_CASE("Re-emitted light interacts with the faces of the coating with the indices of its own wavelength") {
  // At 400 nm the coating is matched to the crystal, at 480 nm and beyond to the vacuum outside: half of
  // what is re-emitted heads for the crystal, and goes in by Fresnel or turns and leaves.
  const Curve index({400.0, 450.0, 600.0}, {1.5, 1.0, 1.0});
  const Outcomes outcomes = shine(coated(index), 0.0, [](double nm) {
    return IndexPair{1.5, nm < 450.0 ? 1.5 : 1.0};
  });
  const std::uint64_t back = outcomes.inside + outcomes.outside;
  CHECK(outcomes.absorbed == 0);
  CHECK(distance(outcomes.inside, back, 0.5 * isotropic_transmittance(1.0, 1.5)) < kSigmas);
}

TEST_CASE("Without optics at other wavelengths a coating only absorbs") {
  const Surface surface = coated(Curve::constant(1.5));
  std::uint64_t absorbed = 0;
  for (std::uint64_t i = 0; i < kShots; ++i) {
    Rng rng(29, StreamKind::other, i);
    Ray ray{Vec3::UnitZ(), Vec3::Zero()};
    absorbed += surface.interact(ray, Side::inside, Vec3::UnitZ(), {1.5, 1.5}, 400.0, rng) ==
                SurfaceOutcome::absorbed;
  }
  CHECK(distance(absorbed, kShots, 1.0 - std::exp(-kDepth)) < kSigmas);
}

TEST_CASE("A mixture shifts when one of its shares does") {
  Surface mixed;
  mixed.mixture = {{0.5, std::make_shared<const Surface>()},
                   {0.5, std::make_shared<const Surface>(coated(Curve::constant(1.5)))}};
  CHECK(mixed.shifts());
  CHECK_FALSE(Surface().shifts());
  const Outcomes outcomes = shine(mixed, 0.0, [](double) { return IndexPair{1.5, 1.5}; });
  CHECK(distance(outcomes.count.absorbed, kShots, 0.5 * (1.0 - std::exp(-kDepth))) < kSigmas);
}
