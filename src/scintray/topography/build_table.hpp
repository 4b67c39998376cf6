#pragma once
/// Surface tables from height fields, by ray tracing.

#include <cstdint>
#include <functional>
#include <vector>

#include "scintray/core/cancelled.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/optics/height_field.hpp"
#include "scintray/optics/surface.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::topography {

/// Version of the content of tables, a part of the key of cached ones (materials/table_key.hpp). Raise it
/// with every change after which the same recipe or map file, with the same settings, gives a different
/// table: in the tracing, the synthesis, the readers of height maps or their preparation. tests/topography/
/// table_content_test.cpp fails when such a change is made without.
inline constexpr int kTableContentVersion = 2;

/// Settings of the tracing of a table. The defaults are those of E. Roncali and S. R. Cherry 2013, Phys. Med.
/// Biol. 58, 2185, section 2.1: 2.25 deg of incidence, 9 deg of azimuth, 2000 rays each.
struct TableSettings {
  double incidence_step_rad = 2.25 * core::kDegree;
  double azimuth_step_rad = 9.0 * core::kDegree;
  std::uint64_t rays = 2000;  ///< per incidence angle and azimuth step
  std::uint64_t seed = 1;
  bool refine = true;  ///< bisect intervals in which the reflectance changes fast, as at a critical angle
  double refine_change = 0.05;  ///< change of reflectance above which an interval is bisected (chosen)
  double refine_down_to_rad = 0.1 * core::kDegree;  ///< intervals not wider than this are not bisected
  double grazing_rad = 89.9 * core::kDegree;        ///< angle at which the node at 90 deg is traced (chosen)

  /// A slice per azimuth step of incidence on the map, for anisotropic surfaces; `rays` are then traced
  /// for each incidence angle and slice.
  bool directional = false;
  /// Standard error of a node's reflectance (and absorptance) down to which rays are added; 0: the number
  /// of rays is fixed.
  double target_error = 0.0;
  std::uint64_t most_rays = 64;  ///< limit of the added rays, as a multiple of `rays`
  /// For lossless surfaces only: the table is made exactly reciprocal (ReciprocalKernel), each of its states
  /// traced with half as many rays as a node. Not together with `directional`.
  bool reciprocal = false;
};

/// A wavelength of the table, and the indices at it.
struct SpectralPoint {
  double wavelength_nm = 0.0;  ///< 0: not stated
  optics::IndexPair index;
};

/// Throws InputError on settings out of range, and for an empty spectrum or an index that is not positive.
void require_valid(const TableSettings& settings, const std::vector<SpectralPoint>& spectrum);

/// Progress callback: its argument is the share of the work done, 0 to 1; it returns false to stop.
using TableProgress = std::function<bool(double)>;

/// Thrown when the progress callback stops the building of a table.
class TableStopped : public core::Cancelled {
 public:
  using core::Cancelled::Cancelled;
};

/// True when a direction, in the frame of the surface (z: outwards), points into the medium into which the
/// light left; true for absorbed light. A ray for which it is false has no medium (InternalError).
[[nodiscard]] bool leaves_into_medium(optics::SurfaceOutcome outcome, const core::Vec3& direction);

/// Surface table of a height field: traces unpolarised light from both sides at every incidence node of every
/// wavelength, with positions uniform over the map (so that facets are weighted by their area projected along
/// the beam) and azimuths of the map stratified over the circle (or, for a directional table, one by one);
/// rays are followed until they leave. Then nodes are bisected where settings.refine requires, and rays added
/// as settings.target_error requires.
///
/// Runs on all threads of the calling task arena; the result is the same for any number of them.
/// @param spectrum   at least one point, in order of wavelength
/// @param provenance map, preparation and tiling, set by the caller; the rest is filled in
/// InputError on settings out of range; TableStopped when `progress` returns false.
optics::SurfaceTable build_table(const optics::HeightField& field, const std::vector<SpectralPoint>& spectrum,
                                 const TableSettings& settings, optics::TableProvenance provenance = {},
                                 const TableProgress& progress = {});
/// The same at one pair of indices.
optics::SurfaceTable build_table(const optics::HeightField& field, const optics::IndexPair& index,
                                 const TableSettings& settings, optics::TableProvenance provenance = {},
                                 const TableProgress& progress = {});

/// A complete stack as one table: the same for any surface, including its gap, reflector and shares. The mean
/// visible slope of a stack is not available: it is zero.
optics::SurfaceTable build_stack_table(const optics::Surface& surface,
                                       const std::vector<SpectralPoint>& spectrum,
                                       const TableSettings& settings, optics::TableProvenance provenance = {},
                                       const TableProgress& progress = {});

}  // namespace scintray::topography
