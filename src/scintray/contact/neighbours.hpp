#pragma once
/// Adjacent placed parts: touching triangles, closing of curved contacts, cutting of intended overlaps, small
/// gaps.

#include <string>
#include <vector>

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/core/error.hpp"

namespace scintray::contact {

/// Two parts, by name, whose faces become one where they lie within a tolerance of each other.
struct ConformingContact {
  std::string first, second;
  double tolerance_mm = 0.0;
  core::FileLocation where;
};

/// Closes curved contacts: in every contact, one part takes the faces of the other where both lie within that
/// tolerance of each other, facing each other.
///
/// Two tessellations of one curved surface leave slivers, alternately gaps and overlaps. One part takes all
/// of them: its facing triangles are pushed into the other part by twice the tolerance, along the part's
/// neighbouring faces, and the other part is then cut out of it, pushed outwards itself where it ends
/// flush. So the contact is the other part's own triangles, and nothing moves by more than the tolerance, or
/// twice that at a sharp rim. The first part keeps its shape, unless only it is covered by
/// the second.
///
/// Where on either part a triangle lies partly within the tolerance and partly beyond it, each part's face
/// ends within the other's: then both are stitched together there (detail/stitch.hpp), the first one keeping
/// its shape.
///
/// Faces of both that approximate one surface remain faces of that surface; a part that adopts others has
/// none whose surface is known. The changes are in the notes of the part that changed. Adds to `problems`:
/// contacts without facing triangles, and parts for which CGAL fails or which the change leaves unsound. Flat
/// faces within `flat_mm` of each other do not need this and are left to resolve_contacts.
void conform_contacts(std::vector<PlacedMesh>& parts, const std::vector<ConformingContact>& contacts,
                      double flat_mm, core::Problems& problems);

/// Lets parts have the same facets on round walls that both have, of one surface within `flat_mm` and with a
/// part on either side: a rod in a bore of its radius, a ball in its seat. The part around the other adopts
/// the other's facets where these reach all of its own, else the other adopts its facets, or both are
/// stitched together. Contacts in `stated` have a tolerance of their own, and are left out; where a part
/// cannot be changed so, its facets remain, and overlap the other's.
void conform_common_walls(std::vector<PlacedMesh>& parts, const std::vector<ConformingContact>& stated,
                          double flat_mm);

/// Subtracts from every part the overlapping parts of higher priority. Faces made by a cut are named
/// "cut:NAME" after the part that cut, and have the finish of the part that was cut. Parts that lie one
/// entirely inside the other, or merely touch within `tolerance_mm`, are left unchanged, as are overlaps of
/// equal priority, which are errors when contacts are resolved. The changes are added to the notes of the
/// part that was cut.
///
/// Adds to `problems`: cuts in which CGAL fails or that leave an unsound part, parts of which nothing is
/// left, and cut faces without a surface.
void cut_overlaps(std::vector<PlacedMesh>& parts, double tolerance_mm, core::Problems& problems);

/// Two parts whose faces face each other across a gap that may be unintended.
struct SmallGap {
  std::string a, b;
  double gap_mm = 0.0;                    ///< at its narrowest
  core::Vec3 place = core::Vec3::Zero();  ///< there, mm
  double area_mm2 = 0.0;                  ///< of the overlap of its faces, projected along their normals
};

/// A gap is small below this share of the smaller part's diagonal (chosen).
inline constexpr double kSmallGapShare = 1e-3;

/// Pairs of parts with nearly parallel faces that overlap, projected along their normals, across a gap wider
/// than `tolerance_mm` (nearer ones touch) and narrower than `share` of the diagonal of the smaller part.
/// Gaps filled by a third part are left out.
[[nodiscard]] std::vector<SmallGap> find_small_gaps(const std::vector<PlacedMesh>& parts, double tolerance_mm,
                                                    double share = kSmallGapShare);

/// Mask over the triangles of `part`: 1 where some of its area lies on a face of `other`, facing it. Flat
/// triangles touch within `tolerance_mm`; with `curved_mm` above it, the tolerance of a conforming contact of
/// the two, curved ones do within that.
[[nodiscard]] std::vector<char> touching_triangles(const PlacedMesh& part, const PlacedMesh& other,
                                                   double tolerance_mm, double curved_mm = 0.0);

}  // namespace scintray::contact
