#pragma once
/// Step events and fates of a photon.

#include <cstddef>
#include <cstdint>

namespace scintray::core {

/// Event of a photon in one step. The last ones, from `detected` on, are final: one of them is the fate of
/// each photon.
enum class StepEvent : std::uint8_t {
  emitted,      ///< its start
  scattered,    ///< in the bulk
  re_emitted,   ///< in the bulk, absorbed and emitted again at another wavelength
  reflected,    ///< interacted with a boundary and stayed in its region
  transmitted,  ///< interacted with a boundary and went into the neighbouring region
  // Final:
  detected,             ///< by a sensor
  not_detected,         ///< reached a sensor, not detected
  absorbed_in_medium,   ///< in the bulk, or in the opaque medium behind a boundary
  absorbed_at_surface,  ///< by a reflector, a coating or a table
  escaped,              ///< left the scene through the ambient medium
  cut_interactions,     ///< stopped at the limit of boundary interactions
  cut_time,             ///< stopped at the time limit
};
inline constexpr int kStepEventCount = 12;

/// A final StepEvent.
using Fate = StepEvent;
inline constexpr int kFirstFate = static_cast<int>(StepEvent::detected);
inline constexpr int kFateCount = kStepEventCount - kFirstFate;

constexpr bool is_final(StepEvent event) { return static_cast<int>(event) >= kFirstFate; }
/// True for events at a boundary: reflected, transmitted, detected, not detected, absorbed at a surface,
/// and absorbed in the opaque medium behind the boundary.
constexpr bool is_at_boundary(StepEvent event) {
  return event >= StepEvent::reflected && event <= StepEvent::absorbed_at_surface;
}
/// Index of a fate among the fates, 0 to kFateCount - 1.
constexpr std::size_t fate_index(Fate fate) {
  return static_cast<std::size_t>(static_cast<int>(fate) - kFirstFate);
}
/// The fate at an index, 0 to kFateCount - 1.
constexpr Fate fate_at(int index) { return static_cast<Fate>(kFirstFate + index); }
/// Name of a fate in results files: that of the enumerator, but "unconverted" for not_detected.
const char* fate_name(Fate fate);

}  // namespace scintray::core
