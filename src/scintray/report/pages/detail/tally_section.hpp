#pragma once
/// What the tallies of a run say: crosstalk, light spread, ledgers, counts.

#include <string>

#include "scintray/tally/result.hpp"

namespace scintray::report {

/// A figure or a table for every tally of every point; empty when there is none.
std::string tally_section(const tally::RunResult& run);

/// One line a tally, for a terminal; empty when there is none.
std::string tally_lines(const tally::PointResult& point);

}  // namespace scintray::report
