#pragma once
/// Formatting of numbers and text for readers.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/statistics.hpp"
#include "scintray/core/step_event.hpp"

namespace scintray::report {

/// Text escaped for HTML and SVG, attributes included.
std::string escape_html(const std::string& text);
/// Text of a fate: "not detected", "absorbed in medium".
std::string fate_text(core::Fate fate);
/// "0.3373 ± 0.0011": the error to two significant digits, the value to the same place.
std::string with_error(const core::Estimate& estimate);
/// "55.2 +4.9 −4.2": a value with the limits of its interval; the smaller error to two significant digits.
std::string with_errors(double value, double low, double high);
/// "33.73 ± 0.11 %".
std::string percent_with_error(const core::Estimate& estimate);
/// "187 500": digits in groups of three.
std::string grouped(std::uint64_t count);
/// A number with a fixed number of decimals.
std::string fixed(double value, int decimals);
/// At most `digits` significant digits, without needless zeros.
std::string compact(double value, int digits = 4);
/// Width of UTF-8 text on a terminal, columns (code points; ScintRay writes no wide ones).
std::size_t display_width(const std::string& text);
/// Rows for a terminal: columns padded to their widest cell, the first to the left, the others to the right.
std::string aligned(const std::vector<std::vector<std::string>>& table);

}  // namespace scintray::report
