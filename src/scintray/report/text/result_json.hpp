#pragma once
/// A result as JSON.

#include <optional>
#include <string>
#include <vector>

#include "scintray/report/run_analysis.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::report {

/// The numbers of a run as JSON (RFC 8259): header, and for each point its parameters, fates, counts of
/// sensors, absorbed light, means of the detected photons, tallies with the sum and the error of each bin
/// (the last axis fastest) and what follows from them (light spread, etendue), exit angles, omitted effects
/// (null: not recorded), energies, and the analysis of its events with the names of analysis::list_fields;
/// the claims of its scene. Numbers that are not finite are null. Bytes that are not UTF-8 are replaced by
/// U+FFFD.
/// @param analyses  of the events of the points, in their order; empty for a run of photons
std::string result_json(const tally::RunResult& run, const RunAnalysis& analyses);

/// Omitted effects as JSON: a list with effect, subject, the figures that it changes, and the remedy; null
/// where they are not recorded.
std::string omissions_json(const std::optional<std::vector<tally::OmittedEffect>>& effects);

}  // namespace scintray::report
