#pragma once
/// Making one outline of the outlines that a contact has in two parts.

#include <map>
#include <optional>
#include <vector>

#include "scintray/contact/detail/cut_contact.hpp"

namespace scintray::contact {

/// A place of the common outline, in order along the reference side's.
struct Knot {
  double along = 0.0;
  core::Vec3 position;
  std::uint32_t of_reference = ~0U, of_conforming = ~0U;  ///< vertices
};

/// One outline in the place of the conforming side's and the reference side's, which runs the other way
/// round: moves the conforming side's corners onto the reference side's outline, and cuts edges of both parts
/// where the other has a corner. `merged` states which of the conforming side's vertices become others,
/// `moved` how far one went at most, mm. Nothing where the two run further apart than twice the tolerance, or
/// their corners come in another order.
std::optional<std::vector<Knot>> stitch_outlines(CutPart& reference, CutPart& conforming,
                                                 const Loop& reference_loop, const Loop& conforming_loop,
                                                 double tolerance,
                                                 std::map<std::uint32_t, std::uint32_t>& merged,
                                                 double& moved);

/// Which outline of the reference side each of the conforming side's runs along; nothing when they are no
/// pairs.
std::optional<std::vector<std::size_t>> outline_pairs(const CutPart& reference, const CutPart& conforming);

}  // namespace scintray::contact
