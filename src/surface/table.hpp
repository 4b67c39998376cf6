#pragma once
/// Surface tables: reflectance and direction distributions against incidence angle.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scintray/surface/microsurface.hpp"

namespace scintray {

/// Distribution of directions that leave on one side for one incidence node, as equal-probability
/// quantiles: `polar` splits the polar angle (rad, from the outgoing normal of the side) into equal
/// shares, and within each share `azimuth` splits |azimuth| from the plane of incidence (rad, 0 is
/// forward, the specular side). Sampling needs no search, is continuous inside bins, and bins are
/// narrow where light is dense. Empty when no ray left that way.
struct DirectionQuantiles {
  std::vector<float> polar;    ///< kPolarBins + 1 edges
  std::vector<float> azimuth;  ///< kPolarBins x (kAzimuthBins + 1) edges, row-major
  std::uint64_t rays = 0;      ///< rays behind this distribution
  bool empty() const { return polar.empty(); }
};

inline constexpr int kPolarBins = 64;
inline constexpr int kAzimuthBins = 32;

/// One incidence angle met from one side.
struct TableNode {
  double incidence_rad = 0.0;
  double reflectance = 0.0;
  double reflectance_error = 0.0;  ///< one-sigma
  double mean_slope_rad = 0.0;     ///< mean angle of the first facet met to the mean normal
  std::uint64_t rays = 0;
  DirectionQuantiles reflected, transmitted;
};

/// How a table came to be.
struct TableProvenance {
  std::string map;          ///< file name or recipe
  std::string preparation;  ///< levelling and filters applied, in order
  std::string tiling;       ///< "mirror" or "periodic"
  std::uint64_t seed = 0;
  std::uint64_t rays_per_azimuth = 0;
  std::uint64_t azimuths = 0;
  std::uint64_t unclassified = 0;  ///< rays without a medium: zero by construction
  std::uint64_t cut = 0;           ///< rays released at the step limit
  std::string version;             ///< ScintRay version that built it
};

/// A microsurface tabulated for one pair of indices. Valid for that pair only.
class SurfaceTable {
 public:
  SurfaceTable() = default;
  /// Nodes strictly increasing in incidence from 0 to pi/2 on each side; InputError otherwise.
  SurfaceTable(IndexPair index, std::vector<TableNode> from_inside, std::vector<TableNode> from_outside,
               TableProvenance provenance);

  /// As every microsurface. The polarisation, which a table does not hold, is drawn afresh unless
  /// the ray is unpolarised. `index` is not used: `index_pair()` says what the table is for.
  Side scatter(Ray& ray, Side side, const Vec3& normal, const IndexPair& index, Rng& rng) const;

  /// Reflectance met from `side` at an incidence angle (rad), linear between nodes.
  double reflectance(Side side, double incidence_rad) const;

  const IndexPair& index_pair() const { return index_; }
  const std::vector<TableNode>& nodes(Side side) const { return nodes_[static_cast<int>(side)]; }
  const TableProvenance& provenance() const { return provenance_; }

 private:
  IndexPair index_;
  std::vector<TableNode> nodes_[2];
  TableProvenance provenance_;
};

/// Version of the table file layout; files of another version are refused.
inline constexpr std::int64_t kTableFileVersion = 1;

/// Writes / reads a table as HDF5. Reading checks version, shapes and ranges (InputError).
void write_table(const std::filesystem::path& path, const SurfaceTable& table);
SurfaceTable read_table(const std::filesystem::path& path);

}  // namespace scintray
