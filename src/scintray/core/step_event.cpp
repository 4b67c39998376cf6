#include "scintray/core/step_event.hpp"

#include <string>

#include "scintray/core/error.hpp"

namespace scintray::core {

const char* fate_name(Fate fate) {
  switch (fate) {
    case Fate::detected:
      return "detected";
    case Fate::not_detected:
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
    default:
      throw InternalError("step event " + std::to_string(static_cast<int>(fate)) + " is not a fate");
  }
}

}  // namespace scintray::core
