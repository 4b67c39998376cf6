/// Tables of whole stacks, of several wavelengths, of surfaces with direction, and to a stated error.

#include <doctest/doctest.h>

#include <cmath>

#include "scintray/core/statistics.hpp"
#include "scintray/topography/build_table.hpp"
#include "scintray/topography/height_map.hpp"
#include "scintray/topography/synthesis.hpp"
#include "support/agreement.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;
using namespace scintray::test;

namespace {

constexpr IndexPair kIndex{1.82, 1.0};
constexpr std::uint64_t kRays = 100'000;

std::shared_ptr<const HeightField> rough_map() {
  static const auto map = [] {
    SynthesisRecipe recipe;
    recipe.gaussian = {0.5, 2.5};
    recipe.columns = recipe.rows = 192;
    return std::make_shared<const HeightField>(make_height_field(synthesize(recipe)));
  }();
  return map;
}

/// A saw-tooth along x, level along y: one face of each tooth rises by 30 deg, the other falls steeply.
std::shared_ptr<const HeightField> saw_tooth() {
  static const auto map = [] {
    constexpr std::uint32_t kTooth = 8, kColumns = 64, kRows = 8;
    std::vector<float> heights;
    for (std::uint32_t j = 0; j < kRows; ++j)
      for (std::uint32_t i = 0; i < kColumns; ++i)
        heights.push_back(static_cast<float>((i % kTooth) * std::tan(30.0 * kDegree)));
    return std::make_shared<const HeightField>(heights, kColumns, kRows, 1.0, 1.0);
  }();
  return map;
}

struct Seen {
  std::vector<std::uint64_t> outcomes = std::vector<std::uint64_t>(3, 0);
  std::vector<std::uint64_t> directions = std::vector<std::uint64_t>(8 * 8, 0);  ///< of reflected light
};

/// Light from inside at an incidence angle and azimuth.
Seen shine(const Surface& surface, double incidence, double azimuth, double wavelength_nm,
           std::uint64_t seed) {
  Seen seen;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    Rng rng(seed, StreamKind::other, i);
    Ray ray{Vec3(std::sin(incidence) * std::cos(azimuth), std::sin(incidence) * std::sin(azimuth),
                 std::cos(incidence)),
            Vec3::Zero()};
    const SurfaceOutcome outcome =
        surface.interact(ray, Side::inside, Vec3::UnitZ(), kIndex, wavelength_nm, rng);
    ++seen.outcomes[static_cast<std::size_t>(outcome)];
    if (outcome != SurfaceOutcome::inside) continue;
    const double turn = std::atan2(ray.direction.y(), ray.direction.x()) / kTwoPi + 0.5;
    const double sine2 = 1.0 - ray.direction.z() * ray.direction.z();
    const auto bin = [](double share) { return std::min(7, static_cast<int>(8.0 * share)); };
    ++seen.directions[static_cast<std::size_t>(8 * bin(sine2) + bin(turn))];
  }
  return seen;
}

Surface of_table(SurfaceTable table) {
  Surface surface;
  surface.microsurface = std::make_shared<const SurfaceTable>(std::move(table));
  return surface;
}

TableSettings quick() {
  TableSettings settings;
  settings.incidence_step_rad = 9.0 * kDegree;
  settings.azimuth_step_rad = 9.0 * kDegree;
  settings.rays = 2000;
  return settings;
}

/// Absorbs no light and changes no direction, but states the wrong side for a share of it.
class WrongSide : public MicrosurfaceModel {
 public:
  explicit WrongSide(double share) : share_(share) {}
  SurfaceOutcome scatter(Ray&, Side side, const IndexPair&, SurfaceInteraction& interaction) const override {
    return outcome_on(interaction.rng.uniform() < share_ ? side : other(side));
  }

 private:
  double share_;
};

/// The unclassified rays by the error of a table of such a surface; 0 where the table is made.
double unclassified_rays(double share, const TableSettings& settings) {
  Surface surface;
  surface.microsurface = WrongSide(share);
  try {
    const SurfaceTable table = build_stack_table(surface, {{420.0, {1.5, 1.5}}}, settings);
    CHECK(table.provenance().unclassified == 0);
    return 0.0;
  } catch (const InternalError& error) {
    return std::stod(error.what());  // the message begins with the number
  }
}

}  // namespace

TEST_CASE("The table of a whole stack agrees with the stack: reflected, absorbed, directions") {
  Surface stack;
  stack.microsurface = rough_map();
  stack.gap_thickness_um = 20.0;
  stack.reflector = Reflector{"ESR", Curve::constant(0.9), 1.0};
  const SurfaceTable table = build_stack_table(stack, {{420.0, kIndex}}, quick());
  CHECK(table.absorbs());
  CHECK(table.opaque());
  const Surface tabulated = of_table(table);
  CHECK(tabulated.opaque());
  for (const double degrees : {27.0, 63.0}) {  // nodes, where nothing is interpolated
    CAPTURE(degrees);
    const Seen own = shine(stack, degrees * kDegree, 0.0, 420.0, 1);
    const Seen its = shine(tabulated, degrees * kDegree, 0.0, 420.0, 2);
    CHECK(its.outcomes[static_cast<std::size_t>(SurfaceOutcome::outside)] == 0);
    // The table was traced with 80,000 rays of its own.
    const Estimate absorbed = binomial_estimate(own.outcomes[2], kRays);
    const Estimate from_table = binomial_estimate(its.outcomes[2], kRays);
    const double node_error = std::sqrt(absorbed.value * (1.0 - absorbed.value) / 80'000.0);
    CHECK(std::abs(absorbed.value - from_table.value) <
          kSigmas * std::hypot(absorbed.error, from_table.error, node_error));
    // 64 bins, the table's own noise included by doubling the variance: 4 sigma of chi2.
    const ChiSquare chi = chi_square_two_samples(own.directions, its.directions);
    CHECK(chi.chi2 / 2.0 < chi.degrees + kSigmas * std::sqrt(2.0 * chi.degrees));
  }
}

TEST_CASE("Between two wavelengths a table is their mean, beyond them the nearest") {
  const std::vector<SpectralPoint> spectrum{{400.0, {1.9, 1.0}}, {500.0, {1.6, 1.0}}};
  const SurfaceTable table = build_table(*rough_map(), spectrum, quick());
  CHECK(table.wavelengths_nm() == std::vector<double>{400.0, 500.0});
  const Surface surface = of_table(table);
  const double angle = 36.0 * kDegree;
  const double at_400 = table.reflectance(Side::inside, angle, 0),
               at_500 = table.reflectance(Side::inside, angle, 1);
  CHECK(at_400 - at_500 > 0.1);
  for (const auto& row : {std::pair{400.0, at_400}, std::pair{425.0, 0.75 * at_400 + 0.25 * at_500},
                          std::pair{500.0, at_500}, std::pair{350.0, at_400}, std::pair{600.0, at_500}}) {
    const auto& nm = row.first;
    const auto& expected = row.second;
    CAPTURE(nm);
    const Estimate seen = binomial_estimate(shine(surface, angle, 0.0, nm, 3).outcomes[0], kRays);
    CHECK(sigmas(seen, {expected, 0.0}) < kSigmas);
  }
}

TEST_CASE("A directional table depends on the azimuth of incidence") {
  TableSettings settings = quick();
  settings.directional = true;
  settings.rays = 40'000;
  settings.azimuth_step_rad = 45.0 * kDegree;
  settings.incidence_step_rad = 18.0 * kDegree;
  settings.refine = false;
  const SurfaceTable table = build_table(*saw_tooth(), {{420.0, kIndex}}, settings);
  CHECK(table.azimuths() == 8);
  Surface tabulated = of_table(table), own;
  own.microsurface = saw_tooth();
  const double incidence = 36.0 * kDegree;
  for (const double turn : {0.0, 90.0}) {  // the map as it lies, and turned on the face
    own.direction = tabulated.direction = Vec3(std::cos(turn * kDegree), std::sin(turn * kDegree), 0.0);
    for (const double azimuth : {0.0, 45.0, 180.0}) {
      CAPTURE(turn);
      CAPTURE(azimuth);
      const Seen a = shine(own, incidence, azimuth * kDegree, 420.0, 4);
      const Seen b = shine(tabulated, incidence, azimuth * kDegree, 420.0, 5);
      const Estimate p = binomial_estimate(a.outcomes[0], kRays), q = binomial_estimate(b.outcomes[0], kRays);
      const double node_error = std::sqrt(p.value * (1.0 - p.value) / 40'000.0);
      CHECK(std::abs(p.value - q.value) < kSigmas * std::hypot(p.error, q.error, node_error));
    }
  }
  // Up the slope or down it is not the same.
  own.direction = Vec3::UnitX();
  const Seen up = shine(own, incidence, 0.0, 420.0, 6), down = shine(own, incidence, kPi, 420.0, 7);
  CHECK(sigmas(binomial_estimate(up.outcomes[0], kRays), binomial_estimate(down.outcomes[0], kRays)) > 20.0);
}

TEST_CASE("Directions of a directional table are signed: light leaves on the side that it is reflected to") {
  TableSettings settings = quick();
  settings.directional = true;
  settings.rays = 40'000;
  settings.azimuth_step_rad = 90.0 * kDegree;
  settings.incidence_step_rad = 30.0 * kDegree;
  settings.refine = false;
  Surface tabulated = of_table(build_table(*saw_tooth(), {{420.0, kIndex}}, settings)), own;
  own.microsurface = saw_tooth();
  own.direction = tabulated.direction = Vec3::UnitX();
  // Along y the teeth throw light to one side, towards x: mean of the lateral direction of reflected light.
  const auto sideways = [&](const Surface& surface, std::uint64_t seed) {
    Moments mean;
    for (std::uint64_t i = 0; i < kRays; ++i) {
      Rng rng(seed, StreamKind::other, i);
      Ray ray{Vec3(0.0, std::sin(60.0 * kDegree), std::cos(60.0 * kDegree)), Vec3::Zero()};
      if (surface.interact(ray, Side::inside, Vec3::UnitZ(), kIndex, 420.0, rng) == SurfaceOutcome::inside)
        mean.add(ray.direction.x());
    }
    return mean.mean();
  };
  const Estimate a = sideways(own, 8), b = sideways(tabulated, 9);
  CHECK(std::abs(a.value) > 20.0 * a.error);
  // The table's own 40,000 rays count besides, and quantiles are linear within bins of 1 to 2 %.
  CHECK(std::abs(a.value - b.value) < kSigmas * std::hypot(a.error, b.error, 1.6 * a.error) + 0.01);
}

TEST_CASE(
    "Rays are added until the stated error is reached, or the table has the number of nodes that missed it") {
  TableSettings settings = quick();
  settings.rays = 100;
  settings.refine = false;
  settings.target_error = 0.004;
  const SurfaceTable table = build_table(*rough_map(), kIndex, settings);
  CHECK(table.provenance().unconverged == 0);
  bool some_added = false, some_not = false;
  for (const TableNode& node : table.nodes(Side::inside)) {
    CHECK(node.reflectance_error <= 0.004);
    (node.rays > 4000 ? some_added : some_not) = true;
  }
  CHECK(some_added);
  CHECK(some_not);  // at grazing incidence all light is reflected, and the first batch states so
  settings.most_rays = 1;
  CHECK(build_table(*rough_map(), kIndex, settings).provenance().unconverged > 0);
  settings.target_error = -1.0;
  CHECK_THROWS_AS(build_table(*rough_map(), kIndex, settings), InputError);
}

TEST_CASE(
    "A table made reciprocal is so exactly, keeps equilibrium, and has its distance from the traced one") {
  TableSettings settings = quick();
  settings.reciprocal = true;
  const SurfaceTable table = build_table(*rough_map(), kIndex, settings);
  const ReciprocalKernel& kernel = *table.slices().front().reciprocal;
  constexpr int kStates = ReciprocalKernel::kStates, kTurns = ReciprocalKernel::kTurns,
                kPolar = ReciprocalKernel::kPolar;
  const auto flux = [&](int a, int b, int m) {
    const double n = a < kPolar ? kIndex.inside : kIndex.outside;
    return n * n *
           static_cast<double>(kernel.shares()[static_cast<std::size_t>((a * kStates + b) * kTurns + m)]);
  };
  double asymmetry = 0.0, worst_column = 0.0;
  for (int b = 0; b < kStates; ++b) {
    double arriving = 0.0;
    for (int a = 0; a < kStates; ++a)
      for (int m = 0; m < kTurns; ++m) {
        arriving += flux(a, b, m);
        asymmetry = std::max(asymmetry, std::abs(flux(a, b, m) - flux(b, a, m)));
      }
    const double n = b < kPolar ? kIndex.inside : kIndex.outside;
    worst_column = std::max(worst_column, std::abs(arriving / (n * n) - 1.0));
  }
  CHECK(asymmetry < 1e-6);     // single precision
  CHECK(worst_column < 1e-5);  // isotropic light stays isotropic
  CHECK(table.provenance().reciprocity.find("n1^2 (1 - R12)") != std::string::npos);
  // It reflects as the traced table does, within a bin's width and the noise of both.
  for (const double degrees : {10.0, 40.0, 70.0}) {
    const double low = std::pow(std::sin((degrees - 0.7) * kDegree), 2);
    CAPTURE(degrees);
    const double traced =
        build_table(*rough_map(), kIndex, quick()).reflectance(Side::inside, degrees * kDegree);
    CHECK(std::abs(kernel.reflectance(Side::inside, low) - traced) < 0.03);
  }
  // And light leaves as the kernel states.
  const Surface surface = of_table(table);
  const double angle = 40.0 * kDegree;
  const Estimate seen = binomial_estimate(shine(surface, angle, 0.0, 420.0, 10).outcomes[0], kRays);
  CHECK(sigmas(seen, {table.reflectance(Side::inside, angle), 0.0}) < kSigmas);

  Surface lossy;
  lossy.reflector = Reflector{"ESR", Curve::constant(0.9), 1.0};
  CHECK_THROWS_AS(build_stack_table(lossy, {{420.0, kIndex}}, settings), InputError);
  settings.directional = true;
  CHECK_THROWS_AS(build_table(*rough_map(), kIndex, settings), InputError);
}

TEST_CASE("A table of many slices is the same after a file") {
  TableSettings settings = quick();
  settings.directional = true;
  settings.azimuth_step_rad = 120.0 * kDegree;
  settings.incidence_step_rad = 45.0 * kDegree;
  settings.refine = false;
  settings.rays = 500;
  Surface stack;
  stack.microsurface = rough_map();
  stack.reflector = Reflector{"ESR", Curve::constant(0.9), 1.0};
  TableProvenance provenance;
  provenance.stack = "rough | air | ESR";
  const SurfaceTable table =
      build_stack_table(stack, {{400.0, {1.85, 1.0}}, {440.0, kIndex}}, settings, provenance);
  const auto path = test::scratch_folder("table_slices") / "table.h5";
  write_table(path, table);
  const SurfaceTable read = read_table(path);

  CHECK(read.slices().size() == 6);
  CHECK(read.azimuth_kind() == AzimuthKind::directional);
  CHECK(read.wavelengths_nm() == table.wavelengths_nm());
  CHECK(read.provenance().stack == "rough | air | ESR");
  CHECK(read.index_pair(3).inside == 1.82);
  for (std::size_t slice = 0; slice < 6; ++slice)
    for (std::size_t k = 0; k < table.nodes(Side::inside, slice).size(); ++k) {
      const TableNode &a = table.nodes(Side::inside, slice)[k], &b = read.nodes(Side::inside, slice)[k];
      CHECK(a.absorptance == b.absorptance);
      CHECK(a.reflected.azimuth == b.reflected.azimuth);
    }
  std::vector<TableSlice> shuffled = table.slices();
  std::swap(shuffled[1], shuffled[4]);
  CHECK_THROWS_AS(SurfaceTable(shuffled, AzimuthKind::directional, {}), InputError);
}

TEST_CASE("Rays that leave away from their medium are counted, and no table is made of them") {
  TableSettings settings = quick();
  settings.incidence_step_rad = 30.0 * kDegree;
  settings.rays = 500;
  settings.refine = false;
  settings.target_error = 0.0;
  constexpr double kNodes = 2 * 4, kAzimuths = 40;
  const double rays = kNodes * kAzimuths * 500.0;
  CHECK(unclassified_rays(0.0, settings) == 0.0);
  const double expected = 0.01 * rays;
  CHECK(std::abs(unclassified_rays(0.01, settings) - expected) < kSigmas * std::sqrt(expected));
  settings.reciprocal = true;  // whose kernel is traced with rays of its own
  CHECK(unclassified_rays(0.0, settings) == 0.0);
  CHECK(unclassified_rays(0.01, settings) > expected + kSigmas * std::sqrt(expected));
}
