#include "scintray/simulation/detail/block_pieces.hpp"

#include <algorithm>

namespace scintray::simulation {

BlockPieces::BlockPieces(const tally::BlockRange& blocks, std::uint64_t most, std::uint64_t threads)
    : first_(blocks.first), most_(most) {
  // Half of what is left is divided among the threads; one alone need not wait for others.
  const std::uint64_t parts = threads > 1 ? 2 * threads : 1;
  const std::uint64_t left = blocks.count(), least = parts * most;
  if (left >= least) whole_ = (left - least) / most + 1;
  for (std::uint64_t first = first_ + whole_ * most; first < blocks.last;) {
    const std::uint64_t size = std::max<std::uint64_t>((blocks.last - first) / parts, 1);
    last_.push_back({first, first + size});
    first += size;
  }
}

tally::BlockRange BlockPieces::at(std::uint64_t number) const {
  if (number >= whole_) return last_[number - whole_];
  const std::uint64_t first = first_ + number * most_;
  return {first, first + most_};
}

}  // namespace scintray::simulation
