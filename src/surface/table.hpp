#pragma once
/// Surface tables: reflectance and direction distributions against incidence angle.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scintray/surface/microsurface.hpp"
#include "scintray/surface/reciprocal_kernel.hpp"

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

/// Cumulative probability at edge k in [0, kAzimuthBins] of a signed azimuth, for tables of surfaces with
/// direction: fine in both tails, as polar_level.
constexpr double signed_azimuth_level(int k) {
  const double s = static_cast<double>(k) / kAzimuthBins;
  return s < 0.5 ? 2.0 * s * s : 1.0 - 2.0 * (1.0 - s) * (1.0 - s);
}

/// What a table's azimuths are.
enum class AzimuthKind {
  folded,       ///< |azimuth| in [0, pi]: the surface has no direction, both sides of the plane are alike
  directional,  ///< signed azimuth in [-pi, pi], and a slice of the table per azimuth of incidence
};

/// Distribution of directions that leave on one side for one incidence node, as quantiles at fixed
/// levels: `polar` holds the quantiles of the polar angle (rad, from the outgoing normal of the
/// side) at `polar_level`, and within each polar bin `azimuth` those of the azimuth from the plane of
/// incidence (rad, 0 is forward, the specular side, positive about the outward normal) at `azimuth_level`
/// of |azimuth| or `signed_azimuth_level`. Sampling needs no search,
/// is continuous inside bins, and bins are narrow where light is dense. Empty when no ray left that
/// way.
struct DirectionQuantiles {
  std::vector<float> polar;    ///< kPolarBins + 1 edges
  std::vector<float> azimuth;  ///< kPolarBins x (kAzimuthBins + 1) edges, row-major
  std::uint64_t rays = 0;      ///< rays behind this distribution
  bool empty() const { return polar.empty(); }
};

/// One direction that left: polar angle and azimuth, rad.
struct ExitAngles {
  float polar = 0.0f;
  float azimuth = 0.0f;
};

/// Quantiles of a sample of directions (reordered). Quantiles of n values sit at the order
/// statistics (k + 1/2)/n, linear between and for the half step beyond. An empty sample gives an empty
/// result.
DirectionQuantiles quantiles_of(std::vector<ExitAngles>& sample, AzimuthKind kind = AzimuthKind::folded);

/// One incidence angle met from one side.
struct TableNode {
  double incidence_rad = 0.0;
  double reflectance = 0.0;
  double reflectance_error = 0.0;     ///< one-sigma
  double absorptance = 0.0;           ///< zero without a reflector or absorbing layer in the table
  double absorptance_error = 0.0;     ///< one-sigma
  double mean_slope_rad = 0.0;        ///< mean angle of the first facet met to the mean normal
  double traced_incidence_rad = 0.0;  ///< where it was traced: below incidence_rad at 90 deg only
  std::uint64_t rays = 0;
  DirectionQuantiles reflected, transmitted;
  double transmittance() const { return std::max(0.0, 1.0 - reflectance - absorptance); }
};

/// A table at one wavelength and, for a surface with direction, one azimuth of incidence.
struct TableSlice {
  double wavelength_nm = 0.0;  ///< 0: not said, or for any
  double azimuth_rad = 0.0;    ///< of the lateral direction of travel from the map's x axis, about the normal
  IndexPair index;
  std::vector<TableNode> from_inside, from_outside;
  /// When there, light is sent where this says, in place of the nodes' distributions.
  std::shared_ptr<const ReciprocalKernel> reciprocal;

  const std::vector<TableNode>& nodes(Side side) const {
    return side == Side::inside ? from_inside : from_outside;
  }
};

/// How a table came to be.
struct TableProvenance {
  std::string map;          ///< file name or recipe
  std::string stack;        ///< what is tabulated beside the map: gap, reflector, shares; empty: nothing
  std::string preparation;  ///< levelling and filters applied, in order
  std::string tiling;       ///< "mirror" or "periodic"
  std::uint64_t seed = 0;
  std::uint64_t rays_per_azimuth = 0;
  std::uint64_t azimuths = 0;
  std::uint64_t unclassified = 0;  ///< rays without a medium: zero by construction
  std::uint64_t cut = 0;           ///< rays released at the step limit
  double target_error = 0.0;       ///< of the reflectance, that rays were added for; 0: none
  std::uint64_t unconverged = 0;   ///< nodes that missed it at the most rays allowed
  std::string reciprocity;         ///< of a table made reciprocal: how far the traced one was; else empty
  std::string version;             ///< ScintRay version that built it
};

/// A microsurface, or a whole stack, tabulated. Valid for its pairs of indices only.
///
/// Between wavelengths, and between azimuths of incidence, one of the two neighbouring slices is drawn for
/// each photon in proportion to nearness, which interpolates every distribution linearly. Beyond the first
/// and the last wavelength the nearest slice holds.
class SurfaceTable {
 public:
  SurfaceTable() = default;
  /// One slice for all wavelengths and azimuths.
  /// Nodes strictly increasing in incidence from 0 to pi/2 on each side, reflectances and absorptances in
  /// [0, 1] with a sum of at most 1, quantiles of the right number, increasing and within [0, pi/2] and the
  /// range of the azimuth, and present wherever the shares say that light leaves; InputError with every
  /// fault otherwise.
  SurfaceTable(IndexPair index, std::vector<TableNode> from_inside, std::vector<TableNode> from_outside,
               TableProvenance provenance);
  /// The whole grid: slices in order of wavelength, within each of azimuth; every wavelength with the same
  /// azimuths, which are evenly spaced over the circle from 0. InputError otherwise, as above.
  SurfaceTable(std::vector<TableSlice> slices, AzimuthKind kind, TableProvenance provenance);

  /// The ray arrives on `side` and leaves with its new direction on the side of the outcome. The
  /// polarisation, which a table does not hold, is drawn afresh unless the ray is unpolarised.
  /// @param along  for a directional table: direction of the map's x axis (projected onto the face; zero:
  ///               at random)
  SurfaceOutcome meet(Ray& ray, Side side, const Vec3& normal, const Vec3& along, double wavelength_nm,
                      Rng& rng) const;

  /// As every microsurface, for tables without absorption: the first wavelength, the map at any azimuth.
  /// `index` is not used: `index_pair()` says what the table is for.
  Side scatter(Ray& ray, Side side, const Vec3& normal, const IndexPair& index, Rng& rng) const;

  /// Reflectance met from `side` at an incidence angle (rad): linear between nodes; of a table made
  /// reciprocal, that of the angle's bin.
  double reflectance(Side side, double incidence_rad, std::size_t slice = 0) const;
  /// Mean angle of the first facet met (rad), linear between nodes.
  double mean_slope(Side side, double incidence_rad, std::size_t slice = 0) const;

  const std::vector<TableSlice>& slices() const { return slices_; }
  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  std::size_t azimuths() const { return azimuths_; }
  AzimuthKind azimuth_kind() const { return kind_; }
  const IndexPair& index_pair(std::size_t slice = 0) const { return slices_[slice].index; }
  const std::vector<TableNode>& nodes(Side side, std::size_t slice = 0) const {
    return slices_[slice].nodes(side);
  }
  const TableProvenance& provenance() const { return provenance_; }
  bool absorbs() const { return absorbs_; }  ///< some node does
  bool opaque() const { return opaque_; }    ///< nothing that comes from inside is transmitted

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
  /// Lookups of one slice and side.
  struct Index {
    std::vector<Slant> slants;
    std::vector<std::uint32_t> lookup;  ///< first candidate node for equal steps of the slant
  };
  /// Wavelengths and azimuths of the slices; InputError when they are no grid.
  void check_grid();
  static Index make_index(const std::vector<TableNode>& nodes);
  Place place(const Index& index, double sine, double cosine) const;
  std::size_t pick_slice(double lateral_azimuth, double wavelength_nm, Rng& rng) const;
  /// Polar angle and azimuth from the plane of incidence, either side of it.
  ExitAngles sample(const std::vector<TableNode>& nodes, const Place& place, bool reflected, Rng& rng) const;

  std::vector<TableSlice> slices_;
  std::vector<Index> index_;  ///< two per slice: from inside, from outside
  std::vector<double> wavelengths_nm_;
  std::size_t azimuths_ = 1;
  AzimuthKind kind_ = AzimuthKind::folded;
  bool absorbs_ = false, opaque_ = false;
  TableProvenance provenance_;
};

/// Version of the table file layout; files of another version are refused.
inline constexpr std::int64_t kTableFileVersion = 2;

/// Writes / reads a table as HDF5. Reading checks version, shapes and ranges (InputError).
void write_table(const std::filesystem::path& path, const SurfaceTable& table);
SurfaceTable read_table(const std::filesystem::path& path);

}  // namespace scintray
