#pragma once
/// From closed part meshes to interfaces between regions.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/ids.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/mesh/support_surface.hpp"

namespace scintray::contact {

/// A closed, outward-oriented part in world coordinates (mm) with a face id per triangle.
struct PlacedPart {
  std::string name;
  std::vector<core::Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<core::FaceId> face;  ///< per triangle
  core::FileLocation where = {};   ///< in the scene file
  /// Surfaces that round faces approximate, and per triangle the index of its own, or mesh::kNoSupport; both
  /// empty: none has any.
  std::vector<mesh::SupportSurface> supports = {};
  std::vector<std::uint32_t> support = {};
};

/// The place of the part `name` as an addition to a message whose own place is `reported`:
/// "; 'NAME' is at FILE:LINE:COLUMN"; empty when the places are the same.
std::string also_at(const std::string& name, const core::FileLocation& where,
                    const core::FileLocation& reported);

/// In place of a part: the ambient medium.
inline constexpr core::PartId kAmbient = core::PartId::none();

/// A triangle between two regions; its normal (right-hand rule) points from `back` to `front`.
/// A region is the inside of a part less the parts nested in it, or the ambient medium.
struct InterfaceTriangle {
  std::array<core::Vec3, 3> vertex;
  core::PartId back = kAmbient, front = kAmbient;
  /// Of the part on either side; none when the surface here belongs to the other part alone.
  core::FaceId back_face, front_face;
  /// The surface that the face approximates, in its part's list; kNoSupport: none.
  std::uint32_t back_support = mesh::kNoSupport, front_support = mesh::kNoSupport;
};

/// Two parts, by number, that share volume without one lying inside the other.
struct OverlappingPair {
  std::uint32_t a, b;
};

/// Interfaces between the regions of touching and nested parts.
///
/// Coplanar faces of different parts closer than `tolerance_mm` (and parallel within it over their
/// extent) are overlaid with exact predicates: where they overlap, one set of triangles separates the two
/// parts; elsewhere each borders the region around it. Nested parts border the innermost part around them;
/// flush nested faces are handled. The triangles of every region together form its closed boundary.
///
/// @param parts  the i-th has the id i
/// @param by_facets  receives the pairs of which facets overlap by no more than they deviate from their
/// support
///        surfaces, so that the exact bodies may not; null: these count as overlapping
/// @throws InputError as refuse_overlaps, for parts that overlap with volume
[[nodiscard]] std::vector<InterfaceTriangle> resolve_contacts(
    const std::vector<PlacedPart>& parts, double tolerance_mm,
    std::vector<OverlappingPair>* by_facets = nullptr);

/// Throws InputError, if there are any pairs, naming both parts of each, the overlap volume and a point
/// inside it.
void refuse_overlaps(const std::vector<PlacedPart>& parts, const std::vector<OverlappingPair>& pairs,
                     double tolerance_mm);

}  // namespace scintray::contact
