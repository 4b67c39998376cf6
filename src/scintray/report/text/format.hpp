#pragma once
/// Numbers and text as people read them.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"

namespace scintray::report {

/// Text made safe inside HTML and SVG, attributes included.
std::string escape_html(const std::string& text);
/// "0.3373 ± 0.0011": the error to two significant digits, the value to the same place.
std::string with_error(const core::Estimate& estimate);
/// "33.73 ± 0.11 %".
std::string percent_with_error(const core::Estimate& estimate);
/// "187 500": digits in groups of three.
std::string grouped(std::uint64_t count);
/// A number with so many decimals.
std::string fixed(double value, int decimals);
/// At most `digits` significant digits, without needless zeros.
std::string compact(double value, int digits = 4);
/// Columns a terminal needs for UTF-8 text (code points; ScintRay writes no wide ones).
std::size_t display_width(const std::string& text);
/// Rows for a terminal: columns padded to their widest cell, the first to the left, the others to the right.
std::string aligned(const std::vector<std::vector<std::string>>& table);

}  // namespace scintray::report
