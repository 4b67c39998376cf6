/// Speed of tracing a periodic height map, and of building tables from it.
///
/// Embree is given one period of the map as triangles, and requested the first hit only; a ray of ours is
/// followed until it leaves the map, over as many facets and periods as it takes.

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>
#include <iostream>

#include "bench.hpp"
#include "raw_embree.hpp"
#include "scintray/topography/build_table.hpp"
#include "scintray/topography/synthesis.hpp"

namespace scintray::bench {

namespace {

constexpr int kRounds = 5;
constexpr std::size_t kRays = 200'000;
constexpr optics::IndexPair kIndex{1.82, 1.0};

std::vector<scene::BoundaryTriangle> triangles_of(const topography::HeightMap& map) {
  const auto vertex = [&](std::uint32_t i, std::uint32_t j) {
    return core::Vec3(i * map.pitch_x_um, j * map.pitch_y_um, map.at(i % map.columns, j % map.rows));
  };
  std::vector<scene::BoundaryTriangle> triangles;
  for (std::uint32_t j = 0; j < map.rows; ++j)
    for (std::uint32_t i = 0; i < map.columns; ++i) {
      triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
      triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return triangles;
}

std::vector<RawRay> raw_rays(const optics::HeightField& field, double incidence) {
  std::vector<RawRay> rays;
  for (std::size_t k = 0; k < kRays; ++k) {
    core::Rng rng(3, core::StreamKind::other, k);
    const double azimuth = core::kTwoPi * rng.uniform();
    const double x = field.period_x_um() * rng.uniform(), y = field.period_y_um() * rng.uniform();
    rays.push_back({{static_cast<float>(x), static_cast<float>(y), static_cast<float>(field.low_um())},
                    {static_cast<float>(std::sin(incidence) * std::cos(azimuth)),
                     static_cast<float>(std::sin(incidence) * std::sin(azimuth)),
                     static_cast<float>(std::cos(incidence))}});
  }
  return rays;
}

struct Followed {
  double rays_per_second = 0.0, facets_per_second = 0.0;
};

Followed follow(const optics::HeightField& field, double incidence) {
  const auto start = std::chrono::steady_clock::now();
  std::uint64_t facets = 0;
  for (std::size_t k = 0; k < kRays; ++k) {
    core::Rng rng(3, core::StreamKind::other, k);
    const double azimuth = core::kTwoPi * rng.uniform();
    const double x = field.period_x_um() * rng.uniform(), y = field.period_y_um() * rng.uniform();
    optics::Ray ray{{std::sin(incidence) * std::cos(azimuth), std::sin(incidence) * std::sin(azimuth),
                     std::cos(incidence)},
                    core::Vec3::Zero()};
    facets += static_cast<std::uint64_t>(
        field.follow(ray, optics::Side::inside, x, y, kIndex, rng).facet_interactions);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {kRays / seconds, static_cast<double>(facets) / seconds};
}

/// The paper's grid, both ways: wall time in s.
double build_seconds(const optics::HeightField& field, int threads) {
  topography::TableSettings settings;
  settings.refine = false;
  tbb::task_arena arena(threads);
  const auto start = std::chrono::steady_clock::now();
  arena.execute([&] { topography::build_table(field, kIndex, settings); });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void bench_tables() {
  const topography::HeightMap map = topography::synthesize(topography::ground_recipe());
  const optics::HeightField field = topography::make_height_field(map);
  RawEmbree raw(triangles_of(map));
  std::cout << fmt::format("ground map, {} x {} points; medians of {} rounds\n\n", map.columns, map.rows,
                           kRounds);
  std::cout << fmt::format("{:<16} {:>26} {:>18} {:>18} {:>16}\n", "incidence", "Embree first hit, Mray/s",
                           "followed, Mray/s", "facets met, M/s", "followed/Embree");
  for (const double degrees : {0.0, 45.0, 80.0}) {
    const std::vector<RawRay> rays = raw_rays(field, degrees * core::kDegree);
    std::vector<double> embree, ours, facets, ratio;
    for (int round = 0; round < kRounds; ++round) {
      embree.push_back(raw.rays_per_second(rays) / 1e6);
      const Followed f = follow(field, degrees * core::kDegree);
      ours.push_back(f.rays_per_second / 1e6);
      facets.push_back(f.facets_per_second / 1e6);
      ratio.push_back(ours.back() / embree.back());
    }
    std::cout << fmt::format("{:<16} {:>26.2f} {:>18.2f} {:>18.2f} {:>16.2f}\n",
                             fmt::format("{:g} deg", degrees), median(embree), median(ours), median(facets),
                             median(ratio));
  }
  const double one = build_seconds(field, 1), two = build_seconds(field, 2);
  constexpr double kTableRays = 2 * 41 * 40 * 2000.0;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::cout << fmt::format(
      "\ntable, 41 x 40 x 2000 rays from both sides: {:.1f} s on 1 thread ({:.2f} Mray/s), {:.1f} s on 2 "
      "({:.2f} Mray/s, x {:.2f}); peak memory of this program {} MB\n",
      one, kTableRays / one / 1e6, two, kTableRays / two / 1e6, one / two, usage.ru_maxrss / 1024);
}

}  // namespace scintray::bench
