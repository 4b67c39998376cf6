#pragma once
/// Curved faces that touch: two tessellations of one surface made one.

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/core/error.hpp"

namespace scintray::contact {

/// Two parts, by name, whose faces are made one where they lie within a tolerance of each other.
struct ConformingContact {
  std::string first, second;
  double tolerance_mm = 0.0;
  core::FileLocation where;
};

/// For every contact, gives one of its parts the other's faces where both lie
/// within that tolerance of each other, facing each other.
///
/// Two tessellations of one curved surface leave slivers, now gap, now overlap. One part takes all of
/// them: its facing triangles are pushed into the other part by twice the tolerance, along the part's
/// neighbouring faces, and the other part is then cut out of it, pushed outwards itself where it ends
/// flush. So the contact is the other part's own triangles, and nothing moves by more than the tolerance, or
/// twice that at a sharp rim. The first part keeps its shape, unless only it is covered by
/// the second.
///
/// Where on either part a triangle lies partly within the tolerance and partly beyond it, each part's face
/// ends within the other's: then both are stitched together there (stitch_parts.hpp), the first one keeping
/// its shape.
///
/// What was done is in the notes of the part that changed. Adds to `problems`: contacts without facing
/// triangles, and parts whose change CGAL refuses or leaves unsound. Faces flat on each other within
/// `flat_mm` need none of this, and are left to the resolving of contacts.
void conform_contacts(std::vector<PlacedMesh>& parts, const std::vector<ConformingContact>& contacts,
                      double flat_mm, core::Problems& problems);

}  // namespace scintray::contact
