#include "scintray/tables/table_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scintray/core/output_file.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/core/version.hpp"
#include "scintray/tables/table_side.hpp"

namespace scintray::tables {

namespace {

constexpr int kPolarCells = 18, kAzimuthCells = 12;
constexpr double kPolarCell = 0.5 * core::kPi / kPolarCells, kAzimuthCell = core::kPi / kAzimuthCells;
/// Number of quasi-random points; their discrepancy is far below the errors of a table's rays.
constexpr std::uint64_t kPoints = 50000;

using Shares = std::array<double, kPolarCells * kAzimuthCells>;

Shares shares_of(const TableSide& side, Leaving way, double incidence_rad) {
  Shares shares{};
  const CubePoint shift{0.5, 0.5, 0.5};
  for (std::uint64_t k = 0; k < kPoints; ++k) {
    const CubePoint at = cube_point(k, shift);
    const optics::ExitAngles exit = side.direction(way, incidence_rad, at.u, at.v);
    const int polar = std::clamp(static_cast<int>(exit.polar / kPolarCell), 0, kPolarCells - 1);
    const int azimuth = std::clamp(static_cast<int>(exit.azimuth / kAzimuthCell), 0, kAzimuthCells - 1);
    shares[static_cast<std::size_t>(polar * kAzimuthCells + azimuth)] += 1.0 / kPoints;
  }
  return shares;
}

std::string rows_of(const TableSide& side, const optics::TableNode& node, Leaving way,
                    const std::string& begin) {
  const double light = side.share(way, node.incidence_rad);
  if (light <= 0.0 || !side.has_directions(way, node.incidence_rad)) return {};
  const Shares shares = shares_of(side, way, node.incidence_rad);
  const std::uint64_t rays = way == Leaving::reflected ? node.reflected.rays : node.transmitted.rays;
  std::string text;
  for (int polar = 0; polar < kPolarCells; ++polar) {
    const double solid_angle =
        2.0 * kAzimuthCell * (std::cos(polar * kPolarCell) - std::cos((polar + 1) * kPolarCell));
    for (int azimuth = 0; azimuth < kAzimuthCells; ++azimuth) {
      const double share = shares[static_cast<std::size_t>(polar * kAzimuthCells + azimuth)];
      const double of_share =
          rays > 0 ? light * std::sqrt(share * (1.0 - share) / static_cast<double>(rays)) : 0.0;
      const double error = std::hypot(of_share, share * node.reflectance_error);
      text += fmt::format(
          "{},{:.4f},{},{:.1f},{:.1f},{:.6g},{:.3g}\n", begin, node.incidence_rad / core::kDegree,
          way == Leaving::reflected ? "reflected" : "transmitted", (polar + 0.5) * kPolarCell / core::kDegree,
          (azimuth + 0.5) * kAzimuthCell / core::kDegree, light * share / solid_angle, error / solid_angle);
    }
  }
  return text;
}

}  // namespace

void write_table_csv(const std::filesystem::path& path, const optics::SurfaceTable& table) {
  core::OutputFile file(path, core::Container::plain);
  const optics::IndexPair& index = table.index_pair();
  file.write(fmt::format("# ScintRay {}: surface table for index {:g} inside, {:g} outside{}\n",
                         core::version(), index.inside, index.outside,
                         table.wavelengths_nm().size() > 1 ? " at the first wavelength" : ""));
  file.write("# azimuth: 0 forward, both sides of the plane of incidence together\n");
  file.write("wavelength_nm,side,incidence_deg,kind,polar_deg,azimuth_deg,density_per_sr,error_per_sr\n");
  for (const double wavelength : table.wavelengths_nm())
    for (const optics::Side which : {optics::Side::inside, optics::Side::outside}) {
      const TableSide side(table, which, slice_at(table, wavelength));
      const std::string begin =
          fmt::format("{:g},{}", wavelength, which == optics::Side::inside ? "inside" : "outside");
      for (const optics::TableNode& node : side.nodes())
        for (const Leaving way : {Leaving::reflected, Leaving::transmitted})
          file.write(rows_of(side, node, way, begin));
    }
  file.commit();
}

}  // namespace scintray::tables
