#pragma once
/// Scores the counts that a run was asked for, photon by photon.

#include <cstdint>
#include <vector>

#include "scintray/source/photon.hpp"
#include "scintray/tally/step.hpp"
#include "scintray/tally/tally_plan.hpp"

namespace scintray {

/// What one photon gave to one bin.
struct Contribution {
  static constexpr std::uint32_t kOutside = 0xffffffffu;  ///< as a bin: beyond the axes
  std::uint32_t count = 0;                                ///< index into TallyPlan::counts
  std::uint32_t bin = 0;
  double score = 0.0;
};

/// Follows the photons of one block. What they contribute waits until each has ended, since conditions
/// may ask for its fate and the error of a bin for all that one photon gave to it.
class CountScorer {
 public:
  CountScorer(const Scene& scene, const TallyPlan& plan) : scene_(scene), plan_(plan) {}

  void start(const Photon& photon);
  /// A step and the photon after it; `cut` in place of a step where a limit ended it.
  void step(const Photon& photon, const Step& step);
  void cut(const Photon& photon, Fate fate);

  /// All contributions so far, in the order of photons; those of one photon to one bin are one.
  const std::vector<Contribution>& contributions() const { return contributions_; }

 private:
  /// One thing that happened.
  struct Moment {
    StepEvent event;
    const Photon& photon;       ///< after it
    std::int32_t part = kNone;  ///< as TallyVariable::part
    std::uint32_t face = 0;
    Vec3 normal = Vec3::Zero();  ///< of the face, out of its part
  };

  void happened(Moment& moment, const Step* step);
  void score(std::uint32_t number, const Moment& moment);
  double value(TallyVariable variable, const Vec3& along, const Moment& moment) const;
  bool accepts(const CountRequest& count, const Moment& moment) const;
  std::uint32_t bin_of(const CountRequest& count, const Moment& moment, bool& named) const;
  void end(Fate fate);

  const Scene& scene_;
  const TallyPlan& plan_;
  std::vector<Contribution> contributions_, pending_;
  std::vector<std::uint32_t> visited_;  ///< regions, when some count asks
  Vec3 start_ = Vec3::Zero(), direction_before_ = Vec3::Zero();
  std::int32_t source_part_ = kNone;
  std::uint32_t crossings_ = 0;
};

/// Adds contributions to the sums of `total`, one for each count of the plan.
void add_contributions(const std::vector<Contribution>& contributions, std::vector<TallyResult>& total);

}  // namespace scintray
