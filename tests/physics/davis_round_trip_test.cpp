/// A crystal with a surface table, with the pair of files that Geant4 would read in its place, and with the
/// table made coarse in the way in which Geant4's reader makes it.

#include <fmt/format.h>

#include "physics/crystal_scene.hpp"
#include "physics/traced.hpp"
#include "scintray/tables/davis.hpp"
#include "scintray/topography/build_table.hpp"
#include "scintray/topography/synthesis.hpp"
#include "support/evidence.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;
using namespace scintray::tables;
using namespace scintray::test;

namespace {

constexpr IndexPair kLsoToAir{1.82, 1.0};
constexpr std::uint64_t kPhotons = 500'000;

std::string crystal(double z_mm, const std::filesystem::path& table) {
  return crystal_scene({"lso_isotropic", "tabulated", slab(z_mm), kPhotons, "", kUnpolarisedSource}) +
         fmt::format(R"(
[surfaces.tabulated]
model = "table"
[surfaces.tabulated.table]
file = "{}"
)",
                     table.string());
}

Estimate detected(double z_mm, const std::filesystem::path& table) {
  return trace(crystal(z_mm, table)).result.fraction(Fate::detected);
}

DirectionQuantiles one_direction(double polar_rad, double azimuth_rad) {
  std::vector<ExitAngles> sample{{static_cast<float>(polar_rad), static_cast<float>(azimuth_rad)}};
  return quantiles_of(sample);
}

/// The mean of a table over one degree of incidence, in diffuse light, by drawing from the table itself.
TableNode mean_of_degree(const SurfaceTable& table, int degree) {
  constexpr std::uint64_t kRays = 40'000;
  const double low = std::cos(degree * kDegree), high = std::cos((degree + 1) * kDegree);
  TableNode node;
  std::vector<ExitAngles> reflected, transmitted;
  for (std::uint64_t k = 0; k < kRays; ++k) {
    Rng rng(71, StreamKind::other, static_cast<std::uint64_t>(degree), k);
    const double cosine = std::sqrt(low * low + rng.uniform() * (high * high - low * low));
    node.reflectance += table.reflectance(Side::inside, std::acos(cosine)) / kRays;
    Ray ray{{std::sqrt(1.0 - cosine * cosine), 0.0, cosine}, Vec3::Zero()};
    const bool back = table.scatter(ray, Side::inside, Vec3::UnitZ(), kLsoToAir, rng) == Side::inside;
    (back ? reflected : transmitted)
        .push_back({static_cast<float>(std::acos(std::min(1.0, std::abs(ray.direction.z())))),
                    static_cast<float>(std::abs(std::atan2(ray.direction.y(), ray.direction.x())))});
  }
  node.reflectance = transmitted.empty() ? 1.0 : std::min(1.0, node.reflectance);
  node.reflected = quantiles_of(reflected);
  node.transmitted = quantiles_of(transmitted);
  return node;
}

/// What Geant4's reader leaves of a table, made without any file: one degree is one incidence, and below
/// one degree light goes back or straight on.
SurfaceTable floored(const SurfaceTable& table) {
  std::vector<TableNode> nodes;
  for (int degree = 0; degree < 90; ++degree) {
    const TableNode mean = mean_of_degree(table, degree);
    for (const double end : {degree + 0.0, degree < 89 ? degree + 1.0 - 1e-4 : 90.0}) {
      nodes.push_back(mean);
      nodes.back().incidence_rad = end * kDegree;
      if (degree == 0) {
        nodes.back().reflected = one_direction(end * kDegree, kPi);
        nodes.back().transmitted = one_direction(end * kDegree, 0.0);
      }
    }
  }
  return SurfaceTable(kLsoToAir, nodes, table.nodes(Side::outside), {});
}

void compare(const std::string& name, const SynthesisRecipe& recipe) {
  const auto folder = scratch_folder("davis_round_trip_" + name);
  const SurfaceTable original = build_table(make_height_field(synthesize(recipe)), kLsoToAir, {});
  write_davis(folder / "Rough_LUT.z", original);
  ImportSettings settings;
  settings.index = kLsoToAir;
  write_table(folder / "original.h5", original);
  write_table(folder / "pair.h5", read_davis(folder / "Rough_LUT.z", settings));
  write_table(folder / "floored.h5", floored(original));
  for (const double z_mm : {2.0, 10.0}) {
    const Estimate whole = detected(z_mm, folder / "original.h5");
    const Estimate pair = detected(z_mm, folder / "pair.h5");
    const Estimate coarse = detected(z_mm, folder / "floored.h5");
    const auto text = [](const Estimate& e) { return fmt::format("{:.5f} ± {:.5f}", e.value, e.error); };
    evidence("davis_round_trip",
             {name, fmt::format("{:g} mm", z_mm), text(whole), text(pair), text(coarse),
              fmt::format("{:.2f}", sigmas(pair, coarse)), fmt::format("{:.2f}", sigmas(pair, whole))});
    CAPTURE(name);
    CAPTURE(z_mm);
    CAPTURE(whole.value);
    CAPTURE(pair.value);
    CAPTURE(coarse.value);
    CHECK(sigmas(pair, coarse) < kSigmas);
    const double grid = std::abs(coarse.value - whole.value);
    CHECK(std::abs(pair.value - whole.value) < grid + kSigmas * std::hypot(pair.error, whole.error));
  }
}

}  // namespace

TEST_CASE("Davis pair of a ground face: a crystal keeps its light within what one degree explains") {
  compare("ground", ground_recipe());
}

TEST_CASE("Davis pair of a polished face: a crystal keeps its light within what one degree explains") {
  compare("polished", polished_recipe());
}
