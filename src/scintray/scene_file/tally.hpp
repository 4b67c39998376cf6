#pragma once
/// [[tally]]: quantities counted in addition to the fates of all photons.

#include <optional>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/core/words.hpp"
#include "scintray/scene_file/part.hpp"
#include "scintray/scene_file/tally_axis.hpp"

namespace scintray::scene_file {

/// Words for step events in scene files and in the names of bins. "cut" means both events of photons
/// that were cut.
inline constexpr core::Word<core::StepEvent> kEventWords[] = {
    {"emitted", core::StepEvent::emitted},
    {"scattered", core::StepEvent::scattered},
    {"shifted", core::StepEvent::re_emitted},
    {"returned", core::StepEvent::reflected},
    {"crossed", core::StepEvent::transmitted},
    {"detected", core::StepEvent::detected},
    {"unconverted", core::StepEvent::not_detected},
    {"absorbed_in_medium", core::StepEvent::absorbed_in_medium},
    {"absorbed_at_surface", core::StepEvent::absorbed_at_surface},
    {"escaped", core::StepEvent::escaped},
    {"cut", core::StepEvent::cut_interactions}};

/// Step events of a photon that count: every one, the first or the last.
enum class TallyEach { time, first, last };
inline constexpr core::Word<TallyEach> kTallyEach[] = {
    {"time", TallyEach::time}, {"first", TallyEach::first}, {"last", TallyEach::last}};

/// Direction of incidence on a face, relative to its part.
enum class FaceWay {
  out,
  in,
  both,
  arriving  ///< in on the faces of a part that is a sensor, in which no light starts; out on all others
};
inline constexpr core::Word<FaceWay> kFaceWays[] = {
    {"out", FaceWay::out}, {"in", FaceWay::in}, {"both", FaceWay::both}, {"arriving", FaceWay::arriving}};

/// A count of step events over axes, of photons that fulfil conditions. Names of parts and faces may have
/// wildcards.
struct TallySpec {
  std::string name;
  std::string type;  ///< its word in the scene file: "count", "crosstalk", "irradiance", ...
  std::vector<core::StepEvent> at;
  std::vector<config::NameRef> faces;  ///< "part:face"; empty: not bound to faces
  FaceWay way = FaceWay::out;
  std::vector<config::NameRef> parts;         ///< condition on the variable part
  std::vector<config::NameRef> source_parts;  ///< condition on the variable source_part
  std::vector<TallyRangeSpec> ranges;
  std::vector<config::NameRef> visited, not_visited;  ///< parts visited by the photon at any time
  std::vector<core::StepEvent> fate;                  ///< final fate of the photon; empty: any
  TallyEach each = TallyEach::time;
  std::optional<core::Vec3> normal;  ///< of the plane of a grid over faces; nothing: the faces'
  TallyVariablePtr score;            ///< variable that is summed; null: photons
  std::vector<TallyAxisSpec> axes;
  core::FileLocation where;

  /// True when only the last event of each finally detected photon counts.
  bool detected_only() const;
};

/// Score of a tally without a variable: one per photon.
inline constexpr const char* kPhotonScore = "photons";

/// Type and name of the second histogram of an exit angle tally: angles behind the face. The first, of the
/// angles in front of it, has the type "exit_angle" and the tally's name.
inline constexpr const char* kExitAngle = "exit_angle";
inline constexpr const char* kExitAngleBeyond = "exit_angle_beyond";
inline constexpr const char* kCrosstalk = "crosstalk";
inline constexpr const char* kCrosstalkEmitted = "emitted";  ///< its companion, the light of each part
inline constexpr const char* kEtendue = "etendue";
inline std::string beyond_name(const std::string& name) { return name + ": beyond"; }

/// [[tally]] of a scene.
/// @param parts  parts with known faces
/// @param names  of all parts
std::vector<TallySpec> read_tallies(const config::TomlTable& root, const std::vector<PartSpec>& parts,
                                    const std::vector<std::string>& names, const TallyVariables& variables);

}  // namespace scintray::scene_file
