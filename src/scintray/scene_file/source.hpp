#pragma once
/// [source] of photons in a scene file. Lengths mm, wavelengths nm, times ns, angles rad.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/scene_file/shape.hpp"

namespace scintray::scene_file {

/// Volume of a part, or of several, in which light starts.
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
  std::optional<double> time_ns = 0.0;  ///< nothing: drawn from the decay times of the medium there
  core::FileLocation time_where;
  bool unpolarised = false;  ///< mean Fresnel reflectance at every surface; else each photon has a
                             ///< polarisation, drawn uniformly perpendicular to its direction
  std::optional<core::Vec3> polarisation;  ///< unit: the electric field, of which the component perpendicular
                                           ///< to the direction is taken
  std::uint64_t photons = 0;
  std::optional<std::uint64_t> quick_photons;  ///< replaces `photons` in a quick run
  std::uint64_t photons_per_event = 1000;      ///< the last event may have fewer
  core::FileLocation where;
};

/// The value of `source.region`; `parts` are the names of the scene's parts.
RegionSpec read_region(const config::TomlTable& table, const std::vector<std::string>& parts);

/// The value of `source.position`, mm.
core::Vec3 read_position(const config::TomlTable& table);

/// Keys for the origin of light or energy.
enum class OriginKind { region, position, plane };

/// Reads a region or a position into a variant of both; a plane is left to the caller.
template <class Origin>
void read_origin(const config::TomlTable& table, OriginKind kind, const std::vector<std::string>& parts,
                 Origin& origin) {
  if (kind == OriginKind::region) origin = read_region(table.table("region"), parts);
  if (kind == OriginKind::position) origin = read_position(table);
}

/// Direction from the key `direction`: "isotropic", a beam, a cone or a Lambertian lobe.
DirectionSpec read_direction(const config::TomlTable& table);

/// [source] of type = "photons", apart from its type and polarisation.
SourceSpec read_photon_source(const config::TomlTable& table, const std::vector<std::string>& parts);

}  // namespace scintray::scene_file
