#pragma once
/// Why points ended: [run] until.

#include <string>

#include "scintray/tally/result.hpp"

namespace scintray::report {

/// "Ended by until: relative error of detected 0.0098, goal 0.01.", or that no condition ended the point,
/// with the values reached. Empty without [run] until.
std::string until_sentence(const tally::PointResult& point);

}  // namespace scintray::report
