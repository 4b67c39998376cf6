#pragma once
/// Making one outline of the outlines that a contact has in two parts.

#include <map>
#include <optional>
#include <vector>

#include "scintray/contact/detail/cut_contact.hpp"

namespace scintray::contact {

/// A place of the common outline, in order along the keeper's.
struct Knot {
  double along = 0.0;
  core::Vec3 position;
  std::uint32_t of_keeper = ~0U, of_taker = ~0U;  ///< vertices
};

/// One outline in the place of the taker's and the keeper's, which runs the other way round: moves the
/// taker's corners onto the keeper's outline, and cuts edges of both parts where the other has a corner.
/// `merged` says which of the taker's vertices become others, `moved` how far one went at most, mm. Nothing
/// where the two run further apart than twice the tolerance, or their corners come in another order.
std::optional<std::vector<Knot>> stitch_outlines(CutPart& keeper, CutPart& taker, const Loop& keeper_loop,
                                                 const Loop& taker_loop, double tolerance,
                                                 std::map<std::uint32_t, std::uint32_t>& merged,
                                                 double& moved);

/// Which outline of the keeper each of the taker's runs along; nothing when they are no pairs.
std::optional<std::vector<std::size_t>> outline_pairs(const CutPart& keeper, const CutPart& taker);

}  // namespace scintray::contact
