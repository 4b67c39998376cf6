#pragma once
/// Normal deviates in the lanes of vector registers. Plain data alone, as this header is included by files
/// that are compiled for instruction sets which not every processor has.

#include <cstddef>
#include <cstdint>

namespace scintray::core {

/// Deviates from successive numbers of a stream.
struct NormalLanes {
  static constexpr std::size_t kLeft = 8;     ///< numbers that may be left of earlier blocks
  static constexpr std::size_t kBlocks = 16;  ///< drawn, each of four numbers
  static constexpr std::size_t kPairs = 2 * kBlocks;
  static constexpr std::size_t kDeviates = 2 * kPairs;

  std::uint64_t counter[4], key[2];  ///< Philox's, of the first block
  std::size_t left = 0;              ///< these are the last of the first kLeft numbers
  alignas(64) std::uint64_t numbers[kLeft + 4 * kBlocks];
  alignas(64) double deviates[kDeviates];
};

/// Draws the blocks, and sets the deviates from the numbers that are left and those after them.
using DrawNormals = void (*)(NormalLanes&);

// Defined where its instruction set is compiled.
void draw_normals_4(NormalLanes&);
void draw_normals_8(NormalLanes&);

}  // namespace scintray::core
