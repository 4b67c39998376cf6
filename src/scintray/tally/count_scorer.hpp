#pragma once
/// Scores the counts requested of a run, photon by photon.

#include <cstdint>
#include <vector>

#include "scintray/source/photon.hpp"
#include "scintray/tally/tally_plan.hpp"
#include "scintray/transport/step_record.hpp"

namespace scintray::tally {

/// What one photon gave to one bin.
struct Contribution {
  static constexpr std::uint32_t kOutside = 0xffffffffu;  ///< as a bin: beyond the axes
  std::uint32_t count = 0;                                ///< index into TallyPlan::counts
  std::uint32_t bin = 0;
  double score = 0.0;
};

/// Follows the photons of one block. What they contribute waits until each has ended, since conditions
/// may request its fate and the error of a bin for all that one photon gave to it.
class CountScorer {
 public:
  CountScorer(const scene::Scene& scene, const TallyPlan& plan) : scene_(scene), plan_(plan) {}

  void start(const source::Photon& photon);
  /// A step and the photon after it; `cut` in place of a step where a limit ended it.
  void step(const source::Photon& photon, const transport::Step& step);
  void cut(const source::Photon& photon, core::Fate fate);

  /// All contributions so far, in the order of photons; those of one photon to one bin are one.
  const std::vector<Contribution>& contributions() const { return contributions_; }

 private:
  /// One thing that happened.
  struct Moment {
    core::StepEvent event;
    const source::Photon& photon;  ///< after it
    core::PartId part;             ///< as TallyVariable::part
    core::FaceId face = {};
    core::Vec3 normal = core::Vec3::Zero();  ///< of the face, out of its part
  };

  void happened(Moment& moment, const transport::Step* step);
  void score(std::uint32_t number, const Moment& moment);
  double value(scene_file::TallyVariable variable, const core::Vec3& along, const Moment& moment) const;
  bool accepts(const CountRequest& count, const Moment& moment) const;
  std::uint32_t bin_of(const CountRequest& count, const Moment& moment, bool& named) const;
  void end(core::Fate fate);

  const scene::Scene& scene_;
  const TallyPlan& plan_;
  std::vector<Contribution> contributions_, pending_;
  std::vector<core::RegionId> visited_;  ///< when some count needs them
  core::Vec3 start_ = core::Vec3::Zero(), direction_before_ = core::Vec3::Zero();
  core::PartId source_part_;
  std::uint32_t crossings_ = 0;
};

/// Adds contributions to the sums of `total`, one for each count of the plan.
void add_contributions(const std::vector<Contribution>& contributions, std::vector<TallyResult>& total);

}  // namespace scintray::tally
