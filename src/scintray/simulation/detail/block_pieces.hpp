#pragma once
/// Pieces of work that the blocks of a run are traced in.

#include <cstdint>
#include <vector>

#include "scintray/tally/point_sums.hpp"

namespace scintray::simulation {

/// Successive blocks divided into pieces of several each: what is traced together keeps the lanes full until
/// its last photons are under way. Towards the end they become smaller, so that threads end at about the same
/// time. Those of a run that may have enough begin small, so that little is traced in vain. No result depends
/// on them.
class BlockPieces {
 public:
  /// @param most     blocks of a piece, at least 1
  /// @param threads  at least 1
  /// @param may_have_enough  the run may end before the last block
  BlockPieces(const tally::BlockRange& blocks, std::uint64_t most, std::uint64_t threads,
              bool may_have_enough);

  std::uint64_t count() const { return first_.size() + whole_ + last_.size(); }
  /// @param number  below count()
  tally::BlockRange at(std::uint64_t number) const;

 private:
  std::uint64_t most_;
  std::vector<tally::BlockRange> first_;  ///< those that begin small
  std::uint64_t whole_ = 0;               ///< pieces of `most` blocks after them
  std::uint64_t first_whole_;             ///< block that these begin at
  std::vector<tally::BlockRange> last_;   ///< those after them
};

}  // namespace scintray::simulation
