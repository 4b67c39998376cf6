#include "scintray/simulation/detail/block_pieces.hpp"

#include <doctest/doctest.h>

using namespace scintray;
using namespace scintray::simulation;

namespace {

/// Checks that pieces follow each other from the first block to the last; with no end before, none is larger
/// than the one before.
void check_covered(const tally::BlockRange& blocks, std::uint64_t most, std::uint64_t threads,
                   bool may_have_enough) {
  CAPTURE(blocks.count());
  CAPTURE(threads);
  const BlockPieces pieces(blocks, most, threads, may_have_enough);
  std::uint64_t next = blocks.first, before = most;
  for (std::uint64_t i = 0; i < pieces.count(); ++i) {
    const tally::BlockRange piece = pieces.at(i);
    CHECK(piece.first == next);
    CHECK(piece.count() >= 1);
    CHECK(piece.count() <= (may_have_enough ? most : before));
    next = piece.last;
    before = piece.count();
  }
  CHECK(next == blocks.last);
}

}  // namespace

TEST_CASE("The pieces that threads trace cover the blocks of a run in order, and become no larger") {
  for (const std::uint64_t count : {0U, 1U, 7U, 8U, 9U, 31U, 32U, 39U, 40U, 98U, 1000U})
    for (const std::uint64_t threads : {1U, 2U, 3U, 64U})
      for (const std::uint64_t most : {1U, 8U})
        for (const bool may_have_enough : {false, true})
          check_covered({5, 5 + count}, most, threads, may_have_enough);
}

TEST_CASE("One thread traces as many blocks together as are allowed, also in a short run") {
  const BlockPieces pieces({0, 20}, 8, 1, false);
  REQUIRE(pieces.count() == 3);
  CHECK(pieces.at(0) == tally::BlockRange{0, 8});
  CHECK(pieces.at(2) == tally::BlockRange{16, 20});
}

TEST_CASE("The last piece of a run on several threads is a single block") {
  for (const std::uint64_t threads : {2U, 8U}) {
    const BlockPieces pieces({0, 1000}, 8, threads, false);
    CHECK(pieces.at(0).count() == 8);
    CHECK(pieces.at(pieces.count() - 1).count() == 1);
  }
}

TEST_CASE("A run that has enough has traced at most an eighth more than it needed, and one block") {
  const BlockPieces pieces({0, 1000}, 8, 2, true);
  for (std::uint64_t i = 0; i < pieces.count(); ++i)
    CHECK(pieces.at(i).count() <= 1 + pieces.at(i).first / 8);
  CHECK(pieces.at(0).count() == 1);
  CHECK(pieces.at(40).count() == 8);
}

TEST_CASE("Pieces of a run of any length take little memory") {
  const std::uint64_t blocks = std::uint64_t{1} << 60;
  const BlockPieces pieces({0, blocks}, 1, 2, false);
  CHECK(pieces.count() == blocks);
  CHECK(pieces.at(blocks - 1) == tally::BlockRange{blocks - 1, blocks});
}
