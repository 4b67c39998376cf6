#pragma once
/// The tallies of a run, derived once from a scene and its specification.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/detector/channel.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/spec.hpp"
#include "scintray/tally/per_crossing.hpp"
#include "scintray/tally/photon_history.hpp"
#include "scintray/tally/readout_channels.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::tally {

/// Seed of the streams by which photons are in a sampled list, the same in all runs.
inline constexpr std::uint64_t kSampleSeed = 0x73616d706c65;

/// A bin of an axis of names.
using BinId = core::Id<struct BinTag>;

/// An axis of a count, bound to the scene.
struct CountAxis {
  scene_file::TallyVariablePtr variable;
  core::Vec3 along = core::Vec3::Zero();
  double low = 0.0, per_bin = 0.0;
  std::uint32_t bins = 0;
  /// No value lies below or above: the end is the bound of the variable or of a face, and values beyond it by
  /// rounding count as within.
  bool ends_low = false, ends_high = false;
  /// Of names: bin of each place (TallyVariable::place), none for a place without a bin.
  std::vector<BinId> bin_of;
};

/// A condition on a number.
struct CountRange {
  scene_file::TallyVariablePtr variable;
  core::Vec3 along = core::Vec3::Zero();
  double low = 0.0, high = 0.0;
};

/// A count requested of a run.
struct CountRequest {
  TallyResult empty;  ///< name, axes and zeros
  std::vector<CountAxis> axes;
  std::vector<CountRange> ranges;
  std::vector<bool> parts, source_parts;                      ///< by place_of; empty: all
  core::IdVector<core::RegionId, bool> visited, not_visited;  ///< empty: no condition
  std::uint32_t fates = 0;                                    ///< bits of StepEvent; 0: any
  scene_file::TallyEach each = scene_file::TallyEach::time;
  scene_file::TallyVariablePtr score;  ///< null: photons
};

struct TallyPlan {
  /// Throws InputError for names that do not exist, with the existing ones, and for impossible tallies: a
  /// grid on a face that is not flat, too many bins.
  TallyPlan(const scene::Scene& scene, const scene_file::SceneSpec& spec);

  PerCrossing<SensorFaceId> sensor_faces;  ///< none where there is no sensor
  std::vector<SensorFaceCount> sensor_face_names;
  ReadoutChannels channels;
  std::vector<detector::Channel> readout;  ///< the electronics of each channel; empty without [readout]

  std::vector<CountRequest> counts;
  /// A count to evaluate at an interaction with a face, and the face to which it is bound.
  struct CountAtFace {
    std::uint32_t count = 0;
    core::FaceId face;
    bool inwards = false;  ///< light is incident on the face from outside its part
  };
  PerCrossing<std::vector<CountAtFace>> counts_at;  ///< empty without such counts
  std::vector<std::uint32_t> events_of;             ///< per count: bits of StepEvent
  std::uint32_t events_counted = 0;                 ///< bits of StepEvent: those of all counts
  /// Counts bound to no face, per step event.
  std::array<std::vector<std::uint32_t>, core::kStepEventCount> counts_on;
  bool follows_regions = false;      ///< a count depends on the regions that a photon visited
  bool follows_reflections = false;  ///< a count depends on every total reflection passed
  /// True when some count may count the event.
  bool counts_event(core::StepEvent event) const {
    return (events_counted >> static_cast<unsigned>(event) & 1u) != 0;
  }

  bool photon_list = false;
  std::uint64_t list_every = 1;     ///< one photon in so many
  std::vector<bool> list_channels;  ///< of `channels`, those that are listed; empty: all
  /// True when a detected photon is in the list. Which photons a sample has depends on their numbers alone,
  /// not on seed or scene.
  bool lists(const transport::Step& step, std::uint64_t event, std::uint64_t photon) const {
    if (!photon_list || (!list_channels.empty() && !list_channels[channels.at(step)])) return false;
    return list_every == 1 ||
           core::Rng(kSampleSeed, core::StreamKind::other, event, photon).bits() % list_every == 0;
  }
  std::optional<HistoryPlan> history;  ///< when histories are requested

 private:
  void bind_photon_list(const scene_file::SceneSpec& spec);
  void bind_readout(const scene_file::SceneSpec& spec, const scene::Scene& scene);
  void bind_ways(const scene::Scene& scene);
  std::map<std::pair<core::PartId, core::FaceId>, SensorFaceId> sensor_face_of_;
};

/// Binds one count to a scene. @throws InputError
/// @param source_parts  names of the parts in which light starts; empty: not available
CountRequest bind_count(const scene_file::TallySpec& spec, const std::vector<config::NameRef>& source_parts,
                        const scene::Scene& scene);

/// The faces to which a count is bound, in their order. @throws InputError for a name without a face.
std::vector<core::FaceId> faces_of(const scene_file::TallySpec& spec, const scene::Scene& scene);

}  // namespace scintray::tally
