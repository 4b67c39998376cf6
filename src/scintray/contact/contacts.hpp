#pragma once
/// From closed part meshes to interfaces between regions.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::contact {

/// A closed, outward-oriented part in world coordinates (mm) with a face id per triangle.
struct PlacedPart {
  std::string name;
  std::vector<core::Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face;  ///< per triangle, scene-wide face id
  core::FileLocation where = {};    ///< in the scene file
};

/// The place of the part `name` as an addition to a message whose own place is `reported`:
/// "; 'NAME' is at FILE:LINE:COLUMN"; empty when the places are the same.
std::string also_at(const std::string& name, const core::FileLocation& where,
                    const core::FileLocation& reported);

inline constexpr std::int32_t kAmbient = -1;
inline constexpr std::int32_t kNoFace = -1;

/// A triangle between two regions; its normal (right-hand rule) points from `back` to `front`.
/// A region is the inside of a part less the parts nested in it, or the ambient medium.
struct InterfaceTriangle {
  std::array<core::Vec3, 3> vertex;
  std::int32_t back = kAmbient;  ///< part index or kAmbient
  std::int32_t front = kAmbient;
  std::int32_t back_face = kNoFace;  ///< face id of the back part here; kNoFace when the surface
                                     ///< here belongs to the front part alone
  std::int32_t front_face = kNoFace;
};

/// Interfaces between the regions of touching and nested parts.
///
/// Coplanar faces of different parts closer than `tolerance_mm` (and parallel within it over their
/// extent) are overlaid exactly: where they overlap, one set of triangles separates the two parts;
/// elsewhere each borders the region around it. Nested parts border the innermost part around them;
/// flush nested faces are handled. The triangles of every region together form its closed boundary.
///
/// @throws InputError naming both parts, the overlap volume and a point inside it, for parts that
///         overlap with volume; all such pairs are listed.
[[nodiscard]] std::vector<InterfaceTriangle> resolve_contacts(const std::vector<PlacedPart>& parts,
                                                              double tolerance_mm);

}  // namespace scintray::contact
