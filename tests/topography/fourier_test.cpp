#include "scintray/topography/detail/fourier.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "topography/made_maps.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;

TEST_CASE("a transform and its inverse reproduce the map, at even, odd and prime sizes; Parseval holds") {
  for (const auto& size : {std::pair{8u, 6u}, {7u, 5u}, {6u, 13u}, {1u, 4u}, {13u, 1u}}) {
    const auto& columns = size.first;
    const auto& rows = size.second;
    Rng rng(3, StreamKind::other, columns, rows);
    std::vector<double> heights(columns * rows);
    for (double& height : heights) height = rng.uniform();
    const HalfSpectrum spectrum = fourier_transform(heights, columns, rows);
    double power = 0.0;
    for (std::uint32_t l = 0; l < rows; ++l)
      for (std::uint32_t k = 0; k < spectrum.kept(); ++k)
        power += spectrum.weight(k) * std::norm(spectrum.at(k, l));
    const double squares = std::inner_product(heights.begin(), heights.end(), heights.begin(), 0.0);
    CAPTURE(columns);
    CHECK(power == doctest::Approx(squares * columns * rows).epsilon(1e-12));
    CHECK(spectrum.at(0, 0).real() == doctest::Approx(std::accumulate(heights.begin(), heights.end(), 0.0)));
    const std::vector<double> back = inverse_fourier_transform(spectrum);
    REQUIRE(back.size() == heights.size());
    for (std::size_t k = 0; k < heights.size(); ++k) CHECK(std::abs(back[k] - heights[k]) < 1e-13);
  }
}

TEST_CASE("a wave stands at its own frequency and nowhere else") {
  const HeightMap map = test::sinusoid(12, 0.5, 2.0, 2, -3);
  const HalfSpectrum spectrum = fourier_transform(map.heights_um, 12, 12);
  for (std::uint32_t l = 0; l < 12; ++l)
    for (std::uint32_t k = 0; k < spectrum.kept(); ++k)
      CHECK(std::abs(spectrum.at(k, l)) == doctest::Approx(k == 2 && l == 9 ? 144.0 : 0.0).epsilon(1e-9));
  CHECK(spatial_frequency(2, 12, 0.5) == doctest::Approx(2.0 / 6.0));
  CHECK(spatial_frequency(9, 12, 0.5) == doctest::Approx(-3.0 / 6.0));
}

TEST_CASE("quick sizes have no prime factor above 5") {
  CHECK(quick_size(1) == 1);
  CHECK(quick_size(7) == 8);
  CHECK(quick_size(514) == 540);
  CHECK(quick_size(1836) == 1875);
}
