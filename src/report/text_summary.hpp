#pragma once
/// The answer of a run for the terminal.

#include <string>

#include "scintray/tally/result.hpp"

namespace scintray {

/// A sweep over a number: a table of detected fractions, rows the swept value, columns the series. Any
/// other sweep: one line a point. One point: every fate. Ends with what is partial or doubtful.
std::string text_summary(const RunResult& run);

}  // namespace scintray
