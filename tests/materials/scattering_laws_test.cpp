// Reflectors with a measured BRDF and mirrors that scatter: energy, reciprocity, equilibrium, the laws
// themselves, and NIST's measurement of sintered PTFE.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>

#include "database_helpers.hpp"
#include "scintray/config/csv.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/materials/measured_brdf.hpp"
#include "scintray/materials/surface_factory.hpp"
#include "support/agreement.hpp"
#include "support/evidence.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::materials;
using namespace scintray::tables;
using namespace scintray::test;

namespace {

constexpr IndexPair kMedia{1.82, 1.0};
constexpr double kLight_nm = 500.0;
const Vec3 kFace(0.48, -0.6, 0.64);

/// A reciprocal BRDF with a rise towards grazing forward light, as of PTFE; at scale 1 it reflects 0.69 to
/// 0.97.
double made_up_brdf(double x_in, double x_out, double turn, double scale = 1.0) {
  return scale * 0.22 *
         (1.0 + 0.8 * x_in * x_out * (1.0 + std::cos(turn)) + 0.1 * std::sqrt(x_in * x_out) * std::cos(turn));
}

std::vector<BrdfPoint> made_up_points(double nm, double scale = 1.0) {
  std::vector<BrdfPoint> points;
  for (const double in_deg : {0.0, 15.0, 30.0, 45.0, 60.0, 75.0})
    for (int out_deg = 0; out_deg <= 80; out_deg += 8)
      for (int turn_deg = 0; turn_deg <= 180; turn_deg += 20) {
        const double in = in_deg * kDegree, out = out_deg * kDegree, turn = turn_deg * kDegree;
        const double x_in = std::pow(std::sin(in), 2), x_out = std::pow(std::sin(out), 2);
        points.push_back({nm, in, out, turn, made_up_brdf(x_in, x_out, turn, scale)});
      }
  return points;
}

/// A file in the columns of NIST's data: light from the azimuth opposite to phi, so that turn is phir - phi.
std::filesystem::path made_up_csv(double scale) {
  static const auto folder = scratch_folder("made_up_brdf");
  const auto path = folder / fmt::format("brdf_{:g}.csv", scale);
  std::ofstream out(path);
  out << "lambda,thetai,phi,thetar,phir,f_r11,f_r12/f_r11\n";
  for (const double nm : {400.0, 600.0})
    for (const BrdfPoint& point : made_up_points(nm, scale))
      out << fmt::format("{},{},10,{},{},{},0\n", nm * 1e-3, -point.incidence_rad / kDegree - 1e-9,
                         point.polar_rad / kDegree, point.turn_rad / kDegree + 10.0, point.value_per_sr);
  return path;
}

MaterialDatabase scattering_database(const std::string& text) {
  return database_with(DefinitionKind::surface, "mine", text);
}

Surface scattering_surface(const std::string& text) {
  Medium inside, outside;
  inside.index = Curve::constant(kMedia.inside);
  outside.index = Curve::constant(kMedia.outside);
  SurfaceFactory factory;
  const MaterialDatabase database = scattering_database(text);
  return factory.make(database.surface("mine"), inside, outside, kLight_nm, kLight_nm, kLight_nm).surface;
}

std::string measured(double scale, const std::string& more = "") {
  return "model = \"measured_brdf\"\nmeasured_brdf = { file = \"" + made_up_csv(scale).string() + "\"" +
         more + " }\n";
}
std::string mirror_with(const std::string& law, const std::string& more = "") {
  return "model = \"mirror_scatter\"\nmirror_scatter = { " + law + more + " }\n";
}
const std::string kAbg = "abg = { a = 0.02, b = 0.01, g = 1.6 }";
const std::string kGaussian = "gaussian = { share = 0.6, sigma = 0.3 }";
const std::string kHarveyShack = "harvey_shack = { b0 = 5, l = 0.05, s = -1.5 }";
const std::string kKCorrelation =
    "k_correlation = { rms_height = \"8 nm\", knee_length = \"2 um\", exponent = 2.2 }";

constexpr int kSines = 10, kTurnBins = 6;

/// Flux between directions under Lambertian light: counts by bin of sine squared, in and out, and of the
/// azimuth between the two.
struct Exchange {
  std::uint64_t absorbed = 0;
  std::array<std::uint64_t, kSines * kSines * kTurnBins> counts{};
  std::array<std::uint64_t, kSines> leaving{};
  std::uint64_t& between(int in, int out, int turn) {
    return counts[static_cast<std::size_t>((in * kSines + out) * kTurnBins + turn)];
  }
};

Exchange exchange_of(const Surface& surface, Side side, std::uint64_t rays) {
  Exchange exchange;
  const Vec3 into = side == Side::inside ? kFace : Vec3(-kFace);
  const auto bin = [](double cosine) {
    return std::min(kSines - 1, static_cast<int>((1.0 - cosine * cosine) * kSines));
  };
  for (std::uint64_t i = 0; i < rays; ++i) {
    Rng rng(71, StreamKind::other, i, static_cast<std::uint64_t>(side));
    Ray ray{sample_lambertian(into, rng), Vec3::Zero()};
    const Vec3 before = ray.direction;
    const SurfaceOutcome outcome = surface.interact(ray, side, kFace, kMedia, kLight_nm, rng);
    if (outcome == SurfaceOutcome::absorbed) {
      ++exchange.absorbed;
      continue;
    }
    REQUIRE(outcome == outcome_on(side));
    const Vec3 after = ray.direction;
    REQUIRE(std::abs(after.norm() - 1.0) < 1e-6);
    REQUIRE(after.dot(into) < 0.0);
    const Vec3 in_face = before - before.dot(kFace) * kFace, out_face = after - after.dot(kFace) * kFace;
    const double turn = std::acos(std::clamp(in_face.normalized().dot(out_face.normalized()), -1.0, 1.0));
    const int out = bin(after.dot(kFace));
    ++exchange.leaving[static_cast<std::size_t>(out)];
    ++exchange.between(bin(before.dot(kFace)), out,
                       std::min(kTurnBins - 1, static_cast<int>(turn / kPi * kTurnBins)));
  }
  return exchange;
}

/// Chi-square of the flux between two directions against its reverse.
ChiSquare reciprocity_of(Exchange exchange) {
  double chi2 = 0.0;
  double degrees = 0.0;
  for (int a = 0; a < kSines; ++a)
    for (int b = 0; b < a; ++b)
      for (int k = 0; k < kTurnBins; ++k) {
        const auto there = static_cast<double>(exchange.between(a, b, k)),
                   back = static_cast<double>(exchange.between(b, a, k));
        if (there + back < 10.0) continue;
        chi2 += std::pow(there - back, 2) / (there + back);
        degrees += 1.0;
      }
  ChiSquare result{};
  result.chi2 = chi2;
  result.degrees = static_cast<decltype(result.degrees)>(degrees);
  // Wilson and Hilferty 1931: the cube root of chi2 over its degrees is nearly normal.
  const double z =
      (std::cbrt(chi2 / degrees) - (1.0 - 2.0 / (9.0 * degrees))) / std::sqrt(2.0 / (9.0 * degrees));
  result.p_value = 0.5 * std::erfc(z / std::sqrt(2.0));
  return result;
}

struct Scatterer {
  std::string name, text;
  bool lossless;
};

std::vector<Scatterer> scatterers() {
  return {
      {"measured BRDF", measured(1.0), false},
      {"measured BRDF that absorbs nothing at grazing incidence", measured(1.1), false},
      {"smooth | air | measured BRDF", measured(1.0, ", gap = 1.0"), false},
      {"mirror, ABg", mirror_with(kAbg), true},
      {"mirror, Harvey and Shack", mirror_with(kHarveyShack), true},
      {"mirror, Gaussian", mirror_with(kGaussian), true},
      {"mirror, Harvey and Shack, s = -2", mirror_with("harvey_shack = { b0 = 5, l = 0.05, s = -2 }"), true},
      {"mirror, K-correlation", mirror_with(kKCorrelation), true},
      {"smooth | n 1.5 | mirror, ABg", mirror_with(kAbg, ", gap = 1.5"), true},
      {"mirror of 0.9, ABg", mirror_with(kAbg, ", reflectance = 0.9"), false}};
}

}  // namespace

TEST_CASE("Law of scattering reflectors: energy, reciprocity of every pair of directions, and equilibrium") {
  constexpr std::uint64_t kRays = 400'000;
  for (const Scatterer& scatterer : scatterers()) {
    CAPTURE(scatterer.name);
    const Surface surface = scattering_surface(scatterer.text);
    CHECK(surface.opaque());
    for (const Side side : {Side::inside, Side::outside}) {
      const Exchange exchange = exchange_of(surface, side, kRays);
      std::uint64_t left = 0;
      for (const std::uint64_t count : exchange.leaving) left += count;
      CHECK(left + exchange.absorbed == kRays);
      CHECK((exchange.absorbed == 0) == scatterer.lossless);
      const ChiSquare reciprocity = reciprocity_of(exchange);
      CAPTURE(reciprocity.chi2);
      CAPTURE(reciprocity.degrees);
      CHECK(reciprocity.p_value > 6.3e-5);
      if (scatterer.lossless) {
        const std::vector<std::uint64_t> leaving(exchange.leaving.begin(), exchange.leaving.end());
        CHECK(chi_square_test(leaving, std::vector<double>(kSines, static_cast<double>(kRays) / kSines))
                  .p_value > 6.3e-5);
      }
    }
  }
}

TEST_CASE("a BRDF's table is symmetric to the last bit, follows its points, and reflects at most all light") {
  const BrdfTable table = BrdfTable::fitted(made_up_points(500.0));
  CHECK(table.residuals().points == 6 * 11 * 10);
  CHECK(table.residuals().rms < 0.005);
  CHECK(std::abs(table.residuals().mean) < 0.001);
  CHECK(table.residuals().largest < 0.03);
  CHECK(table.residuals().scaled == 0.0);
  for (const double a : {0.0, 0.1, 0.37, 0.9, 1.0})
    for (const double b : {0.05, 0.5, 0.99})
      for (const double turn : {0.0, 1.0, 3.0}) {
        CHECK(table.value_per_sr(a, b, turn) ==
              doctest::Approx(table.value_per_sr(b, a, turn)).epsilon(1e-14));
        if (std::max(a, b) < 0.95)
          CHECK(table.value_per_sr(a, b, turn) == doctest::Approx(made_up_brdf(a, b, turn)).epsilon(0.02));
      }
  const BrdfTable bright = BrdfTable::fitted(made_up_points(500.0, 1.25));
  CHECK(bright.residuals().scaled > 0.1);
  for (int k = 0; k <= 100; ++k) CHECK(bright.reflectance(0.01 * k) <= 1.0 + 1e-9);
  CHECK(bright.reflectance(1.0) > 0.99);
  CHECK(bright.value_per_sr(0.9, 0.2, 1.0) ==
        doctest::Approx(bright.value_per_sr(0.2, 0.9, 1.0)).epsilon(1e-14));
}

TEST_CASE("Lambert's law as a table: its reflectance in every direction, and its directions") {
  const BrdfTable table = BrdfTable::of([](double, double, double) { return 0.8 / kPi; });
  CHECK(table.diffuse_reflectance() == doctest::Approx(0.8));
  std::vector<std::uint64_t> sines(20), turns(20);
  std::uint64_t absorbed = 0;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    Rng rng(72, StreamKind::other, i);
    const auto exit = table.sample(rng.uniform(), rng);
    if (!exit) {
      ++absorbed;
      continue;
    }
    ++sines[static_cast<std::size_t>(std::min(19.0, exit->x * 20))];
    ++turns[static_cast<std::size_t>(std::min(19.0, exit->turn_rad / kPi * 20))];
  }
  CHECK(sigmas(binomial_estimate(absorbed, 200'000), {0.2, 0.0}) < kSigmas);
  const std::vector<double> even(20, static_cast<double>(200'000 - absorbed) / 20);
  CHECK(chi_square_test(sines, even).p_value > 6.3e-5);
  CHECK(chi_square_test(turns, even).p_value > 6.3e-5);
}

TEST_CASE("directions are drawn with the density of the table, between its nodes too") {
  const BrdfTable table = BrdfTable::fitted(made_up_points(500.0));
  constexpr int kX = 12, kT = 9, kFine = 40;
  constexpr std::uint64_t kRays = 500'000;
  for (const double x_in : {0.0, 0.3, 0.93}) {
    CAPTURE(x_in);
    std::vector<std::uint64_t> counts(kX * kT + 1);
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(73, StreamKind::other, i);
      const auto exit = table.sample(x_in, rng);
      const int cell = exit ? std::min(kX - 1, static_cast<int>(exit->x * kX)) * kT +
                                  std::min(kT - 1, static_cast<int>(exit->turn_rad / kPi * kT))
                            : kX * kT;
      ++counts[static_cast<std::size_t>(cell)];
    }
    std::vector<double> expected(kX * kT + 1);
    for (int i = 0; i < kX * kFine; ++i)
      for (int j = 0; j < kT * kFine; ++j)
        expected[static_cast<std::size_t>(i / kFine * kT + j / kFine)] +=
            kRays * table.value_per_sr(x_in, (i + 0.5) / (kX * kFine), (j + 0.5) / (kT * kFine) * kPi) * kPi /
            (kX * kFine * kT * kFine);
    expected.back() = kRays * (1.0 - table.reflectance(x_in));
    CHECK(chi_square_test(counts, expected).p_value > 6.3e-5);
  }
}

TEST_CASE("a mirror scatters what its law has within a distance of the specular direction") {
  // Integrals of the law over the plane of direction cosines, at normal incidence, within r: closed forms.
  const double waves = kLight_nm / kMedia.inside, sq = 8.0, knee = 2000.0;
  const auto k_correlation_within = [&](double r) {
    // The obliquity factor is the cosine of exit: integral by the midpoint rule.
    double sum = 0.0;
    constexpr int kSteps = 20'000;
    for (int k = 0; k < kSteps; ++k) {
      const double at = (k + 0.5) * r / kSteps, f = at / waves;
      const double spectrum =
          sq * sq * knee * knee * 1.2 / kTwoPi * std::pow(1.0 + std::pow(knee * f, 2), -1.6);
      sum += 16.0 * kPi * kPi / std::pow(waves, 4) * std::sqrt(1.0 - at * at) * spectrum * kTwoPi * at * r /
             kSteps;
    }
    return sum;
  };
  const auto abg_within = [](double r) {
    double sum = 0.0;
    constexpr int kSteps = 200'000;
    for (int k = 0; k < kSteps; ++k) {
      const double at = (k + 0.5) * r / kSteps;
      sum += 0.02 / (0.01 + std::pow(at, 1.6)) * kTwoPi * at * r / kSteps;
    }
    return sum;
  };
  const auto harvey_within = [](double r) {
    return kTwoPi * 5.0 * 0.05 * 0.05 / 0.5 * (std::pow(1.0 + std::pow(r / 0.05, 2), 0.25) - 1.0);
  };
  // Beyond the unit circle the light is specular: 0.6 x exp(-1 / 0.09) of it.
  const auto gaussian_within = [](double r) {
    return 0.6 * std::expm1(-std::pow(r / 0.3, 2)) / std::expm1(-std::pow(2.0 / 0.3, 2));
  };
  constexpr std::uint64_t kRays = 400'000;
  const auto check = [&](const std::string& law, const auto& within) {
    const Surface surface = scattering_surface(mirror_with(law));
    std::array<std::uint64_t, 4> inside_of{};
    constexpr std::array<double, 4> kRadii{0.02, 0.1, 0.4, 0.99};
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(74, StreamKind::other, i);
      Ray ray{Vec3::UnitZ(), Vec3::UnitX()};
      REQUIRE(surface.interact(ray, Side::inside, Vec3::UnitZ(), kMedia, kLight_nm, rng) ==
              SurfaceOutcome::inside);
      const double r = std::hypot(ray.direction.x(), ray.direction.y());
      for (std::size_t k = 0; k < kRadii.size(); ++k) inside_of[k] += r > 1e-9 && r < kRadii[k];
      REQUIRE(std::abs(ray.polarisation.dot(ray.direction)) < 1e-6);
    }
    for (std::size_t k = 0; k < kRadii.size(); ++k) {
      CAPTURE(law);
      CAPTURE(kRadii[k]);
      const Estimate share = binomial_estimate(inside_of[k], kRays);
      const double expected = within(kRadii[k]);
      CHECK(sigmas(share, {expected, 0.0}) < kSigmas);
      evidence("scatter_laws",
               {law.substr(0, law.find(' ')), fmt::format("{:g}", kRadii[k]), fmt::format("{:.5f}", expected),
                fmt::format("{:.5f} ± {:.5f}", share.value, share.error),
                fmt::format("{:.1f}", sigmas(share, {expected, 0.0}))});
    }
  };
  check(kAbg, abg_within);
  check(kHarveyShack, harvey_within);
  check(kGaussian, gaussian_within);
  check(kKCorrelation, k_correlation_within);
}

TEST_CASE(
    "a mirror that would scatter more than it reflects, and keys without sense, are errors with their "
    "place") {
  const auto problems = [](const std::string& text) {
    return problems_of([&] { scattering_surface(text); });
  };
  CHECK(reports(problems(mirror_with("abg = { a = 2, b = 0.01, g = 1.6 }")), 2, "more than its reflectance"));
  CHECK(reports(problems(mirror_with(
                    "k_correlation = { rms_height = \"100 nm\", knee_length = \"2 um\", exponent = 2 }")),
                2, "more than its reflectance"));
  CHECK(reports(problems(mirror_with("abg = { a = 0.1, b = -1, g = 1 }")), 2, "above 0"));
  CHECK(reports(problems(mirror_with("abg = { a = 1e-6, b = 1e-9, g = 1 }")), 2, "the knee of the law"));
  CHECK(reports(problems(mirror_with("gaussian = { share = 1.2, sigma = 0.1 }")), 2, "between 0 and 1"));
  CHECK(reports(problems(mirror_with("gaussian = { share = 0.2, sigma = 6 }")), 2, "5 at most"));
  CHECK(reports(problems(mirror_with("harvey_shack = { b0 = 1, l = 0.1, s = 0.5 }")), 2, "not above 0"));
  CHECK(reports(problems(mirror_with(
                    "k_correlation = { rms_height = \"1 nm\", knee_length = \"1 um\", exponent = 1 }")),
                2, "above 1"));
  CHECK(reports(problems(mirror_with(kAbg, ", " + kHarveyShack)), 2, "harvey_shack"));
  CHECK(reports(problems(mirror_with("reflectance = 0.9")), 0, "abg"));
  CHECK(reports(problems(mirror_with(kAbg, ", reflectance = 1.2")), 2, "between 0 and 1"));
  CHECK(reports(problems(mirror_with(kAbg, ", gap = 0.5")), 2, "between 1 and 5"));
}

TEST_CASE("a file of a measured BRDF that cannot be used is an error with its line, and what to write") {
  const auto folder = scratch_folder("bad_brdf");
  int number = 0;
  const auto problems = [&](const std::string& content) {
    const auto path = folder / (std::to_string(++number) + ".csv");
    std::ofstream(path) << content;
    return problems_of([&] {
      scattering_surface("model = \"measured_brdf\"\nmeasured_brdf = { file = \"" + path.string() + "\" }\n");
    });
  };
  const std::string heading = "lambda,thetai,phi,thetar,phir,f_r11\n";
  CHECK(reports(problems("lambda,thetai,thetar,phir,f_r11\n0.5,0,0,0,0.3\n"), 2, "no column \"phi\""));
  CHECK(reports(problems(heading + "0.5,-10,0,20,0,0.3\n532,-10,0,20,0,0.3\n"), 2, "csv:3"));
  CHECK(reports(problems(heading + "0.5,-95,0,20,0,0.3\n"), 2, "-90 to 90 deg"));
  CHECK(reports(problems(heading + "0.5,-10,0,120,0,0.3\n"), 2, "0 to 90 deg"));
  CHECK(reports(problems(heading + "0.5,-10,0,20,0,-0.3\n"), 2, "0 or more"));
  CHECK(reports(problems(heading + "0.5,-10,0,20,0,0.3\n"), 2, "at least 20"));
  std::string lobe = heading;  // 100 times as bright within 1 deg of the mirrored ray
  for (int in = 10; in <= 60; in += 10)
    for (int out = 9; out <= 61; ++out)
      lobe += fmt::format("0.5,-{},0,{},0,{}\n", in, out, std::abs(in - out) < 1 ? 30.0 : 0.3);
  CHECK(reports(problems(lobe), 2, "narrower than its nodes"));
  CHECK(reports(problems_of([] {
                  scattering_surface("model = \"measured_brdf\"\nmeasured_brdf = { file = \"none.csv\" }\n");
                }),
                2, "none.csv"));
}

TEST_CASE("between two wavelengths of a measured BRDF its tables are mixed, and beyond them it is not used") {
  const std::string text = measured(1.0);
  const MaterialDatabase database = scattering_database(text);
  Medium medium;
  medium.index = Curve::constant(1.0);
  SurfaceFactory factory;
  CHECK_NOTHROW(factory.make(database.surface("mine"), medium, medium, 500, 400, 600));
  CHECK(reports(problems_of([&] { factory.make(database.surface("mine"), medium, medium, 500, 390, 600); }),
                2, "measured BRDFs"));
}

TEST_CASE(
    "NIST's sintered PTFE: the table reproduces the measurement, Lambert's law and a volume do less well") {
  const auto path = shared_file("data/reflectors/ptfe_nist/PTFE.data.csv");
  if (!path) return;
  const SurfaceSpec spec = scattering_database("model = \"measured_brdf\"\nmeasured_brdf = { file = \"" +
                                               path->string() + "\" }\n")
                               .surface("mine");
  const auto ptfe = microsurface_of<MeasuredBrdfSurface>(spec);
  REQUIRE(ptfe.brdf().wavelengths_nm.size() == 4);
  for (std::size_t k = 0; k < 4; ++k)
    CHECK(ptfe.brdf().wavelengths_nm[k] == doctest::Approx(std::array<double, 4>{351, 532, 633, 1064}[k]));
  const config::CsvTable rows = config::read_csv(*path);
  for (std::size_t slice = 0; slice < 4; ++slice) {
    const BrdfTable& table = ptfe.brdf().tables[slice];
    const BrdfResiduals& residuals = table.residuals();
    CHECK(residuals.points == 1824);
    // Relative deviation of A (1 - F(in)) (1 - F(out)), the volume-like reflector's diffuse light, with the
    // best A: index 1 is Lambert's law.
    const auto of_volume = [&](double index) {
      std::vector<double> ratios;
      double sum = 0.0, squares = 0.0;
      for (const auto& row : rows.rows) {
        if (std::abs(row.values[0] * 1e3 - ptfe.brdf().wavelengths_nm[slice]) > 0.5) continue;
        double shape = 1.0 / row.values[5];
        for (const double degrees : {std::abs(row.values[1]), row.values[3]})
          shape *= 1.0 - fresnel(std::cos(degrees * kDegree), 1.0, index).unpolarised();
        ratios.push_back(shape);
        sum += shape;
        squares += shape * shape;
      }
      double rms = 0.0;
      for (const double ratio : ratios) rms += std::pow(ratio * sum / squares - 1.0, 2);
      return std::sqrt(rms / static_cast<double>(ratios.size()));
    };
    double best = 1.0;
    for (double index = 1.0; index < 1.6; index += 0.01)
      if (of_volume(index) < of_volume(best)) best = index;
    CHECK(residuals.rms < 0.02);
    CHECK(std::abs(residuals.mean) < 0.003);
    CHECK(residuals.rms < 0.3 * of_volume(best));
    CHECK(of_volume(best) < of_volume(1.0));
    CHECK(table.diffuse_reflectance() > 0.95);
    const auto percent = [](double share) { return fmt::format("{:.2f} %", 100.0 * share); };
    evidence("ptfe_brdf", {fmt::format("{:g}", ptfe.brdf().wavelengths_nm[slice]), percent(of_volume(1.0)),
                           fmt::format("{:.2f}", best), percent(of_volume(best)), percent(of_volume(1.35)),
                           percent(residuals.rms), percent(residuals.largest), percent(residuals.scaled),
                           fmt::format("{:.3f}", table.reflectance(0.0)),
                           fmt::format("{:.3f}", table.diffuse_reflectance())});
  }
}
