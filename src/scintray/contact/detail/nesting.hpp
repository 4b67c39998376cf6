#pragma once
/// Which part lies inside which, and which parts overlap.

#include <cstdint>
#include <vector>

#include "scintray/contact/detail/clusters.hpp"

namespace scintray::contact {

/// Two bodies that share volume without one lying inside the other.
struct OverlappingPair {
  std::uint32_t a, b;
};

/// Bodies around bodies. Bodies that merely touch are not inside each other.
struct Nesting {
  std::vector<std::vector<std::uint32_t>> around;  ///< by body: all bodies around it, innermost first
  std::vector<OverlappingPair> overlaps;

  std::size_t depth(std::uint32_t body) const { return around[body].size(); }
  /// The part that is the innermost body around `body`, or kAmbient.
  core::PartId parent(std::uint32_t body) const {
    return around[body].empty() ? kAmbient : core::PartId(around[body].front());
  }
};

/// Decides for every near pair whether the bodies are apart (touching or not), nested or overlapping.
/// What reaches less than `tolerance_mm` into the other body counts as touching it.
Nesting find_nesting(const std::vector<Body>& bodies, const std::vector<BodyPair>& pairs,
                     double tolerance_mm);

}  // namespace scintray::contact
