#include "scintray/simulation/detail/block_pieces.hpp"

#include <algorithm>

namespace scintray::simulation {

BlockPieces::BlockPieces(const tally::BlockRange& blocks, std::uint64_t most, std::uint64_t threads,
                         bool may_have_enough)
    : most_(most), first_whole_(blocks.first) {
  while (may_have_enough && first_whole_ < blocks.last) {
    // A share of 1 / most of what was traced before.
    const std::uint64_t size = 1 + (first_whole_ - blocks.first) / most;
    if (size >= most) break;
    const std::uint64_t end = std::min(first_whole_ + size, blocks.last);
    first_.push_back({first_whole_, end});
    first_whole_ = end;
  }
  // Half of what is left is divided among the threads; one alone need not wait for others.
  const std::uint64_t parts = threads > 1 ? 2 * threads : 1;
  const std::uint64_t left = blocks.last - first_whole_, least = parts * most;
  if (left >= least) whole_ = (left - least) / most + 1;
  for (std::uint64_t first = first_whole_ + whole_ * most; first < blocks.last;) {
    const std::uint64_t size = std::max<std::uint64_t>((blocks.last - first) / parts, 1);
    last_.push_back({first, first + size});
    first += size;
  }
}

tally::BlockRange BlockPieces::at(std::uint64_t number) const {
  if (number < first_.size()) return first_[number];
  number -= first_.size();
  if (number >= whole_) return last_[number - whole_];
  const std::uint64_t first = first_whole_ + number * most_;
  return {first, first + most_};
}

}  // namespace scintray::simulation
