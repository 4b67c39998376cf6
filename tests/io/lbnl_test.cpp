#include "scintray/tables/lbnl.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <optional>

#include "scintray/core/error.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/tables/table_side.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::tables;
using namespace scintray::test;

namespace {

using Weight = std::function<double(double incidence, double theta_deg, double phi_deg)>;

std::vector<float> made_up(const Weight& weight) {
  const LbnlLayout layout;
  std::vector<float> values(layout.numbers());
  for (std::size_t i = 0; i < layout.incidences; ++i)
    for (std::size_t t = 0; t < layout.thetas; ++t)
      for (std::size_t p = 0; p < layout.phis; ++p)
        values[i + 91 * t + 91 * 45 * p] =
            static_cast<float>(weight(static_cast<double>(i), -90.0 + 4.0 * static_cast<double>(t),
                                      -90.0 + 5.0 * static_cast<double>(p)));
  return values;
}

/// A broad lobe about a direction between the normal and the specular one.
double lobe(double incidence, double theta_deg, double phi_deg) {
  return std::exp(-0.5 * (std::pow((theta_deg + 0.7 * incidence) / 15.0, 2) + std::pow(phi_deg / 12.0, 2)));
}

ImportSettings lbnl_import(double reflectance = 1.0) {
  ImportSettings settings;
  settings.index = {1.82, 1.0};
  settings.reflectance = reflectance;
  settings.from_outside = FromOutside::mirror;
  return settings;
}

/// Geant4's sampling by rejection, from a description of its code: rotations of the reversed momentum. The
/// whole draw is repeated until the direction points into the incoming medium; no value: absorbed.
std::optional<Vec3> geant4_sample(const std::vector<float>& values, double incidence_rad, double reflectance,
                                  Rng& rng) {
  const Vec3 normal(0.0, 0.0, -1.0);
  const Vec3 momentum(std::sin(incidence_rad), 0.0, std::cos(incidence_rad));
  const auto rotated = [](const Vec3& v, double angle, const Vec3& axis) {
    return Vec3(Eigen::AngleAxisd(angle, axis.normalized()) * v);
  };
  const auto incidence = static_cast<std::size_t>(std::floor(incidence_rad / kDegree + 0.5));
  for (;;) {
    if (rng.uniform() >= reflectance) return std::nullopt;
    std::size_t theta = 0, phi = 0;
    do {
      theta = static_cast<std::size_t>(rng.uniform() * 44);
      phi = static_cast<std::size_t>(rng.uniform() * 36);
    } while (rng.uniform() >= values[incidence + theta * 91 + phi * 91 * 45]);
    const double theta_rad = (-90.0 + 4.0 * static_cast<double>(theta)) * kDegree;
    const double phi_rad = (-90.0 + 5.0 * static_cast<double>(phi)) * kDegree;
    const Vec3 across = (-momentum).cross(normal);
    const Vec3 in_plane = rotated(-momentum, incidence_rad - theta_rad, across);
    const Vec3 out = rotated(in_plane, -phi_rad, across.cross(in_plane));
    if (out.dot(normal) > 1e-9) return out;
  }
}

std::string message_of(const std::string& content) {
  try {
    parse_lbnl(content, "GroundTeflon.z");
  } catch (const InputError& error) {
    return error.problems().front().text();
  }
  return "";
}

std::string text_of(const std::vector<float>& values) {
  std::string text;
  for (const float value : values) text += fmt::format("{:g} ", value);
  return text;
}

}  // namespace

TEST_CASE("light leaves an imported LBNL table as Geant4 samples it") {
  const std::vector<float> values = made_up(lobe);
  const SurfaceTable table = lbnl_table(values, lbnl_import(), "made up");
  for (const double degrees : {5.3, 30.0, 44.7, 70.2}) {
    CAPTURE(degrees);
    // Directions lie on a grid of 4 by 5 deg that the table's distributions smooth, so means and widths are
    // compared; they are smoothed less than a tenth of the grid's step.
    Moments ours[3], theirs[3];
    constexpr std::uint64_t kRays = 40'000;
    for (std::uint64_t k = 0; k < kRays; ++k) {
      Rng rng(61, StreamKind::other, static_cast<std::uint64_t>(degrees * 10), k);
      const double incidence = degrees * kDegree;
      Ray ray{{std::sin(incidence), 0.0, std::cos(incidence)}, Vec3::Zero()};
      CHECK(table.scatter(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, rng) == Side::inside);
      const auto out = geant4_sample(values, incidence, 1.0, rng);
      const auto add = [](Moments* moments, const Vec3& v) {
        moments[0].add(v.x());
        moments[1].add(-v.z());
        moments[2].add(v.y() * v.y());
      };
      add(ours, ray.direction);
      add(theirs, *out);
    }
    for (int k = 0; k < 3; ++k) {
      CAPTURE(k);
      CHECK(std::abs(ours[k].mean().value - theirs[k].mean().value) <
            4.0 * std::hypot(ours[k].mean().error, theirs[k].mean().error) + 0.1 * 4.0 * kDegree * 0.5);
    }
  }
}

TEST_CASE("light of one bright cell leaves where Geant4 sends it: theta below 0 is forward") {
  for (const double theta : {-58.0, -2.0, 30.0}) {
    const SurfaceTable table =
        lbnl_table(made_up([&](double, double t, double p) { return t == theta && p == 0.0 ? 1.0 : 0.0; }),
                   lbnl_import(), "made up");
    Rng rng(62, StreamKind::other, 0);
    Ray ray{{0.6, 0.0, 0.8}, Vec3::Zero()};
    table.scatter(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, rng);
    CHECK(ray.direction.x() == doctest::Approx(-std::sin(theta * kDegree)));
    CHECK(ray.direction.z() == doctest::Approx(-std::cos(theta * kDegree)));
  }
}

TEST_CASE("the last theta and the last phi are never drawn, and -90 deg means another try") {
  // All weight where the sampler never looks or where the direction lies in the surface, but for one cell.
  const auto weight = [](double, double t, double p) {
    return t == 86.0 || p == 90.0 || t == -90.0 || p == -90.0 || (t == -30.0 && p == 0.0) ? 1.0 : 0.0;
  };
  const SurfaceTable table = lbnl_table(made_up(weight), lbnl_import(), "made up");
  Rng rng(63, StreamKind::other, 0);
  for (int k = 0; k < 100; ++k) {
    Ray ray{{0.6, 0.0, 0.8}, Vec3::Zero()};
    table.scatter(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, rng);
    CHECK(ray.direction.x() == doctest::Approx(0.5));
  }
}

TEST_CASE("incidences are rounded to the nearest degree") {
  // Odd and even incidences send light to different sides.
  const SurfaceTable table = lbnl_table(made_up([](double incidence, double t, double p) {
                                          const double side = std::fmod(incidence, 2.0) > 0.5 ? -30.0 : 30.0;
                                          return t == side && p == 0.0 ? 1.0 : 0.0;
                                        }),
                                        lbnl_import(), "made up");
  const auto forward = [&](double degrees) {
    Rng rng(64, StreamKind::other, 0);
    Ray ray{{std::sin(degrees * kDegree), 0.0, std::cos(degrees * kDegree)}, Vec3::Zero()};
    table.scatter(ray, Side::inside, Vec3::UnitZ(), {1.82, 1.0}, rng);
    return ray.direction.x() > 0.0;
  };
  CHECK(!forward(40.45));
  CHECK(forward(40.55));
  CHECK(forward(41.45));
  CHECK(!forward(41.55));
  CHECK(forward(89.45));
  CHECK(!forward(89.55));
}

TEST_CASE("damaged LBNL tables are refused, with the place of the value") {
  std::vector<float> values = made_up(lobe);
  CHECK(message_of(text_of(values)).empty());
  CHECK(message_of(text_of({values.begin(), values.end() - 1})).find("151514 numbers; expected 151515") !=
        std::string::npos);
  CHECK(message_of(text_of(values) + " 0").find("more than 151515") != std::string::npos);
  CHECK(message_of("<html>not found</html>").find("\"<html>not\" as number 1") != std::string::npos);
  values[91 * 3 + 17] = 1.2f;
  CHECK(message_of(text_of(values)).find("as number 291, at incidence 17 deg; expected 0 to 1") !=
        std::string::npos);
  values[91 * 3 + 17] = -0.1f;
  CHECK(message_of(text_of(values)).find("-0.1") != std::string::npos);
  values =
      made_up([](double incidence, double t, double p) { return incidence == 40.0 ? 0.0 : lobe(0, t, p); });
  CHECK(message_of(text_of(values)).find("no direction that leaves the surface at incidence 40") !=
        std::string::npos);
}

TEST_CASE("the bare finishes, which Geant4 names and nobody measured, are explained") {
  const auto folder = scratch_folder("lbnl_bare");
  for (const char* name : {"polishedair.z", "EtchedAir.dat", "ground_air.z", "Ground.z"}) {
    try {
      read_lbnl(folder / name, lbnl_import());
      FAIL("read");
    } catch (const InputError& error) {
      CHECK(error.problems().front().what.find("no data exist") != std::string::npos);
    }
  }
  CHECK_THROWS_WITH_AS(read_lbnl(folder / "GroundTeflon.z", lbnl_import()),
                       doctest::Contains("no such file, or not one that can be read"), InputError);
}

TEST_CASE("a reflectance has to be given, and what it takes is absorbed") {
  const std::vector<float> values = made_up(lobe);
  for (const double wrong : {0.0, -0.5, 1.1, std::nan("")})
    CHECK_THROWS_AS(lbnl_table(values, lbnl_import(wrong), "made up"), InputError);
  // A third of the tries end at the horizon, and each try is another chance to be absorbed.
  const std::vector<float> thirds = made_up([](double, double t, double p) {
    if (p != 0.0) return 0.0;
    return t == -90.0 ? 0.5 : t == -30.0 || t == 30.0 ? 0.5 : 0.0;
  });
  const SurfaceTable table = lbnl_table(thirds, lbnl_import(0.9), "made up");
  CHECK(table.opaque());
  std::uint64_t ours = 0, theirs = 0;
  constexpr std::uint64_t kRays = 40'000;
  for (std::uint64_t k = 0; k < kRays; ++k) {
    Rng rng(65, StreamKind::other, 0, k);
    Ray ray{{0.6, 0.0, 0.8}, Vec3::Zero()};
    if (table.interact(ray, Side::inside, Vec3::UnitZ(), Vec3::Zero(), 440.0, rng) == SurfaceOutcome::inside)
      ++ours;
    if (geant4_sample(thirds, std::asin(0.6), 0.9, rng)) ++theirs;
  }
  CHECK(table.reflectance(Side::inside, 0.5) == doctest::Approx(0.9 * (2.0 / 3.0) / (1.0 - 0.9 / 3.0)));
  CHECK(sigmas(binomial_estimate(ours, kRays), binomial_estimate(theirs, kRays)) < 4.0);
}

TEST_CASE("an LBNL table is read from a file") {
  const auto path = scratch_folder("lbnl_file") / "GroundTeflon.dat";
  std::ofstream(path) << text_of(made_up(lobe));
  const SurfaceTable table = read_lbnl(path, lbnl_import());
  CHECK(table.reflectance(Side::inside, 0.5) == 1.0);
  CHECK(table.provenance().map.find("GroundTeflon.dat") != std::string::npos);
  CHECK(table.provenance().preparation.find("mirror") != std::string::npos);
}

TEST_CASE("a table written in LBNL's layout and read back reflects the same light on its grid") {
  // A reflector behind the face: nothing is transmitted; lobes of 12 deg about the mirrored ray.
  std::vector<TableNode> nodes;
  for (int degree = 0; degree <= 90; degree += 5) {
    TableNode node;
    node.incidence_rad = node.traced_incidence_rad = std::min(degree * kDegree, 0.5 * kPi);
    node.reflectance = 0.9 + 0.0005 * degree;
    node.absorptance = 1.0 - node.reflectance;
    std::vector<ExitAngles> sample;
    for (std::uint64_t k = 0; sample.size() < 20'000; ++k) {
      Rng rng(63, StreamKind::other, static_cast<std::uint64_t>(degree), k);
      const double specular = node.incidence_rad;
      const Vec3 at = Vec3(std::sin(specular), 0.0, std::cos(specular)) +
                      0.2 * Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5) * 4.0;
      const Vec3 out = at.normalized();
      if (out.z() < 0.05) continue;
      sample.push_back({static_cast<float>(std::acos(out.z())),
                        static_cast<float>(std::abs(std::atan2(out.y(), out.x())))});
    }
    node.reflected = quantiles_of(sample);
    nodes.push_back(std::move(node));
  }
  const SurfaceTable before({1.82, 1.0}, nodes, nodes, {});
  for (const char* name : {"GroundTeflon.z", "GroundTeflon.dat"}) {
    const auto path = scratch_folder("lbnl_write") / name;
    const std::vector<std::string> notes = write_lbnl(path, before, {});
    REQUIRE(notes.size() == 3);
    // The mean of 0.9 + 0.0005 degree over diffuse light: 45 deg.
    CHECK(notes[0].find("REFLECTIVITY 0.9225") != std::string::npos);
    const SurfaceTable after = read_lbnl(path, lbnl_import(0.9225));
    const TableSide was(before, Side::inside), is(after, Side::inside);
    for (const double degrees : {0.0, 20.0, 45.0, 65.0}) {
      CAPTURE(degrees);
      CHECK(is.share(Leaving::reflected, degrees * kDegree) == doctest::Approx(0.9225).epsilon(0.001));
      const auto means = [&](const TableSide& side) {
        Vec3 sum = Vec3::Zero();
        constexpr int kPoints = 20'000;
        for (int k = 0; k < kPoints; ++k) {
          const CubePoint at = cube_point(static_cast<std::uint64_t>(k), {0.1, 0.2, 0.3});
          const ExitAngles exit = side.direction(Leaving::reflected, degrees * kDegree, at.u, at.v);
          const double x = std::sin(exit.polar) * std::cos(exit.azimuth);
          sum += Vec3(x, x * x, std::cos(exit.polar)) / kPoints;
        }
        return sum;
      };
      // Directions move by up to half a step of the grid, 2.5 deg, at random.
      CHECK((means(was) - means(is)).cwiseAbs().maxCoeff() < 0.01);
    }
  }
  const auto folder = scratch_folder("lbnl_refused");
  CHECK_THROWS_WITH_AS(write_lbnl(folder / "a.txt", before, {}), doctest::Contains("X.z"), InputError);
  nodes[0].absorptance = 0.0;
  nodes[0].transmitted = nodes[0].reflected;
  const SurfaceTable through({1.82, 1.0}, nodes, nodes, {});
  CHECK_THROWS_WITH_AS(write_lbnl(folder / "a.z", through, {}), doctest::Contains("transmitted"), InputError);
}
