#include "scintray/scene/tally_spec.hpp"

#include <array>

namespace scintray {

const char* occasion_name(Occasion occasion) {
  static constexpr std::array<const char*, kOccasionCount> kNames = {"emitted",
                                                                     "scattered",
                                                                     "shifted",
                                                                     "returned",
                                                                     "crossed",
                                                                     "detected",
                                                                     "unconverted",
                                                                     "absorbed_in_medium",
                                                                     "absorbed_at_surface",
                                                                     "escaped",
                                                                     "cut"};
  return kNames[static_cast<std::size_t>(occasion)];
}

const char* tally_variable_name(TallyVariable variable) {
  static constexpr std::array<const char*, kTallyVariableCount> kNames = {
      "wavelength",  "time",        "path",       "interactions",   "scatterings",
      "crossings",   "position",    "start",      "direction",      "angle_before",
      "angle_after", "sin2_before", "sin2_after", "azimuth_before", "azimuth_after",
      "part",        "source_part", "face",       "occasion"};
  return kNames[static_cast<std::size_t>(variable)];
}

}  // namespace scintray
