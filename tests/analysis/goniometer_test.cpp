#include "scintray/analysis/goniometer/goniometer.hpp"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "scintray/core/error.hpp"
#include "scintray/optics/facets.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::analysis;
using namespace scintray::test;

namespace {

constexpr IndexPair kIndex{1.82, 1.0};

GoniometerSettings at(double degrees, std::uint64_t rays = 200'000) {
  GoniometerSettings settings;
  settings.incidence_rad = degrees * kDegree;
  settings.wavelength_nm = 420.0;
  settings.rays = rays;
  return settings;
}

Surface rough_with_reflector() {
  Surface surface;
  FacetSurface facets;
  facets.sigma_alpha_rad = 12.0 * kDegree;
  facets.lobe = 0.8;
  surface.microsurface = facets;
  surface.reflector = Reflector{"white", Curve::constant(0.9), 0.2, 0.0};
  return surface;
}

/// Lambertian paint.
Surface painted(double reflectance) {
  Surface surface;
  surface.microsurface = PaintedSurface{};
  surface.reflector = Reflector{"paint", Curve::constant(reflectance), 0.0, 0.0};
  return surface;
}

std::string refusal(const GoniometerSettings& settings) {
  return complaint_of([&] { read_goniometer(Surface{}, kIndex, settings); });
}

bool same(const Lobe& a, const Lobe& b) {
  return a.rays == b.rays && a.in_plane_rad.value == b.in_plane_rad.value &&
         a.across_rad.value == b.across_rad.value && a.in_plane_rad.error == b.in_plane_rad.error &&
         a.width_in_plane == b.width_in_plane && a.width_across == b.width_across;
}

}  // namespace

TEST_CASE("a smooth surface reflects by Fresnel, into the mirror direction, and refracts by Snell") {
  // 4 standard errors of the exact share: a right answer fails one in 15,800 comparisons.
  for (const Side side : {Side::inside, Side::outside})
    for (const double degrees : {0.0, 20.0, 32.0, 45.0, 61.0, 89.0}) {
      CAPTURE(degrees);
      GoniometerSettings settings = at(degrees);
      settings.side = side;
      const GoniometerReading reading = read_goniometer(Surface{}, kIndex, settings);
      const double n1 = kIndex.on(side), n2 = kIndex.on(other(side));
      const double law = fresnel(std::cos(settings.incidence_rad), n1, n2).unpolarised();
      const auto n = static_cast<double>(settings.rays);
      CHECK(std::abs(reading.reflectance().value - law) <= 4.0 * std::sqrt(law * (1.0 - law) / n));
      CHECK(reading.absorbed == 0);
      CHECK(reading.reflected_lobe.in_plane_rad.value ==
            doctest::Approx(settings.incidence_rad).epsilon(1e-9));
      CHECK(reading.reflected_lobe.across_rad.value == doctest::Approx(0.0));
      CHECK(reading.reflected_lobe.width_in_plane < 1e-6);
      const auto bin = static_cast<std::size_t>(90.0 + degrees + 1e-9);
      CHECK(reading.reflected_directions.profile[bin] + reading.reflected_directions.profile[bin - 1] ==
            reading.reflected);
      if (reading.transmitted > 0) {
        const double refracted = std::asin(n1 / n2 * std::sin(settings.incidence_rad));
        CHECK(reading.transmitted_lobe.in_plane_rad.value == doctest::Approx(refracted).epsilon(1e-9));
      }
    }
}

TEST_CASE("every ray is reflected, transmitted or absorbed, and every direction is in a cell") {
  for (const Side side : {Side::inside, Side::outside}) {
    GoniometerSettings settings = at(40.0, 50'001);
    settings.side = side;
    const GoniometerReading reading = read_goniometer(rough_with_reflector(), kIndex, settings);
    CHECK(reading.reflected + reading.transmitted + reading.absorbed == settings.rays);
    CHECK(reading.reflected_directions.total() == reading.reflected);
    CHECK(reading.transmitted_directions.total() == reading.transmitted);
    CHECK(reading.reflected_lobe.rays == reading.reflected);
    CHECK(reading.reflected > 0);
    CHECK(reading.absorbed > 0);
    CHECK(reading.transmitted == 0);  // the reflector is opaque
    CHECK(reading.reflectance().value + reading.absorptance().value == doctest::Approx(1.0));
  }
}

TEST_CASE("Lambertian paint reflects its share by the cosine law, whatever the incidence") {
  // Fixed seed; each p-value falls below 1e-4 by chance once in 10,000 seeds.
  for (const double degrees : {0.0, 70.0}) {
    const GoniometerSettings settings = at(degrees, 500'000);
    const GoniometerReading reading = read_goniometer(painted(0.8), kIndex, settings);
    CHECK(sigmas(reading.reflectance(), {0.8, 0.0}) < 4.0);
    const auto n = static_cast<double>(reading.reflected);
    // Per sr cos(a) cos(e) / pi, a in the plane and e out of it; dOmega = cos(e) de da.
    const double h = settings.profile_half_width_rad;
    const double across = h + 0.5 * std::sin(2.0 * h);
    std::vector<double> profile, cells;
    for (int k = 0; k < DirectionCounts::kProfileBins; ++k)
      profile.push_back(
          n / kPi * across *
          (std::sin(profile_edge_deg(k + 1) * kDegree) - std::sin(profile_edge_deg(k) * kDegree)));
    CHECK(chi_square_test(reading.reflected_directions.profile, profile).p_value > 1e-4);
    for (std::size_t k = 0; k < hemisphere_grid().size(); ++k) {
      const HemisphereGrid::Cell cell = hemisphere_grid().cell(k);
      const double low = std::sin(cell.polar_low), high = std::sin(cell.polar_high);
      cells.push_back(n * (cell.azimuth_high - cell.azimuth_low) * 0.5 * (high * high - low * low) / kPi);
    }
    CHECK(chi_square_test(reading.reflected_directions.cells, cells).p_value > 1e-4);
    // The mean of a component across the normal is 0, of its square 1/4.
    CHECK(std::abs(reading.reflected_lobe.in_plane_rad.value) <
          4.0 * reading.reflected_lobe.in_plane_rad.error);
    CHECK(std::abs(reading.reflected_lobe.across_rad.value) < 4.0 * reading.reflected_lobe.across_rad.error);
    CHECK(reading.reflected_lobe.width_in_plane == doctest::Approx(0.5).epsilon(0.005));
    CHECK(reading.reflected_lobe.width_across == doctest::Approx(0.5).epsilon(0.005));
  }
}

TEST_CASE("the same reading comes out with any number of threads") {
  const Surface surface = rough_with_reflector();
  const auto read = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return read_goniometer(surface, kIndex, at(33.0, 100'000)); });
  };
  const GoniometerReading one = read(1);
  for (const int threads : {2, 5}) {
    const GoniometerReading many = read(threads);
    CHECK(one.reflected == many.reflected);
    CHECK(one.absorbed == many.absorbed);
    CHECK(one.reflected_directions.cells == many.reflected_directions.cells);
    CHECK(one.reflected_directions.profile == many.reflected_directions.profile);
    CHECK(same(one.reflected_lobe, many.reflected_lobe));
  }
}

TEST_CASE("readings of a sweep are independent, and each can be had alone") {
  const Surface surface = rough_with_reflector();
  const auto sweep = sweep_incidence(surface, kIndex, at(0.0, 20'000), {0.5, 0.5, 0.9});
  CHECK(sweep[0].reflected_directions.cells != sweep[1].reflected_directions.cells);
  GoniometerSettings third = at(0.0, 20'000);
  third.incidence_rad = 0.9;
  third.stream = 2;
  CHECK(read_goniometer(surface, kIndex, third).reflected_directions.cells ==
        sweep[2].reflected_directions.cells);
  third.seed = 2;
  CHECK(read_goniometer(surface, kIndex, third).reflected_directions.cells !=
        sweep[2].reflected_directions.cells);
}

TEST_CASE("settings that cannot be are refused, all at once") {
  CHECK(refusal(at(90.0)).find("less than 90 deg") != std::string::npos);
  CHECK(refusal(at(120.0)).find("120 deg") != std::string::npos);
  CHECK(refusal(at(-1.0)).find("-1 deg") != std::string::npos);
  CHECK(refusal(at(std::nan(""))).find("incidence angle") != std::string::npos);
  CHECK(refusal(at(89.999)).empty());
  GoniometerSettings wrong = at(95.0, 0);
  wrong.wavelength_nm = 0.0;
  wrong.profile_half_width_rad = 0.0;
  const std::string all = refusal(wrong);
  for (const char* part : {"95 deg", "0 rays", "wavelength of 0 nm", "half-width of the profile of 0 deg"})
    CHECK(all.find(part) != std::string::npos);
}
