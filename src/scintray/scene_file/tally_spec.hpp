#pragma once
/// What a scene file asks to be counted beside the fates of all photons.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::scene_file {

/// Histogram of crossing angles at a face.
struct ExitAngleTallySpec {
  std::string name;
  config::NameRef part;  ///< face = "part:face"
  config::NameRef face;
  bool detected_only = false;
  int bins = 18;  ///< over 0 to 90 deg
  core::FileLocation where;
};

/// Words for step events in scene files and in the names of bins. "cut" stands for both events of photons
/// that were cut.
inline constexpr int kEventWordCount = 11;
const char* event_word(core::StepEvent event);
/// The events that a word stands for, one or two, from its place among the words.
std::vector<core::StepEvent> events_of_word(int place);

/// A number or a name that an axis spreads over bins and a condition bounds.
enum class TallyVariable : std::uint8_t {
  // numbers
  wavelength,    ///< nm
  time,          ///< ns
  path,          ///< mm since emission
  interactions,  ///< boundary interactions since emission
  scatterings,   ///< bulk scatterings since emission
  crossings,     ///< times it changed region since emission
  position,      ///< component along a direction, mm
  start,         ///< component of the starting point along a direction, mm
  direction,     ///< cosine of the direction of travel to a direction
  angle_before,  ///< rad, to the face's normal, before the interaction
  angle_after,   ///< ... and after
  sin2_before,   ///< squared sine of the same: equal bins hold equal projected solid angle
  sin2_after,
  azimuth_before,  ///< rad, about the face's normal
  azimuth_after,
  // names
  part,         ///< where it ends: the sensor's part, or the part it is in
  source_part,  ///< where it started
  face,         ///< the face of the interaction
  event,        ///< what happened
};
inline constexpr int kTallyVariableCount = 19;
const char* tally_variable_name(TallyVariable variable);
inline bool is_category(TallyVariable variable) { return variable >= TallyVariable::part; }
inline bool needs_face(TallyVariable variable) {
  return variable == TallyVariable::face ||
         (variable >= TallyVariable::angle_before && variable <= TallyVariable::azimuth_after);
}
inline bool needs_direction(TallyVariable variable) {
  return variable >= TallyVariable::position && variable <= TallyVariable::direction;
}

/// How often a photon counts.
enum class TallyEach { time, first, last };

/// Direction of incidence on a face, seen from its part.
enum class FaceWay { out, in, both };

struct TallyAxisSpec {
  TallyVariable variable = TallyVariable::part;
  core::Vec3 along = core::Vec3::Zero();  ///< unit; of a position, start or direction
  std::optional<double> low, high;        ///< in the variable's unit; nothing: the face's extent
  std::int64_t bins = 1;                  ///< of a number
  std::vector<config::NameRef> names;     ///< of a name, may have wildcards; nothing: all that can be
  bool across_face = false;               ///< `along` is the face's first or second direction
  int across = 0;                         ///< which of the two
  std::optional<double> pixel_mm;         ///< in place of bins
  core::FileLocation where;
};

/// A bound on a number: low <= x < high.
struct TallyRangeSpec {
  TallyVariable variable = TallyVariable::wavelength;
  core::Vec3 along = core::Vec3::Zero();
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  core::FileLocation where;
};

/// A count of step events over axes, of photons that fulfil conditions. Names of parts and faces may have
/// wildcards.
struct TallySpec {
  std::string name;
  std::string type;  ///< the key it was written with: "count", "crosstalk", "irradiance", ...
  std::vector<core::StepEvent> at;
  std::vector<config::NameRef> faces;  ///< "part:face"; empty: not bound to faces
  FaceWay way = FaceWay::out;
  std::vector<config::NameRef> parts;         ///< condition on TallyVariable::part
  std::vector<config::NameRef> source_parts;  ///< condition on TallyVariable::source_part
  std::vector<TallyRangeSpec> ranges;
  std::vector<config::NameRef> visited, not_visited;  ///< parts the photon was in, at any time of its life
  std::vector<core::StepEvent> fate;                  ///< of the photon in the end; empty: any
  TallyEach each = TallyEach::time;
  std::optional<core::Vec3> normal;    ///< of the plane of a grid across faces; nothing: the faces'
  std::optional<TallyVariable> score;  ///< sum of this number; nothing: photons
  std::vector<TallyAxisSpec> axes;
  core::FileLocation where;
};

}  // namespace scintray::scene_file
