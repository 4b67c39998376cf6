#pragma once
/// Counting what happens to the photons of one block.

#include <cstdint>
#include <vector>

#include "scintray/scene/spec.hpp"
#include "scintray/source/photon.hpp"
#include "scintray/tally/result.hpp"
#include "scintray/tally/step.hpp"

namespace scintray {

/// A histogram of crossing angles that a run is asked for.
struct ExitAngleRequest {
  std::string name;
  std::uint32_t face = 0;  ///< scene-wide face id
  bool detected_only = false;
  int bins = 18;
};

/// What to count, derived once from a scene.
struct TallyPlan {
  /// Throws InputError for an exit-angle tally on a face that does not exist, naming the faces there.
  TallyPlan(const Scene& scene, const std::vector<ExitAngleTallySpec>& exit_angles, bool photon_list);

  std::vector<ExitAngleRequest> exit_angles;
  /// Per interface and way across it (index 2 * interface + from_back): tallies to fill, most have
  /// none.
  std::vector<std::vector<std::uint32_t>> exit_angles_at;
  std::vector<std::uint32_t> sensor_faces;  ///< per interface and way: index into the result, or kNoSensor
  std::vector<SensorFaceCount> sensor_face_names;
  bool photon_list = false;
  static constexpr std::uint32_t kNoSensor = 0xffffffffu;
};

/// Counts of one block of photons. Blocks are merged in their order, so sums are the same whatever
/// thread traced them.
class BlockTally {
 public:
  explicit BlockTally(const Scene& scene, const TallyPlan& plan);

  /// Begins a photon.
  void start(std::uint64_t event, std::uint64_t photon);
  /// A step that did not end it.
  void record(const Photon& photon, const Step& step);
  /// Its end: by a last step, or by a limit.
  void end(const Photon& photon, const Step& step, std::uint32_t point);
  void cut(const Photon& photon, Fate fate);

  const PointResult& result() const { return result_; }
  const std::vector<DetectedPhoton>& photons() const { return photons_; }

 private:
  struct Angles {
    int inside = -1, outside = -1;
  };
  void count_step(const Step& step);
  void note_crossing(const Step& step);
  void finish(const Photon& photon, Fate fate);

  const TallyPlan& plan_;
  const Scene& scene_;
  PointResult result_;
  std::vector<DetectedPhoton> photons_;
  std::vector<Angles> last_crossing_;  ///< per exit-angle tally, of the photon under way
  std::uint64_t event_ = 0, photon_ = 0;
};

/// An all-zero result with the right sizes.
PointResult empty_result(const Scene& scene, const TallyPlan& plan);

/// Adds a block's counts to a total.
void merge(PointResult& total, const PointResult& block);

}  // namespace scintray
