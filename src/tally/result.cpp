#include "scintray/tally/result.hpp"

#include <algorithm>

#include "scintray/core/error.hpp"

namespace scintray {

const char* fate_name(Fate fate) {
  switch (fate) {
    case Fate::detected:
      return "detected";
    case Fate::unconverted:
      return "unconverted";
    case Fate::absorbed_in_medium:
      return "absorbed_in_medium";
    case Fate::absorbed_at_surface:
      return "absorbed_at_surface";
    case Fate::escaped:
      return "escaped";
    case Fate::cut_interactions:
      return "cut_interactions";
    case Fate::cut_time:
      return "cut_time";
  }
  throw InternalError("fate " + std::to_string(static_cast<int>(fate)) + " has no name");
}

double PointResult::cut_bias_bound() const {
  if (photons == 0) return 0.0;
  const std::uint64_t cut = count(Fate::cut_interactions) + count(Fate::cut_time);
  return static_cast<double>(cut) / static_cast<double>(photons);
}

bool RunResult::complete() const {
  return partial_reason.empty() && !points.empty() &&
         std::all_of(points.begin(), points.end(), [](const PointResult& point) { return point.complete; });
}

}  // namespace scintray
