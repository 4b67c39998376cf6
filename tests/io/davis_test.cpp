#include "scintray/tables/davis.hpp"

#include <doctest/doctest.h>

#include <memory>

#include "io/geant4_davis.hpp"
#include "io/tabulated.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/statistics.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::tables;
using namespace scintray::test;

namespace {

constexpr int kSamples = 20000;

/// A pair in full size, as text.
struct Written {
  explicit Written(const SurfaceTable& table, const std::string& name)
      : folder(scratch_folder(name)),
        file(folder / "Rough_LUT.dat"),
        notes(write_davis(file, table)),
        directions(file_content(file)),
        reflectances(file_content(folder / "Rough_LUTR.dat")),
        geant4(directions, reflectances, kSamples) {}

  std::filesystem::path folder, file;
  std::vector<std::string> notes;
  std::string directions, reflectances;
  Geant4Davis geant4;
};

const Written& rough() {
  static const Written written(rough_table(), "davis_rough");
  return written;
}

const Written& nearly_polished() {
  static const Written written(nearly_polished_table(), "davis_nearly_polished");
  return written;
}

/// Incidence within a degree, as diffuse light has it: cos^2 is uniform.
double incidence_within(int degree, Rng& rng) {
  const double low = std::cos(degree * kDegree), high = std::cos((degree + 1) * kDegree);
  return std::acos(std::sqrt(low * low + rng.uniform() * (high * high - low * low)));
}

/// Where light went: cosine to the normal (below 0: through the surface) and azimuth.
struct Went {
  double cosine, azimuth;
};

std::vector<Went> through_table(const SurfaceTable& table, int degree, std::uint64_t rays) {
  std::vector<Went> result;
  for (std::uint64_t k = 0; k < rays; ++k) {
    Rng rng(51, StreamKind::other, static_cast<std::uint64_t>(degree), k);
    const double incidence = incidence_within(degree, rng);
    Ray ray{{std::sin(incidence), 0.0, std::cos(incidence)}, Vec3::Zero()};
    table.scatter(ray, Side::inside, Vec3::UnitZ(), kLsoToAir, rng);
    result.push_back({-ray.direction.z(), std::atan2(ray.direction.y(), ray.direction.x())});
  }
  return result;
}

std::vector<Went> through_geant4(const Geant4Davis& geant4, int degree, std::uint64_t rays) {
  std::vector<Went> result;
  for (std::uint64_t k = 0; k < rays; ++k) {
    Rng rng(52, StreamKind::other, static_cast<std::uint64_t>(degree), k);
    const double incidence = incidence_within(degree, rng);
    const Vec3 out =
        geant4.sample({std::sin(incidence), 0.0, std::cos(incidence)}, Vec3(0.0, 0.0, -1.0), rng);
    result.push_back({-out.z(), std::atan2(out.y(), out.x())});
  }
  return result;
}

/// Histograms of cosine x azimuth, with edges at the quantiles of the larger sample. Our photons' azimuths
/// are no finer than a cosine in single precision, so edges next to 0 carry no information.
double p_value(const std::vector<Went>& large, const std::vector<Went>& small) {
  constexpr std::size_t kCosines = 16, kAzimuths = 8;
  const auto edges = [&](auto value, std::size_t bins, double least) {
    std::vector<double> sorted;
    for (const Went& w : large) sorted.push_back(value(w));
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> result;
    for (std::size_t k = 1; k < bins; ++k) {
      const double edge = sorted[sorted.size() * k / bins];
      if (std::abs(edge) >= least) result.push_back(edge);
    }
    return result;
  };
  const auto cosines = edges([](const Went& w) { return w.cosine; }, kCosines, 0.0);
  const auto azimuths = edges([](const Went& w) { return w.azimuth; }, kAzimuths, 0.003);
  const auto histogram = [&](const std::vector<Went>& sample) {
    std::vector<std::uint64_t> counts(kCosines * kAzimuths, 0);
    for (const Went& w : sample) {
      const auto bin = [](const std::vector<double>& at, double x) {
        return static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), x) - at.begin());
      };
      ++counts[bin(cosines, w.cosine) * kAzimuths + bin(azimuths, w.azimuth)];
    }
    return counts;
  };
  return chi_square_two_samples(histogram(large), histogram(small)).p_value;
}

Moments polar_angles(const std::vector<Went>& sample, bool reflected) {
  Moments moments;
  for (const Went& w : sample)
    if ((w.cosine > 0.0) == reflected) moments.add(std::acos(std::abs(w.cosine)) / kDegree);
  return moments;
}

constexpr int kDegrees[] = {1, 2, 15, 30, 33, 40, 60, 80, 88, 89};

ImportSettings lso_to_air() {
  ImportSettings settings;
  settings.index = kLsoToAir;
  return settings;
}

}  // namespace

TEST_CASE("a pair has as many numbers as Geant4 reads, and both containers hold the same") {
  const Geant4Davis& geant4 = rough().geant4;
  CHECK(geant4.whole);
  write_davis(rough().folder / "Rough_LUT.z", rough_table());
  CHECK(uncompressed(file_content(rough().folder / "Rough_LUT.z")) == rough().directions);
  CHECK(uncompressed(file_content(rough().folder / "Rough_LUTR.z")) == rough().reflectances);
  CHECK(rough().notes.size() == 3);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(rough().folder)) files += entry.exists();
  CHECK(files == 4);  // nothing unfinished is left
}

TEST_CASE("what Geant4 samples from a pair is what the table has in that degree") {
  for (const Written* written : {&rough(), &nearly_polished()}) {
    const SurfaceTable& table = written == &rough() ? rough_table() : nearly_polished_table();
    const Geant4Davis& geant4 = written->geant4;
    for (const int degree : kDegrees) {
      CAPTURE(degree);
      // Fewer rays than pairs, so that the pairs' own unevenness stays below the counting error. One false
      // alarm in 10,000 for each of the 20 comparisons.
      CHECK(p_value(through_table(table, degree, 200'000), through_geant4(geant4, degree, 10'000)) > 1e-4);
    }
  }
}

TEST_CASE("mean directions are right to a small part of a degree: no block is read for its neighbour") {
  const Geant4Davis& geant4 = nearly_polished().geant4;
  for (const int degree : kDegrees) {
    const auto expected = through_table(nearly_polished_table(), degree, 100'000);
    const auto sampled = through_geant4(geant4, degree, 100'000);
    for (const bool reflected : {true, false}) {
      const Moments a = polar_angles(expected, reflected), b = polar_angles(sampled, reflected);
      if (a.count < 1000) continue;
      CAPTURE(degree);
      CAPTURE(reflected);
      CHECK(sigmas(a.mean(), b.mean()) < 4.0);
      CHECK(b.mean().error < 0.1);  // a neighbour's block would be 10 errors away
    }
  }
}

TEST_CASE("the reflectance of a degree is the table's mean over it") {
  const Geant4Davis& geant4 = rough().geant4;
  for (int degree = 0; degree < 90; ++degree) {
    double sum = 0.0, weights = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const double angle = (degree + (k + 0.5) / 1000) * kDegree;
      const double weight = std::sin(2.0 * angle);
      sum += weight * rough_table().reflectance(Side::inside, angle);
      weights += weight;
    }
    CHECK(geant4.reflectance(degree) == doctest::Approx(sum / weights).epsilon(1e-4));
  }
}

TEST_CASE("below one degree Geant4 reflects light back or transmits it straight on") {
  Rng rng(53, StreamKind::other, 0);
  const double incidence = 0.4 * kDegree;
  const Vec3 momentum(std::sin(incidence), 0.0, std::cos(incidence));
  const SurfaceTable table = read_davis(rough().file, lso_to_air());
  for (int k = 0; k < 200; ++k) {
    const Vec3 geant4 = rough().geant4.sample(momentum, {0.0, 0.0, -1.0}, rng);
    CHECK(std::abs(std::abs(geant4.dot(momentum)) - 1.0) < 1e-12);
    Ray ray{momentum, Vec3::Zero()};
    const Side after = table.scatter(ray, Side::inside, Vec3::UnitZ(), kLsoToAir, rng);
    CHECK((after == Side::inside ? Vec3(-momentum) : momentum).dot(ray.direction.vec()) >
          std::cos(0.01 * kDegree));
  }
}

TEST_CASE("a pair read back has the distributions that Geant4 samples from it, from either container") {
  const Geant4Davis& geant4 = rough().geant4;
  const auto file = rough().folder / "Rough_LUT.z";
  write_davis(file, rough_table());
  const SurfaceTable packed = read_davis(file, lso_to_air());
  const SurfaceTable plain = read_davis(rough().file, lso_to_air());
  for (const int degree : kDegrees) {
    CAPTURE(degree);
    CHECK(packed.reflectance(Side::inside, (degree + 0.3) * kDegree) ==
          doctest::Approx(geant4.reflectance(degree)).epsilon(1e-6));
    CHECK(p_value(through_table(packed, degree, 200'000), through_geant4(geant4, degree, 10'000)) > 1e-4);
    CHECK(packed.nodes(Side::inside)[static_cast<std::size_t>(2 * degree)].reflected.polar ==
          plain.nodes(Side::inside)[static_cast<std::size_t>(2 * degree)].reflected.polar);
  }
}

TEST_CASE("from outside an imported surface is what the user sets, and the table's provenance has it") {
  ImportSettings settings = lso_to_air();
  const SurfaceTable smooth = read_davis(rough().file, settings);
  CHECK(smooth.provenance().preparation.find("smooth") != std::string::npos);
  for (const double degrees : {0.0, 30.0, 60.0, 80.0})
    CHECK(smooth.reflectance(Side::outside, degrees * kDegree) ==
          doctest::Approx(fresnel(std::cos(degrees * kDegree), 1.0, 1.82).unpolarised()).epsilon(1e-3));
  settings.from_outside = FromOutside::mirror;
  const SurfaceTable mirror = read_davis(rough().file, settings);
  CHECK(mirror.provenance().preparation.find("mirror") != std::string::npos);
  Rng rng(54, StreamKind::other, 0);
  Ray ray{{0.6, 0.0, -0.8}, Vec3::Zero()};
  CHECK(mirror.scatter(ray, Side::outside, Vec3::UnitZ(), kLsoToAir, rng) == Side::outside);
  CHECK((ray.direction - Vec3(0.6, 0.0, 0.8)).norm() < 1e-6);
}

TEST_CASE(
    "the absorption of a table is printed when a pair is written, and can be requested when one is read") {
  std::vector<TableNode> nodes = rough_table().nodes(Side::inside);
  for (TableNode& node : nodes) {
    node.absorptance = 0.25 * (1.0 - node.reflectance);
    node.absorptance_error = 0.0;
  }
  const auto folder = scratch_folder("davis_absorbing");
  const SurfaceTable absorbing(kLsoToAir, nodes, rough_table().nodes(Side::outside), {});
  DavisSettings settings;
  settings.layout.samples = 10;
  const auto notes = write_davis(folder / "A_LUT.dat", absorbing, settings);
  REQUIRE(notes.size() == 4);
  CHECK(notes.back().find("absorbed") != std::string::npos);
  ImportSettings import = lso_to_air();
  import.unreflected = Unreflected::absorbed;
  import.from_outside = FromOutside::absorb;
  const SurfaceTable read = read_davis(rough().file, import);
  CHECK(read.opaque());
  CHECK(read.nodes(Side::inside)[40].absorptance ==
        doctest::Approx(1.0 - read.nodes(Side::inside)[40].reflectance));
  Rng rng(55, StreamKind::other, 0);
  Ray ray{{0.6, 0.0, -0.8}, Vec3::Zero()};
  CHECK(read.interact(ray, Side::outside, Vec3::UnitZ(), Vec3::Zero(), 0.0, rng) == SurfaceOutcome::absorbed);
}

TEST_CASE(
    "of a table of several wavelengths one has to be chosen; tables that no format can hold are refused") {
  const auto folder = scratch_folder("davis_wavelengths");
  const auto slice = [&](double wavelength_nm, double azimuth_rad) {
    TableSlice result;
    result.wavelength_nm = wavelength_nm;
    result.azimuth_rad = azimuth_rad;
    result.index = kLsoToAir;
    result.from_inside = rough_table().nodes(Side::inside);
    result.from_outside = rough_table().nodes(Side::outside);
    return result;
  };
  const SurfaceTable colours({slice(400.0, 0.0), slice(500.0, 0.0)}, AzimuthKind::folded, {});
  CHECK(slice_at(colours, 500.0) == 1);
  CHECK_THROWS_WITH_AS(slice_at(colours, {}), doctest::Contains("400 nm, 500 nm"), InputError);
  CHECK_THROWS_WITH_AS(slice_at(colours, 450.0), doctest::Contains("no slice at 450 nm"), InputError);
  const SurfaceTable grooves({slice(0.0, 0.0), slice(0.0, kPi)}, AzimuthKind::directional, {});
  CHECK_THROWS_WITH_AS(write_davis(folder / "A_LUT.z", grooves), doctest::Contains("2 azimuths"), InputError);
  // Light that keeps its bin and goes on forward.
  constexpr std::size_t kRow = std::size_t{ReciprocalKernel::kStates} * ReciprocalKernel::kTurns;
  std::vector<float> shares(ReciprocalKernel::kStates * kRow, 0.0f);
  for (int state = 0; state < ReciprocalKernel::kStates; ++state)
    shares[static_cast<std::size_t>(state) * kRow +
           static_cast<std::size_t>(ReciprocalKernel::target(state, 0.0))] = 1.0f;
  TableSlice mirrors = slice(0.0, 0.0);
  mirrors.reciprocal = std::make_shared<const ReciprocalKernel>(shares);
  const SurfaceTable reciprocal({mirrors}, AzimuthKind::folded, {});
  CHECK_THROWS_WITH_AS(write_davis(folder / "A_LUT.z", reciprocal), doctest::Contains("made reciprocal"),
                       InputError);
  CHECK(std::filesystem::is_empty(folder));
}

TEST_CASE("the same seed makes the same pair, another seed another") {
  const auto folder = scratch_folder("davis_seeds");
  DavisSettings settings;
  settings.layout.samples = 50;
  const auto content = [&](const std::string& name, std::uint64_t seed) {
    settings.seed = seed;
    write_davis(folder / name, rough_table(), settings);
    return file_content(folder / name);
  };
  const std::string first = content("A_LUT.dat", 7);
  CHECK(content("B_LUT.dat", 7) == first);
  CHECK(content("C_LUT.dat", 8) != first);
}

TEST_CASE("names that Geant4 does not use, and folders that are not there") {
  for (const char* name : {"Rough.z", "Rough_LUT.txt", "Rough_LUT", "_LUT.z", "Rough_LUTR.z"})
    CHECK_THROWS_AS(davis_files(name), InputError);
  CHECK(davis_files("a/Rough_LUT.z").reflectances == std::filesystem::path("a/Rough_LUTR.z"));
  const auto folder = scratch_folder("davis_names");
  CHECK_THROWS_AS(write_davis(folder / "none" / "Rough_LUT.z", rough_table()), SystemError);
  CHECK_THROWS_AS(read_davis(folder / "Rough_LUT.z", lso_to_air()), InputError);
  ImportSettings wrong = lso_to_air();
  wrong.index.outside = 0.0;
  CHECK_THROWS_AS(read_davis(rough().file, wrong), InputError);
}
