#pragma once
/// Summary of a run for the terminal.

#include <string>
#include <vector>

#include "scintray/report/run_analysis.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// Summary of a run as text. A sweep over a number: a table of detected fractions, rows the swept value,
/// columns the series. Any other sweep: one line per point. One point: every fate. Ends with warnings and the
/// reason of a partial result.
/// @param analyses  of the events of the points; with them the tables are of light per event
std::string text_summary(const tally::RunResult& run, const RunAnalysis& analyses = {});

}  // namespace scintray::report
