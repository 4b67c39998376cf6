#pragma once
/// From a height field to a surface table, by tracing.

#include <cstdint>
#include <functional>
#include <vector>

#include "scintray/core/cancelled.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/optics/height_field.hpp"
#include "scintray/optics/surface.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::topography {

/// How a table is traced. The defaults are those of E. Roncali and S. R. Cherry 2013, Phys. Med.
/// Biol. 58, 2185, section 2.1: 2.25 deg of incidence, 9 deg of azimuth, 2000 rays each.
struct TableSettings {
  double incidence_step_rad = 2.25 * core::kDegree;
  double azimuth_step_rad = 9.0 * core::kDegree;
  std::uint64_t rays = 2000;  ///< per incidence angle and azimuth step
  std::uint64_t seed = 1;
  bool refine = true;           ///< bisect where the reflectance changes fast, as at a critical angle
  double refine_change = 0.05;  ///< change of reflectance that requests another node
  double refine_down_to_rad = 0.1 * core::kDegree;  ///< intervals not wider than this are left
  double grazing_rad = 89.9 * core::kDegree;        ///< where the node at 90 deg is traced

  /// A slice per azimuth step of incidence on the map, for surfaces with direction; `rays` are then traced
  /// for each incidence angle and slice.
  bool directional = false;
  /// One-sigma error of a node's reflectance (and absorptance) down to which rays are added; 0: the number
  /// of rays is fixed.
  double target_error = 0.0;
  std::uint64_t most_rays = 64;  ///< at most this many times the rays of a fixed number
  /// Lossless surfaces only: the table is made exactly reciprocal (ReciprocalKernel), each of its states lit
  /// with half as many rays as a node. Not together with `directional`.
  bool reciprocal = false;
};

/// A wavelength to tabulate, and the indices there.
struct SpectralPoint {
  double wavelength_nm = 0.0;  ///< 0: not stated
  optics::IndexPair index;
};

/// Called with the share of the work done so far, between 0 and 1; returns false to stop.
using TableProgress = std::function<bool(double)>;

/// The building of a table was stopped by its progress callback.
class TableStopped : public core::Cancelled {
 public:
  using core::Cancelled::Cancelled;
};

/// Whether a direction, in the frame of the surface (z: outwards), points into the medium that the light left
/// into; so does that of absorbed light. A ray for which it does not has no medium: none may (InternalError).
[[nodiscard]] bool leaves_into_medium(optics::SurfaceOutcome outcome, const core::Vec3& direction);

/// Traces unpolarised light from both sides at every incidence node of every wavelength: positions uniform
/// over the map (so facets are hit as the beam sees them), azimuths of the map stratified over the circle
/// (or, for a directional table, one by one), rays followed until they leave. Nodes are then bisected where
/// settings.refine states so, and rays added as settings.target_error requires.
///
/// Runs on all threads of the calling task arena; the result is the same for any number of them.
/// @param spectrum   at least one point, in order of wavelength
/// @param provenance map, preparation and tiling as the caller knows them; the rest is filled in.
/// InputError on settings out of range; TableStopped when `progress` returns false.
optics::SurfaceTable build_table(const optics::HeightField& field, const std::vector<SpectralPoint>& spectrum,
                                 const TableSettings& settings, optics::TableProvenance provenance = {},
                                 const TableProgress& progress = {});
/// The same at one pair of indices.
optics::SurfaceTable build_table(const optics::HeightField& field, const optics::IndexPair& index,
                                 const TableSettings& settings, optics::TableProvenance provenance = {},
                                 const TableProgress& progress = {});

/// A whole stack as one table: the same for any surface, its gap, reflector and shares included. Of a stack
/// the mean visible slope is not known: it is left at zero.
optics::SurfaceTable build_stack_table(const optics::Surface& surface,
                                       const std::vector<SpectralPoint>& spectrum,
                                       const TableSettings& settings, optics::TableProvenance provenance = {},
                                       const TableProgress& progress = {});

}  // namespace scintray::topography
