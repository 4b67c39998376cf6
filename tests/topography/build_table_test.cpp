#include "scintray/topography/build_table.hpp"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/topography/synthesis.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;

namespace {

constexpr IndexPair kCrystalInAir{1.82, 1.0};

const HeightField& ground() {
  static const HeightField field = make_height_field(synthesize(ground_recipe()));
  return field;
}

TableSettings quick() {
  TableSettings settings;
  settings.incidence_step_rad = 30 * kDegree;
  settings.azimuth_step_rad = 45 * kDegree;
  settings.rays = 400;
  return settings;
}

Ray arriving(Side side, double sine2, double azimuth) {
  const double up = side == Side::inside ? 1.0 : -1.0;
  const double sine = std::sqrt(sine2);
  return {{sine * std::cos(azimuth), sine * std::sin(azimuth), up * std::sqrt(1.0 - sine2)}, Vec3::Zero()};
}

/// Bins equal in sin^2, so that the cosine law fills them equally.
constexpr int kPolarClasses = 8, kAzimuthClasses = 4;
int polar_class(const Vec3& d) {
  return std::min(kPolarClasses - 1, static_cast<int>(kPolarClasses * (1.0 - d.z() * d.z())));
}
int azimuth_class(const Vec3& in, const Vec3& out) {
  const double turn =
      std::abs(std::remainder(std::atan2(out.y(), out.x()) - std::atan2(in.y(), in.x()), kTwoPi));
  return std::min(kAzimuthClasses - 1, static_cast<int>(kAzimuthClasses * turn / kPi));
}

/// Counts of cosine-law light from `side`: [crossed or not][polar in][polar out][azimuth turn].
using Transfer = std::vector<std::uint64_t>;
std::size_t cell(bool crossed, int in, int out, int turn) {
  return ((static_cast<std::size_t>(crossed) * kPolarClasses + in) * kPolarClasses + out) * kAzimuthClasses +
         turn;
}

Transfer transfer(Side side, std::uint64_t rays) {
  Transfer counts(2 * kPolarClasses * kPolarClasses * kAzimuthClasses, 0);
  for (std::uint64_t k = 0; k < rays; ++k) {
    Rng rng(41, StreamKind::other, static_cast<std::uint64_t>(side), k);
    const double sine2 = rng.uniform();
    Ray ray = arriving(side, sine2, kTwoPi * rng.uniform());
    const Vec3 in = ray.direction;
    const double x = ground().period_x_um() * rng.uniform(), y = ground().period_y_um() * rng.uniform();
    const bool crossed = ground().follow(ray, side, x, y, kCrystalInAir, rng).side != side;
    ++counts[cell(crossed, polar_class(in), polar_class(ray.direction), azimuth_class(in, ray.direction))];
  }
  return counts;
}

}  // namespace

TEST_CASE(
    "energy: reflected and transmitted rays of every node add up to the rays traced, none unclassified") {
  const SurfaceTable table = build_table(ground(), kCrystalInAir, quick());
  CHECK(table.provenance().unclassified == 0);
  CHECK(table.provenance().cut == 0);
  for (const Side side : {Side::inside, Side::outside})
    for (const TableNode& node : table.nodes(side)) {
      CHECK(node.rays == 3200);
      CHECK(node.reflected.rays + node.transmitted.rays == node.rays);
      CHECK(node.reflectance == static_cast<double>(node.reflected.rays) / static_cast<double>(node.rays));
    }
  CHECK(table.nodes(Side::inside).back().traced_incidence_rad == doctest::Approx(89.9 * kDegree));
}

TEST_CASE("a ray that leaves away from its medium, or nowhere, has none") {
  const Vec3 up = Vec3(1.0, 2.0, 0.5).normalized(), down = -up;
  CHECK(leaves_into_medium(SurfaceOutcome::outside, up));
  CHECK(leaves_into_medium(SurfaceOutcome::inside, down));
  CHECK_FALSE(leaves_into_medium(SurfaceOutcome::inside, up));
  CHECK_FALSE(leaves_into_medium(SurfaceOutcome::outside, down));
  const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  CHECK_FALSE(leaves_into_medium(SurfaceOutcome::inside, nowhere));
  CHECK_FALSE(leaves_into_medium(SurfaceOutcome::outside, nowhere));
  CHECK(leaves_into_medium(SurfaceOutcome::absorbed, up));
}

TEST_CASE("a table is the same to the last bit for any number of threads") {
  std::vector<SurfaceTable> tables;
  for (const std::size_t threads : {1, 2, 7}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    tables.push_back(build_table(ground(), kCrystalInAir, quick()));
  }
  for (const SurfaceTable& table : tables)
    for (const Side side : {Side::inside, Side::outside}) {
      REQUIRE(table.nodes(side).size() == tables[0].nodes(side).size());
      for (std::size_t k = 0; k < table.nodes(side).size(); ++k) {
        const TableNode &a = table.nodes(side)[k], &b = tables[0].nodes(side)[k];
        CHECK(a.incidence_rad == b.incidence_rad);
        CHECK(a.reflectance == b.reflectance);
        CHECK(a.mean_slope_rad == b.mean_slope_rad);
        CHECK(a.reflected.polar == b.reflected.polar);
        CHECK(a.reflected.azimuth == b.reflected.azimuth);
        CHECK(a.transmitted.polar == b.transmitted.polar);
        CHECK(a.transmitted.azimuth == b.transmitted.azimuth);
      }
    }
}

TEST_CASE("reciprocity: n^2 cos p is the same both ways, bin by bin, and in the cosine-law means") {
  // With rays in the ratio of n^2, reciprocal bins expect the same counts.
  constexpr std::uint64_t kFromOutside = 60000;
  const auto kFromInside = static_cast<std::uint64_t>(std::llround(1.82 * 1.82 * kFromOutside));
  const Transfer inside = transfer(Side::inside, kFromInside),
                 outside = transfer(Side::outside, kFromOutside);
  std::vector<std::uint64_t> forth, back, reflected, reversed;
  std::uint64_t crossed_out = 0, crossed_in = 0;
  for (int in = 0; in < kPolarClasses; ++in)
    for (int out = 0; out < kPolarClasses; ++out)
      for (int turn = 0; turn < kAzimuthClasses; ++turn) {
        forth.push_back(inside[cell(true, in, out, turn)]);
        back.push_back(outside[cell(true, out, in, turn)]);
        crossed_out += forth.back();
        crossed_in += back.back();
        if (in >= out) continue;
        reflected.push_back(inside[cell(false, in, out, turn)]);
        reversed.push_back(inside[cell(false, out, in, turn)]);
      }
  // n1^2 (1 - R12) = n2^2 (1 - R21); the two counts are independent.
  const double difference = static_cast<double>(crossed_out) - static_cast<double>(crossed_in);
  CHECK(std::abs(difference) <= 4.0 * std::sqrt(static_cast<double>(crossed_out + crossed_in)));
  CHECK(chi_square_two_samples(forth, back).p_value > 1e-4);  // one false alarm in 10,000 seeds each
  CHECK(chi_square_two_samples(reflected, reversed).p_value > 1e-4);
}

TEST_CASE("a flat surface's table: Fresnel everywhere, with the critical angle sharp to 0.1 deg") {
  const HeightField flat(std::vector<float>(16, 0.0f), 4, 4, 1.0, 1.0);
  TableSettings settings = quick();
  settings.incidence_step_rad = 2.25 * kDegree;
  settings.rays = 500;
  const SurfaceTable table = build_table(flat, kCrystalInAir, settings);
  const double critical = std::asin(1.0 / 1.82);
  for (const Side side : {Side::inside, Side::outside})
    for (const TableNode& node : table.nodes(side)) {
      const double p =
          fresnel(std::cos(node.traced_incidence_rad), kCrystalInAir.on(side), kCrystalInAir.on(other(side)))
              .unpolarised();
      CHECK(std::abs(node.reflectance - p) <=
            4.0 * std::sqrt(p * (1.0 - p) / static_cast<double>(node.rays)) + 1e-12);
    }
  // Between neighbours either the reflectance hardly changes or they are within 0.1 deg.
  const auto& nodes = table.nodes(Side::inside);
  bool straddles = false;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const double change = std::abs(nodes[i].reflectance - nodes[i - 1].reflectance);
    CHECK((change <= settings.refine_change ||
           nodes[i].incidence_rad - nodes[i - 1].incidence_rad <= 0.1 * kDegree));
    straddles |= nodes[i - 1].incidence_rad < critical && nodes[i].incidence_rad > critical;
  }
  CHECK(straddles);
}

TEST_CASE("table and map traced on the spot agree in reflectance and in direction, at nodes and between") {
  TableSettings settings;
  settings.rays = 500;
  const SurfaceTable table = build_table(ground(), kCrystalInAir, settings);
  const double table_rays = 500.0 * 40.0;
  constexpr std::uint64_t kRays = 60000;
  constexpr int kPolar = 12, kAzimuth = 6;
  for (const Side side : {Side::inside, Side::outside})
    for (const double degrees : {22.5, 23.6, 45.0, 46.1, 70.9}) {
      std::array<std::vector<std::uint64_t>, 2> counts{std::vector<std::uint64_t>(2 * kPolar * kAzimuth, 0),
                                                       std::vector<std::uint64_t>(2 * kPolar * kAzimuth, 0)};
      std::array<std::uint64_t, 2> reflected{0, 0};
      for (std::uint64_t k = 0; k < kRays; ++k)
        for (const int model : {0, 1}) {
          Rng rng(42 + model, StreamKind::other, static_cast<std::uint64_t>(degrees * 10), k);
          Ray ray = arriving(side, std::pow(std::sin(degrees * kDegree), 2), 0.0);
          const Side after = model == 0 ? ground().scatter(ray, side, Vec3::UnitZ(), kCrystalInAir, rng)
                                        : table.scatter(ray, side, Vec3::UnitZ(), kCrystalInAir, rng);
          reflected[model] += after == side ? 1 : 0;
          const Vec3& d = ray.direction;
          const int polar = std::min(kPolar - 1, static_cast<int>(kPolar * (1.0 - d.z() * d.z())));
          const int azimuth =
              std::min(kAzimuth - 1, static_cast<int>(kAzimuth * std::abs(std::atan2(d.y(), d.x())) / kPi));
          ++counts[model][((after == side ? 0 : 1) * kPolar + polar) * kAzimuth + azimuth];
        }
      CAPTURE(degrees);
      CAPTURE(static_cast<int>(side));
      // Bins are multinomial in all three samples: the map's, the table's, and the rays behind the
      // table. Bins that together hold fewer than 40 rays are left out.
      double chi2 = 0.0, degrees_of_freedom = 0.0;
      for (std::size_t k = 0; k < counts[0].size(); ++k) {
        const double a = static_cast<double>(counts[0][k]), b = static_cast<double>(counts[1][k]);
        if (a + b < 40.0) continue;
        const double share = 0.5 * (a + b) / kRays;
        const double variance = share * (2.0 / kRays + 1.0 / table_rays);
        chi2 += std::pow((a - b) / kRays, 2) / variance;
        degrees_of_freedom += 1.0;
      }
      CAPTURE(chi2);
      CAPTURE(degrees_of_freedom);
      CHECK(chi_square_p_value(chi2, degrees_of_freedom) > 1e-4);  // one false alarm in 10,000 seeds each
      const double p = static_cast<double>(reflected[0]) / kRays;
      const double error = std::sqrt(p * (1.0 - p) * (2.0 / kRays + 1.0 / table_rays));
      CHECK(std::abs(p - static_cast<double>(reflected[1]) / kRays) <= 4.0 * error);
    }
}

TEST_CASE("the build of a table can be stopped, and wrong settings are refused") {
  CHECK_THROWS_AS(build_table(ground(), kCrystalInAir, quick(), {}, [](double) { return false; }),
                  TableStopped);
  TableSettings settings = quick();
  settings.rays = 0;
  settings.incidence_step_rad = -1.0;
  CHECK_THROWS_AS(build_table(ground(), kCrystalInAir, settings), InputError);
}
