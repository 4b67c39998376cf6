#pragma once
/// Surface tables: reflectance and direction distributions against incidence angle.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
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
  double azimuth_rad = 0.0;    ///< of lateral propagation from the height map's x axis, about the normal
  IndexPair index;
  std::vector<TableNode> from_inside, from_outside;
  /// When present, directions are drawn from this kernel in place of the nodes' distributions.
  std::shared_ptr<const ReciprocalKernel> reciprocal;

  const std::vector<TableNode>& nodes(Side side) const {
    return side == Side::inside ? from_inside : from_outside;
  }
};

/// Provenance of a table: its inputs and settings.
struct TableProvenance {
  std::string map;          ///< file name or recipe
  std::string stack;        ///< layers tabulated with the height map: gap, reflector, shares; empty: none
  std::string preparation;  ///< levelling and filters applied, in order
  std::string tiling;       ///< "mirror" or "periodic"
  std::uint64_t seed = 0;
  std::uint64_t rays_per_azimuth = 0;
  std::uint64_t azimuths = 0;
  std::uint64_t unclassified =
      0;                  ///< rays directed away from the medium that they left into: 0, or no table is made
  std::uint64_t cut = 0;  ///< rays released at the step limit
  double target_error = 0.0;      ///< standard error of the reflectance up to which rays were added; 0: none
  std::uint64_t unconverged = 0;  ///< nodes that did not reach it at the maximum number of rays
  std::string reciprocity;        ///< of a table made reciprocal: deviation of the traced one; else empty
  std::string version;            ///< ScintRay version that built it
};

/// A tabulated microsurface or stack. Valid for its pairs of indices only.
///
/// Between wavelengths, and between azimuths of incidence, one of the two neighbouring slices is drawn for
/// each photon with the weights of linear interpolation, which interpolates every distribution linearly.
/// Beyond the first and the last wavelength the nearest slice is used.
class SurfaceTable : public MicrosurfaceModel {
 public:
  SurfaceTable() = default;
  /// A table of one slice, for all wavelengths and azimuths. Nodes strictly increasing in incidence from 0 to
  /// pi/2 on each side, reflectances and absorptances in [0, 1] with a sum of at most 1, quantiles of the
  /// right number, increasing and within [0, pi/2] and the range of the azimuth, and present wherever light
  /// leaves by the shares; otherwise throws InputError with every fault.
  SurfaceTable(IndexPair index, std::vector<TableNode> from_inside, std::vector<TableNode> from_outside,
               TableProvenance provenance);
  /// A table of a whole grid: slices in order of wavelength, within each of azimuth; every wavelength with
  /// the same azimuths, which are evenly spaced over the circle from 0. Throws InputError otherwise, as
  /// above.
  SurfaceTable(std::vector<TableSlice> slices, AzimuthKind kind, TableProvenance provenance);

  /// Outcome for a ray incident on `side`; the ray is returned with its new direction on the side of the
  /// outcome. The polarisation, which a table does not contain, is drawn anew unless the ray is unpolarised.
  /// @param along  for a directional table: direction of the map's x axis (projected onto the face; zero:
  ///               at random)
  SurfaceOutcome interact(Ray& ray, Side side, const core::Vec3& normal, const core::Vec3& along,
                          double wavelength_nm, core::Rng& rng) const;

  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index,
                         SurfaceInteraction& interaction) const override;
  /// The side on which the ray leaves a table without absorption: the first wavelength, any azimuth. `index`
  /// is not used: the table is valid for `index_pair()`.
  Side scatter(Ray& ray, Side side, const core::Vec3& normal, const IndexPair& index, core::Rng& rng) const;

  /// Reflectance on incidence from `side` at an angle (rad): linear between nodes; for a table made
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
  bool absorbs() const { return absorbs_; }         ///< true when a node has an absorptance above 0
  bool opaque() const override { return opaque_; }  ///< no light from inside is transmitted
  /// True when every slice has a reciprocal kernel. Others are reciprocal only within their noise.
  bool reciprocal() const override;

  /// Slices at a wavelength: the lower one and, where there are several, the probability of the next.
  struct BetweenWavelengths {
    std::size_t first = 0;
    std::optional<double> to_next{};
  };
  BetweenWavelengths between_wavelengths(double wavelength_nm) const;
  /// Of a slice, for incidence from a side: the copy for the calling thread.
  const TableSampler& sampler(std::size_t slice, Side side) const;

 private:
  /// Wavelengths and azimuths of the slices; throws InputError when they do not form a grid.
  void check_grid();
  std::size_t pick_slice(double lateral_azimuth, double wavelength_nm, double for_wavelength,
                         core::Rng& rng) const;

  std::vector<TableSlice> slices_;
  /// Two per slice: from inside, from outside.
  using Samplers = std::vector<TableSampler>;
  /// Equal copies, distributed over threads: two threads that read the same copy take 2 to 4 % longer, since
  /// its cache lines are then shared between cores (tools/bench --scene table).
  std::vector<Samplers> samplers_;
  std::vector<double> wavelengths_nm_;
  std::size_t azimuths_ = 1;
  AzimuthKind kind_ = AzimuthKind::folded;
  bool absorbs_ = false, opaque_ = false;
  TableProvenance provenance_;
};

/// Version of the layout of table files; files of another version are rejected.
inline constexpr std::int64_t kTableFileVersion = 2;

/// Writing and reading of a table as HDF5. Reading throws InputError for a wrong version, shape or range.
void write_table(const std::filesystem::path& path, const SurfaceTable& table);
SurfaceTable read_table(const std::filesystem::path& path);

}  // namespace scintray::optics
