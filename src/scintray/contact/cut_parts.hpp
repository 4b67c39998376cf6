#pragma once
/// Overlaps that are meant: the part with the higher priority keeps the space.

#include "scintray/contact/placed_mesh.hpp"
#include "scintray/core/error.hpp"

namespace scintray::contact {

/// Cuts every part by the parts of higher priority that it overlaps with. Faces born in a cut are named
/// "cut:NAME" after the part that cut, and have the finish of the cut part itself. Parts that lie wholly
/// one inside the other, or merely touch within `tolerance_mm`, are left alone, as are overlaps of equal
/// priority, which resolving contacts refuses. What was done is added to the notes of the cut part.
///
/// Adds to `problems`: cuts that CGAL refuses or that leave an unsound part, parts of which nothing is
/// left, and cut faces without a surface.
void cut_overlaps(std::vector<PlacedMesh>& parts, double tolerance_mm, core::Problems& problems);

}  // namespace scintray::contact
