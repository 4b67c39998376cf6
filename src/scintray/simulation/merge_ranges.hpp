#pragma once
/// Merging of shards and checkpoints into the results of the run that they are parts of.

#include <filesystem>
#include <vector>

#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation {

/// Passes the ranges of files, whatever their order, to a sink as the run of all blocks in one process would
/// have done, bit for bit, and commits it. Wall times are sums.
///
/// @param files    of shards or checkpoints
/// @param partial  true to accept that blocks are missing: the result is then marked as partial, with the
/// reason
/// @throws InputError for files that are damaged, of another run than the first, or that hold the same
/// blocks,
///         with each of them; and for missing blocks unless `partial`, with what is missing
tally::RunResult merge_ranges(const std::vector<std::filesystem::path>& files, ResultSink& sink,
                              bool partial = false);

}  // namespace scintray::simulation
