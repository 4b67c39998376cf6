#include "scintray/optics/table.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <future>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/statistics.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;

namespace {

/// Lambertian in both ways, whatever the incidence.
DirectionQuantiles lambertian_quantiles() {
  std::vector<ExitAngles> sample;
  constexpr int kSize = 80000;
  // Golden-ratio steps of azimuth fill the circle uniformly within any range of polar angles.
  for (int k = 0; k < kSize; ++k)
    sample.push_back({static_cast<float>(std::asin(std::sqrt((k + 0.5) / kSize))),
                      static_cast<float>(kPi * std::fmod(k * 0.6180339887498949, 1.0))});
  return quantiles_of(sample);
}

TableNode node(double degrees, double reflectance) {
  TableNode result;
  result.incidence_rad = result.traced_incidence_rad = degrees * kDegree;
  result.reflectance = reflectance;
  result.reflectance_error = 0.01;
  result.mean_slope_rad = 0.1;
  result.rays = 80000;
  result.reflected = result.transmitted = lambertian_quantiles();
  return result;
}

SurfaceTable sample_table() {
  TableProvenance provenance;
  provenance.map = "made up";
  provenance.preparation = "none";
  provenance.tiling = "periodic";
  provenance.seed = 0xFFFFFFFFFFFFFFFFULL;
  provenance.unclassified = 7;
  provenance.cut = 2;
  provenance.version = "test";
  return SurfaceTable({1.8, 1.0}, {node(0, 0.1), node(30, 0.4), node(33, 0.9), node(90, 1.0)},
                      {node(0, 0.2), node(90, 0.6)}, provenance);
}

}  // namespace

TEST_CASE("reflectance is linear between nodes and exact at them") {
  const SurfaceTable table = sample_table();
  CHECK(table.reflectance(Side::inside, 0.0) == doctest::Approx(0.1));
  CHECK(table.reflectance(Side::inside, 15 * kDegree) == doctest::Approx(0.25));
  CHECK(table.reflectance(Side::inside, 30 * kDegree) == doctest::Approx(0.4));
  CHECK(table.reflectance(Side::inside, 31.5 * kDegree) == doctest::Approx(0.65));
  CHECK(table.reflectance(Side::inside, 90 * kDegree) == doctest::Approx(1.0));
  CHECK(table.reflectance(Side::outside, 45 * kDegree) == doctest::Approx(0.4));
}

TEST_CASE("quantiles of the cosine law reproduce the cosine law, in both media") {
  const SurfaceTable table = sample_table();
  const Vec3 normal = Vec3(0.3, -0.5, 0.7).normalized();
  const Frame frame = Frame::about(normal);
  constexpr int kPolar = 20, kAzimuth = 8;
  std::vector<std::uint64_t> counts(2 * kPolar * kAzimuth, 0);
  constexpr std::uint64_t kRays = 100000;
  const double incidence = 15 * kDegree;
  for (std::uint64_t k = 0; k < kRays; ++k) {
    Rng rng(21, StreamKind::other, 0, k);
    Ray ray{std::sin(incidence) * frame.x + std::cos(incidence) * normal, Vec3::Zero()};
    const Side after = table.scatter(ray, Side::inside, normal, {1.8, 1.0}, rng);
    const Vec3 local = frame.to_local(ray.direction);
    REQUIRE((local.z() > 0.0) == (after == Side::outside));
    const int polar = std::min(kPolar - 1, static_cast<int>(kPolar * (1.0 - local.z() * local.z())));
    const int azimuth = std::min(
        kAzimuth - 1, static_cast<int>(kAzimuth * (std::atan2(local.y(), local.x()) / kTwoPi + 0.5)));
    ++counts[(static_cast<int>(after) * kPolar + polar) * kAzimuth + azimuth];
    CHECK(std::abs(ray.direction.norm() - 1.0) < 1e-12);
  }
  std::vector<double> expected;
  for (const double share : {0.25, 0.75})
    for (int k = 0; k < kPolar * kAzimuth; ++k) expected.push_back(share * kRays / (kPolar * kAzimuth));
  CHECK(chi_square_test(counts, expected).p_value > 1e-4);  // one false alarm in 10,000 seeds
}

TEST_CASE("light leaves by the quantiles: exactly forward and back, elsewhere within 16 bits of azimuth") {
  const Vec3 normal = Vec3(0.3, -0.5, 0.7).normalized();
  const Frame frame = Frame::about(normal);
  constexpr double kPolar = 0.7, kIncidence = 0.4;
  for (const AzimuthKind kind : {AzimuthKind::folded, AzimuthKind::directional})
    for (const double azimuth : {0.0, kPi, 0.3, 1.234567, 2.9, -0.3, -1.234567}) {
      if (kind == AzimuthKind::folded && azimuth < 0.0) continue;
      CAPTURE(azimuth);
      TableNode straight = node(0, 1.0), grazing = node(90, 1.0);
      for (TableNode* one : {&straight, &grazing}) {
        one->transmitted = {};
        std::fill(one->reflected.polar.begin(), one->reflected.polar.end(), static_cast<float>(kPolar));
        std::fill(one->reflected.azimuth.begin(), one->reflected.azimuth.end(), static_cast<float>(azimuth));
      }
      const std::vector<TableNode> nodes{straight, grazing};
      const SurfaceTable table({TableSlice{0.0, 0.0, {1.8, 1.0}, nodes, nodes, nullptr}}, kind, {});
      const bool exact = azimuth == 0.0 || azimuth == kPi;
      for (std::uint64_t k = 0; k < 20; ++k) {
        Rng rng(23, StreamKind::other, 0, k);
        Ray ray{std::sin(kIncidence) * frame.x + std::cos(kIncidence) * normal, Vec3::Zero()};
        REQUIRE(table.scatter(ray, Side::inside, normal, {1.8, 1.0}, rng) == Side::inside);
        const Vec3 local = frame.to_local(ray.direction);
        CHECK(std::acos(-local.z()) == doctest::Approx(kPolar).epsilon(1e-6));
        const double turn = std::atan2(local.y(), local.x());
        const double off =
            std::remainder(kind == AzimuthKind::folded ? std::abs(turn) - azimuth : turn - azimuth, kTwoPi);
        CHECK(std::abs(off) < (exact ? 1e-6 : 5e-5));
      }
    }
}

TEST_CASE("every thread draws the same directions from a table") {
  const SurfaceTable table = sample_table();
  const auto directions = [&table] {
    std::vector<Vec3> result;
    for (std::uint64_t k = 0; k < 1000; ++k) {
      Rng rng(24, StreamKind::other, 0, k);
      Ray ray{Vec3(0.6, 0.0, 0.8), Vec3::Zero()};
      table.scatter(ray, Side::inside, {0, 0, 1}, {1.8, 1.0}, rng);
      result.push_back(ray.direction);
    }
    return result;
  };
  const std::vector<Vec3> here = directions();
  for (int thread = 0; thread < 5; ++thread) {
    auto there = std::async(std::launch::async, directions);
    CHECK(there.get() == here);
  }
}

TEST_CASE("unpolarised light stays unpolarised; polarised light stays across its direction") {
  const SurfaceTable table = sample_table();
  Rng rng(22, StreamKind::other, 0);
  Ray ray{{0.6, 0.0, 0.8}, Vec3::Zero()};
  table.scatter(ray, Side::inside, Vec3::UnitZ(), {1.8, 1.0}, rng);
  CHECK(ray.polarisation.isZero(0.0));
  Ray polarised{{0.6, 0.0, 0.8}, {0.0, 1.0, 0.0}};
  table.scatter(polarised, Side::inside, Vec3::UnitZ(), {1.8, 1.0}, rng);
  CHECK(std::abs(polarised.polarisation.dot(polarised.direction)) < 1e-12);
  CHECK(polarised.polarisation.norm() == doctest::Approx(1.0));
}

TEST_CASE("tables that cannot be are refused, with every fault named") {
  CHECK_THROWS_AS(SurfaceTable({1.8, 1.0}, {node(0, 0.1)}, {node(0, 0.1), node(90, 1)}, {}), InputError);
  CHECK_THROWS_AS(SurfaceTable({1.8, 1.0}, {node(0, 0.1), node(80, 1)}, {node(0, 0.1), node(90, 1)}, {}),
                  InputError);
  TableNode unsorted = node(0, 0.1);
  std::swap(unsorted.reflected.polar[3], unsorted.reflected.polar[9]);
  TableNode loud = node(90, 1.5);
  try {
    SurfaceTable({1.8, 1.0}, {unsorted, node(90, 1)}, {node(0, 0.1), loud}, {});
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(error.problems().size() == 2);
  }
  TableNode mute = node(0, 0.1);
  mute.transmitted = {};
  CHECK_THROWS_AS(SurfaceTable({1.8, 1.0}, {mute, node(90, 1)}, {node(0, 0.1), node(90, 1)}, {}), InputError);
}

TEST_CASE("a table is read back from its file unchanged") {
  const auto path = test::scratch_folder("table_round_trip") / "table.h5";
  const SurfaceTable table = sample_table();
  write_table(path, table);
  const SurfaceTable read = read_table(path);
  CHECK(read.index_pair().inside == 1.8);
  CHECK(read.provenance().seed == table.provenance().seed);
  CHECK(read.provenance().map == "made up");
  CHECK(read.provenance().unclassified == 7);
  CHECK(read.provenance().cut == 2);
  for (const Side side : {Side::inside, Side::outside}) {
    REQUIRE(read.nodes(side).size() == table.nodes(side).size());
    for (std::size_t k = 0; k < read.nodes(side).size(); ++k) {
      const TableNode &a = read.nodes(side)[k], &b = table.nodes(side)[k];
      CHECK(a.incidence_rad == b.incidence_rad);
      CHECK(a.reflectance == b.reflectance);
      CHECK(a.rays == b.rays);
      CHECK(a.reflected.polar == b.reflected.polar);
      CHECK(a.transmitted.azimuth == b.transmitted.azimuth);
      CHECK(a.transmitted.rays == b.transmitted.rays);
    }
  }
}

TEST_CASE("a table file of another version is refused with both versions and the advice to rebuild") {
  const auto path = test::scratch_folder("table_version") / "table.h5";
  h5::File file = h5::File::create(path);
  h5::Group root = file.root();
  root.set_attribute("", "format", std::string("ScintRay surface table"));
  root.set_attribute("", "format_version", std::int64_t{kTableFileVersion + 41});
  file.commit();
  try {
    read_table(path);
    FAIL("accepted");
  } catch (const InputError& error) {
    const std::string text = error.problems().front().text();
    CHECK(text.find(std::to_string(kTableFileVersion + 41)) != std::string::npos);
    CHECK(text.find("version " + std::to_string(kTableFileVersion)) != std::string::npos);
    CHECK(text.find("rebuild") != std::string::npos);
  }
}
