#include "scintray/scene_file/tally_spec.hpp"

#include <algorithm>
#include <array>

namespace scintray::scene_file {

const char* event_word(core::StepEvent event) {
  static constexpr std::array<const char*, kEventWordCount> kWords = {"emitted",
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
  return kWords[std::min(static_cast<std::size_t>(event), kWords.size() - 1)];
}

std::vector<core::StepEvent> events_of_word(int place) {
  if (place == kEventWordCount - 1) return {core::StepEvent::cut_interactions, core::StepEvent::cut_time};
  return {static_cast<core::StepEvent>(place)};
}

const char* tally_variable_name(TallyVariable variable) {
  static constexpr std::array<const char*, kTallyVariableCount> kNames = {
      "wavelength",  "time",        "path",       "interactions",   "scatterings",
      "crossings",   "position",    "start",      "direction",      "angle_before",
      "angle_after", "sin2_before", "sin2_after", "azimuth_before", "azimuth_after",
      "part",        "source_part", "face",       "occasion"};
  return kNames[static_cast<std::size_t>(variable)];
}

}  // namespace scintray::scene_file
