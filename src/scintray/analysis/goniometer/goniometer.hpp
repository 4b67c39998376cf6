#pragma once
/// A goniometer: a parallel beam on one surface, and the distribution of the outgoing light.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "scintray/analysis/goniometer/hemisphere.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::analysis {

struct GoniometerSettings {
  optics::Side side = optics::Side::inside;  ///< side of the incident light
  double incidence_rad = 0.0;                ///< from the mean normal, in [0, 90 deg)
  double wavelength_nm = 0.0;
  std::uint64_t rays = 1'000'000;
  std::uint64_t seed = 1;
  std::uint64_t stream = 0;  ///< readings of one seed and different streams are independent
  double profile_half_width_rad = 5.0 * core::kDegree;  ///< of the detector, out of the plane of incidence
  std::function<bool()> stop = {};  ///< cancels the reading when it returns true; called on any thread
};

/// Mean direction and width of the outgoing light on one side.
struct Lobe {
  std::uint64_t rays = 0;  ///< the other members are defined only above 0
  /// Of the mean direction: its angle in the plane of incidence from the side's outward normal, forward
  /// positive, and its angle out of that plane (rad), with standard errors.
  core::Estimate in_plane_rad, across_rad;
  /// Root mean square of the direction's component perpendicular to the mean direction, in the plane of
  /// incidence and out of it: for narrow lobes the standard deviation in rad, at most 1.
  double width_in_plane = 0.0, width_across = 0.0;
};

/// Result of the rays; every ray is in exactly one of the three counts.
struct GoniometerReading {
  GoniometerSettings settings;
  std::uint64_t reflected = 0, transmitted = 0, absorbed = 0;
  DirectionCounts reflected_directions, transmitted_directions;
  Lobe reflected_lobe, transmitted_lobe;

  core::Estimate reflectance() const { return core::binomial_estimate(reflected, settings.rays); }
  core::Estimate transmittance() const { return core::binomial_estimate(transmitted, settings.rays); }
  core::Estimate absorptance() const { return core::binomial_estimate(absorbed, settings.rays); }
};

/// Reading of unpolarised light (the mean of Fresnel's two reflectances at every facet, as in tables)
/// incident on a surface. An anisotropic surface is on a face of normal z, with the light travelling towards
/// +x.
///
/// Runs on all threads of the calling task arena; the reading is the same for any number of them.
/// @param index  of the media on the two sides, at the wavelength
/// InputError on an incidence angle outside [0, 90 deg), no rays, a wavelength that is not positive, or a
/// half-width outside (0, 90 deg]; Cancelled when it was stopped.
GoniometerReading read_goniometer(const optics::Surface& surface, const optics::IndexPair& index,
                                  const GoniometerSettings& settings);

/// Readings at several incidence angles (rad), each with a stream of its own.
std::vector<GoniometerReading> sweep_incidence(const optics::Surface& surface, const optics::IndexPair& index,
                                               GoniometerSettings settings,
                                               const std::vector<double>& incidence_rad);

}  // namespace scintray::analysis
