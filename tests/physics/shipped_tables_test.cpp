/// Laws for every table that comes with ScintRay (materials/tables, made by tools/tables).

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/traced.hpp"
#include "scintray/core/sampling.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

constexpr int kBins = 20;
constexpr std::uint64_t kRays = 300'000;

struct Shipped {
  std::string name;
  Surface surface;
  IndexPair index;
  bool lossless = false;
};

std::vector<Shipped> shipped_tables() {
  std::vector<Shipped> result;
  for (const auto& entry : std::filesystem::directory_iterator(source_file("materials/tables"))) {
    if (entry.path().extension() != ".h5") continue;
    auto table = std::make_shared<const SurfaceTable>(read_table(entry.path()));
    Shipped shipped{entry.path().stem().string(), {}, table->index_pair(), !table->absorbs()};
    CHECK(table->provenance().unclassified == 0);
    CHECK(table->provenance().cut == 0);
    CHECK_FALSE(table->provenance().map.empty());
    CHECK_FALSE(table->provenance().stack.empty());
    shipped.surface.microsurface = std::move(table);
    result.push_back(std::move(shipped));
  }
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return result;
}

/// Where diffuse light from one side goes, in even steps of sin^2.
struct Counts {
  std::uint64_t inside = 0, outside = 0, absorbed = 0;
  std::vector<std::uint64_t> into = std::vector<std::uint64_t>(kBins, 0);  ///< leaving inside
  std::uint64_t steep_to_slant = 0, slant_to_steep = 0;                    ///< inside, across sin^2 = 1/2
};

Counts illuminate(const Shipped& shipped, Side side, std::uint64_t rays, std::uint64_t seed) {
  Counts counts;
  for (std::uint64_t i = 0; i < rays; ++i) {
    Rng rng(seed, StreamKind::other, i);
    Ray ray{sample_lambertian(side == Side::inside ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitZ()), rng),
            Vec3::Zero()};
    const double from = 1.0 - std::pow(ray.direction.z(), 2);
    const SurfaceOutcome outcome =
        shipped.surface.interact(ray, side, Vec3::UnitZ(), shipped.index, 420.0, rng);
    if (outcome == SurfaceOutcome::absorbed) ++counts.absorbed;
    if (outcome == SurfaceOutcome::outside) ++counts.outside;
    if (outcome != SurfaceOutcome::inside) continue;
    ++counts.inside;
    const double to = 1.0 - std::pow(ray.direction.z(), 2);
    ++counts.into[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(to * kBins)))];
    if (from < 0.5 && to >= 0.5) ++counts.steep_to_slant;
    if (from >= 0.5 && to < 0.5) ++counts.slant_to_steep;
  }
  return counts;
}

}  // namespace

TEST_CASE("Shipped tables: energy, reciprocity and, without absorption, equilibrium") {
  const std::vector<Shipped> tables = shipped_tables();
  CHECK(tables.size() == 8);
  for (const Shipped& shipped : tables) {
    CAPTURE(shipped.name);
    const Counts in = illuminate(shipped, Side::inside, kRays, 51);
    CHECK(in.inside + in.outside + in.absorbed == kRays);
    CHECK((in.absorbed == 0) == shipped.lossless);
    CHECK((in.outside > 0) == shipped.lossless);
    const Estimate up = binomial_estimate(in.steep_to_slant, kRays),
                   down = binomial_estimate(in.slant_to_steep, kRays);
    CHECK(sigmas(up, down) < kSigmas);
    std::string balance = "-", equilibrium = "-";
    if (shipped.lossless) {
      const double n1 = std::pow(shipped.index.inside, 2), n2 = std::pow(shipped.index.outside, 2);
      const auto outside_rays = static_cast<std::uint64_t>(std::llround(kRays * n2 / n1));
      const Counts out = illuminate(shipped, Side::outside, outside_rays, 52);
      const Estimate t12 = binomial_estimate(in.outside, kRays),
                     t21 = binomial_estimate(out.inside, outside_rays);
      const Estimate there{n1 * t12.value, n1 * t12.error}, back{n2 * t21.value, n2 * t21.error};
      CHECK(sigmas(there, back) < kSigmas);
      balance =
          fmt::format("{:.4f} ± {:.4f}, {:.4f} ± {:.4f}", there.value, there.error, back.value, back.error);
      std::vector<std::uint64_t> leaving(kBins);
      for (std::size_t k = 0; k < kBins; ++k) leaving[k] = in.into[k] + out.into[k];
      const ChiSquare chi = chi_square_test(leaving, std::vector<double>(kBins, kRays / double{kBins}));
      CHECK(chi.p_value > 6.3e-5);
      equilibrium = fmt::format("{:.3g}", chi.p_value);
    }
    evidence("shipped_tables", {shipped.name, fmt::format("{:.4f}", static_cast<double>(in.inside) / kRays),
                                fmt::format("{:.4f}", static_cast<double>(in.absorbed) / kRays),
                                fmt::format("{:.2f}", sigmas(up, down)), balance, equilibrium});
  }
}

namespace {

constexpr std::size_t kPairBins = 6;
constexpr std::uint64_t kPairRays = 1'000'000;

/// Numbers of diffuse light from inside that go from one sixth of the hemisphere (by sin^2) to another.
using PairCounts = std::array<std::array<std::uint64_t, kPairBins>, kPairBins>;

PairCounts pairs_of(const Shipped& shipped, std::uint64_t seed) {
  const auto bin = [](const core::PlainVec3& direction) {
    const double sin2 = 1.0 - direction.z() * direction.z();
    return std::min(kPairBins - 1, static_cast<std::size_t>(std::max(0.0, sin2) * kPairBins));
  };
  PairCounts counts{};
  for (std::uint64_t i = 0; i < kPairRays; ++i) {
    Rng rng(seed, StreamKind::other, i);
    Ray ray{sample_lambertian(Vec3::UnitZ(), rng), Vec3::Zero()};
    const std::size_t from = bin(ray.direction);
    if (shipped.surface.interact(ray, Side::inside, Vec3::UnitZ(), shipped.index, 420.0, rng) ==
        SurfaceOutcome::inside)
      ++counts[from][bin(ray.direction)];
  }
  return counts;
}

/// Rays that a table was traced with at incidences whose squared sine is in a bin.
std::array<double, kPairBins> own_rays(const SurfaceTable& table) {
  std::array<double, kPairBins> rays{};
  const auto per_node =
      static_cast<double>(table.provenance().rays_per_azimuth * table.provenance().azimuths);
  for (const TableNode& node : table.nodes(Side::inside)) {
    const double sin2 = std::pow(std::sin(node.incidence_rad), 2);
    rays[std::min(kPairBins - 1, static_cast<std::size_t>(sin2 * kPairBins))] += per_node;
  }
  return rays;
}

}  // namespace

TEST_CASE("Shipped tables: detailed balance of pairs of directions, of light of equal radiance") {
  for (const Shipped& shipped : shipped_tables()) {
    CAPTURE(shipped.name);
    const auto& table = *shipped.surface.microsurface.get_if<SurfaceTable>();
    const PairCounts counts = pairs_of(shipped, 53);
    const std::array<double, kPairBins> own = own_rays(table);
    double squares = 0.0, greatest = 0.0, per_cent = 0.0;
    int pairs = 0;
    for (std::size_t i = 0; i < kPairBins; ++i)
      for (std::size_t j = i + 1; j < kPairBins; ++j) {
        const auto there = static_cast<double>(counts[i][j]), back = static_cast<double>(counts[j][i]);
        if (there + back < 200.0) continue;  // a polished face: next to no light goes there
        // Of the rays here, and of those that the table was traced with, whose share in this pair is that of
        // all light of the bin: each bin holds a sixth of the light.
        const double scale = static_cast<double>(kPairRays) / kPairBins;
        const double variance = there * (1.0 + scale / own[i]) + back * (1.0 + scale / own[j]);
        const double pull = std::abs(there - back) / std::sqrt(variance);
        squares += pull * pull;
        ++pairs;
        if (pull < greatest) continue;
        greatest = pull;
        per_cent = 200.0 * std::abs(there - back) / (there + back);
      }
    REQUIRE(pairs > 0);
    CHECK(greatest < kSigmas);
    evidence("shipped_pairs", {shipped.name, fmt::format("{:.0f}", *std::min_element(own.begin(), own.end())),
                               fmt::format("{:.2f}", std::sqrt(squares / pairs)),
                               fmt::format("{:.2f}", greatest), fmt::format("{:.1f}", per_cent)});
    MESSAGE(shipped.name << ": " << pairs << " pairs, rms " << std::sqrt(squares / pairs)
                         << " sigma, greatest " << greatest << " sigma, " << per_cent << " per cent");
  }
}
