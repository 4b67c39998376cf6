#pragma once
/// Scores the counts requested of a run, photon by photon.

#include <cstdint>
#include <vector>

#include "scintray/tally/point_sums.hpp"
#include "scintray/tally/tally_plan.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::tally {

/// Contribution of one photon to one bin.
struct Contribution {
  static constexpr std::uint32_t kOutside = 0xffffffffu;  ///< as a bin: beyond the axes
  std::uint32_t count = 0;                                ///< index into TallyPlan::counts
  std::uint32_t bin = 0;
  double score = 0.0;
};

/// Scorer of the photons of one block. Contributions are held until the photon has ended, since conditions
/// may depend on its fate, and the error of a bin on the sum of one photon's contributions to it.
class CountScorer {
 public:
  CountScorer(const scene::Scene& scene, const TallyPlan& plan);

  void start(const source::Photon& photon);
  /// A step and the photon after it; `cut` in place of a step where a limit ended it.
  void step(const source::Photon& photon, const transport::Step& step);
  void cut(const source::Photon& photon, core::Fate fate);

  /// All contributions so far, in the order of photons; those of one photon to one bin are merged.
  const std::vector<Contribution>& contributions() const { return contributions_; }

 private:
  /// Scores an event in the counts that are bound to no face, and in those bound to the faces of its
  /// interface.
  void score_step(const source::Photon& photon, const transport::Step& step);
  void score_anywhere(const source::Photon& photon, core::StepEvent event, core::PartId part);
  void score_at_faces(const source::Photon& photon, const transport::Step& step, core::PartId part);
  void score(std::uint32_t number);
  /// Sets the view of the present photon to an event in a part; none: the ambient space.
  void look_at(const source::Photon& photon, core::StepEvent event, core::PartId part);
  bool accepts(const CountRequest& count) const;
  std::uint32_t bin_of(const CountRequest& count, bool& named) const;
  void end(core::Fate fate);

  const scene::Scene& scene_;
  const TallyPlan& plan_;
  std::vector<Contribution> contributions_, pending_;
  std::vector<core::RegionId> visited_;  ///< when a count requires them
  scene_file::StepView view_;            ///< of the present photon
};

/// Adds contributions to the sums of `total`, which has one entry for each count of the plan.
void add_contributions(const std::vector<Contribution>& contributions, std::vector<TallySums>& total);

/// Adds all contributions of the photons of one event to the sums over events of `total`.
/// @param event    its number
/// @param photons  traced of it
void add_event(std::vector<Contribution> contributions, std::uint64_t event, std::uint64_t photons,
               std::vector<TallySums>& total);

}  // namespace scintray::tally
