#pragma once
/// Surface tables: reflectance and direction distributions against incidence angle.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scintray/optics/microsurface.hpp"
#include "scintray/optics/reciprocal_kernel.hpp"
#include "scintray/optics/table_nodes.hpp"
#include "scintray/optics/table_sampler.hpp"

namespace scintray::optics {

/// A table at one wavelength and, for a surface with direction, one azimuth of incidence.
struct TableSlice {
  double wavelength_nm = 0.0;  ///< 0: not stated, or for any
  double azimuth_rad = 0.0;    ///< of the lateral direction of travel from the map's x axis, about the normal
  IndexPair index;
  std::vector<TableNode> from_inside, from_outside;
  /// When there, light is sent where this states, in place of the nodes' distributions.
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
  std::uint64_t unclassified =
      0;                  ///< rays directed away from the medium that they left into: 0, or no table is made
  std::uint64_t cut = 0;  ///< rays released at the step limit
  double target_error = 0.0;      ///< of the reflectance, that rays were added for; 0: none
  std::uint64_t unconverged = 0;  ///< nodes that missed it at the most rays allowed
  std::string reciprocity;        ///< of a table made reciprocal: how far the traced one was; else empty
  std::string version;            ///< ScintRay version that built it
};

/// A microsurface, or a whole stack, tabulated. Valid for its pairs of indices only.
///
/// Between wavelengths, and between azimuths of incidence, one of the two neighbouring slices is drawn for
/// each photon in proportion to nearness, which interpolates every distribution linearly. Beyond the first
/// and the last wavelength the nearest slice holds.
class SurfaceTable : public MicrosurfaceModel {
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
  SurfaceOutcome interact(Ray& ray, Side side, const core::Vec3& normal, const core::Vec3& along,
                          double wavelength_nm, core::Rng& rng) const;

  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
  /// The side on which the ray leaves a table without absorption: the first wavelength, any azimuth.
  /// `index` is not used: `index_pair()` states what the table is for.
  Side scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index, core::Rng& rng) const;

  /// Reflectance met from `side` at an incidence angle (rad): linear between nodes; of a table made
  /// reciprocal, that of the angle's bin.
  double reflectance(Side side, double incidence_rad, std::size_t slice = 0) const;
  /// Mean angle of the first facet hit (rad), linear between nodes.
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
  bool absorbs() const { return absorbs_; }         ///< some node does
  bool opaque() const override { return opaque_; }  ///< nothing that comes from inside is transmitted

 private:
  /// Wavelengths and azimuths of the slices; InputError when they are no grid.
  void check_grid();
  std::size_t pick_slice(double lateral_azimuth, double wavelength_nm, core::Rng& rng) const;

  std::vector<TableSlice> slices_;
  /// Two per slice: from inside, from outside.
  using Samplers = std::vector<TableSampler>;
  /// Equal copies, for threads to spread over: two threads that read the same one take 2 to 4 % longer, since
  /// their cores then hand its lines to each other (tools/bench crystal).
  std::vector<Samplers> samplers_;
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

}  // namespace scintray::optics
