#pragma once
/// What wavelength shifters did, as text and on the page.

#include <string>

#include "scintray/tally/result.hpp"

namespace scintray::report {

/// One line for each medium and surface that shifted light; empty when none did.
std::string shift_lines(const tally::RunHeader& header, const tally::PointResult& point);
/// A table of them over all points; empty when none did.
std::string shift_section(const tally::RunResult& run);

}  // namespace scintray::report
