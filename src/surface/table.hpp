#pragma once
/// Surface tables: reflectance and direction distributions against incidence angle.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scintray/surface/microsurface.hpp"

namespace scintray {

inline constexpr int kPolarBins = 64;
inline constexpr int kAzimuthBins = 32;

/// Cumulative probability at polar edge k in [0, kPolarBins]. Bins hold equal steps of s with
/// P = 2 s^2 below the median and, mirrored, 1 - 2 (1 - s)^2 above. Steps are fine in both tails,
/// and a density that vanishes linearly at an end (sin(theta) at the pole, the cosine law at the
/// horizon) becomes uniform in s there, so that linear interpolation inside bins is right.
constexpr double polar_level(int k) {
  const double s = static_cast<double>(k) / kPolarBins;
  return s < 0.5 ? 2.0 * s * s : 1.0 - 2.0 * (1.0 - s) * (1.0 - s);
}

/// Cumulative probability at |azimuth| edge k in [0, kAzimuthBins]: P = 1 - (1 - s)^2. The density
/// of |azimuth| is level at 0 and bins are fine in the tail.
constexpr double azimuth_level(int k) {
  const double s = static_cast<double>(k) / kAzimuthBins;
  return s * (2.0 - s);
}

/// Distribution of directions that leave on one side for one incidence node, as quantiles at fixed
/// levels: `polar` holds the quantiles of the polar angle (rad, from the outgoing normal of the
/// side) at `polar_level`, and within each polar bin `azimuth` those of |azimuth| from the plane of
/// incidence (rad, 0 is forward, the specular side) at `azimuth_level`. Sampling needs no search,
/// is continuous inside bins, and bins are narrow where light is dense. Empty when no ray left that
/// way.
struct DirectionQuantiles {
  std::vector<float> polar;    ///< kPolarBins + 1 edges
  std::vector<float> azimuth;  ///< kPolarBins x (kAzimuthBins + 1) edges, row-major
  std::uint64_t rays = 0;      ///< rays behind this distribution
  bool empty() const { return polar.empty(); }
};

/// One direction that left: polar angle and |azimuth|, rad.
struct ExitAngles {
  float polar = 0.0f;
  float azimuth = 0.0f;
};

/// Quantiles of a sample of directions (reordered). Quantiles of n values sit at the order
/// statistics (k + 1/2)/n, linear between, level beyond. An empty sample gives an empty result.
DirectionQuantiles quantiles_of(std::vector<ExitAngles>& sample);

/// One incidence angle met from one side.
struct TableNode {
  double incidence_rad = 0.0;
  double reflectance = 0.0;
  double reflectance_error = 0.0;     ///< one-sigma
  double mean_slope_rad = 0.0;        ///< mean angle of the first facet met to the mean normal
  double traced_incidence_rad = 0.0;  ///< where it was traced: below incidence_rad at 90 deg only
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
  /// Nodes strictly increasing in incidence from 0 to pi/2 on each side, reflectances in [0, 1],
  /// quantiles of the right number, increasing and within [0, pi/2] and [0, pi], and present
  /// wherever the reflectance says that light leaves; InputError with every fault otherwise.
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
  /// Where an incidence angle falls between two nodes.
  struct Place {
    std::uint32_t node = 0;  ///< the lower one
    double share = 0.0;      ///< of the way to the next, in [0, 1]
  };
  /// A node's incidence as sin / (sin + cos), which needs no arc function, and how the share of the way
  /// to the next node in angle departs from that in this measure: by bend x (1 - x). Nodes 2.25 deg
  /// apart: right to 5e-5 of the way.
  struct Slant {
    double value = 0.0, bend = 0.0;
  };
  Place place(int side, double sine, double cosine) const;
  double reflectance(int side, const Place& at) const;
  /// Polar angle and azimuth from the plane of incidence, either side of it.
  ExitAngles sample(int side, const Place& place, bool reflected, Rng& rng) const;

  IndexPair index_;
  std::vector<TableNode> nodes_[2];
  std::vector<Slant> slants_[2];
  std::vector<std::uint32_t> lookup_[2];  ///< first candidate node for equal steps of the slant
  TableProvenance provenance_;
};

/// Version of the table file layout; files of another version are refused.
inline constexpr std::int64_t kTableFileVersion = 1;

/// Writes / reads a table as HDF5. Reading checks version, shapes and ranges (InputError).
void write_table(const std::filesystem::path& path, const SurfaceTable& table);
SurfaceTable read_table(const std::filesystem::path& path);

}  // namespace scintray
