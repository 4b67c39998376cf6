#pragma once
/// Where light starts, as a scene file says it. Lengths mm, wavelengths nm, times ns, angles rad.

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene_file/shape_spec.hpp"
#include "scintray/scene_file/tally_spec.hpp"

namespace scintray::scene_file {

/// Points of a part (or of an explicit point) from which light starts.
struct RegionSpec {
  config::NameRef part;                            ///< may have wildcards: any of these parts, by volume
  std::optional<std::array<double, 2>> slab_z_mm;  ///< world z, low then high
  std::optional<BoxSpec> box;                      ///< world
  core::FileLocation where;
};

enum class DirectionKind { isotropic, beam, cone, lambertian };

struct DirectionSpec {
  DirectionKind kind = DirectionKind::isotropic;
  core::Vec3 axis =
      core::Vec3::UnitZ();      ///< unit; of a beam, a cone (uniform in solid angle), a Lambertian lobe
  double half_angle_rad = 0.0;  ///< of a cone, up to pi
  core::FileLocation where;
};

/// type = "photons": photons from a region or a point.
struct SourceSpec {
  std::variant<RegionSpec, core::Vec3> origin;  ///< uniform in a region, or one point (mm, world)
  core::FileLocation origin_where;
  DirectionSpec direction;
  std::optional<double> wavelength_nm;  ///< nothing: drawn from the emission of the medium there
  core::FileLocation wavelength_where;
  std::optional<double> time_ns = 0.0;  ///< nothing: drawn from the decay of the medium there
  core::FileLocation time_where;
  bool unpolarised = false;  ///< Fresnel's mean at every surface; else each photon carries a
                             ///< polarisation, drawn uniformly across its direction
  std::uint64_t photons = 0;
  std::optional<std::uint64_t> quick_photons;  ///< in their place, for a quick run
  std::uint64_t photons_per_event = 1000;      ///< the last event may have fewer
  core::FileLocation where;
};

}  // namespace scintray::scene_file
