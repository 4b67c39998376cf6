#include "scintray/simulation/detail/passing_on.hpp"

namespace scintray::simulation::detail {

const tally::HistorySubjects* subjects_of(const SimulationPoint& point) {
  return point.plan().history ? &point.plan().history->subjects() : nullptr;
}

RunHooks passing_on(const SimulationPoint& point, const Renumbering& renumbering, std::size_t number,
                    ResultSink& sink) {
  const tally::HistorySubjects* subjects = subjects_of(point);
  RunHooks run;
  if (point.spec().run.photon_list)
    run.detected = [&](const std::vector<tally::DetectedPhoton>& photons) {
      sink.photons(renumbering.applied(photons));
    };
  if (subjects)
    run.histories = [&sink, subjects](const tally::PhotonHistories& histories) {
      sink.histories(histories, *subjects);
    };
  if (point.source().has_energy())
    run.events = [&](const std::vector<tally::EventRecord>& events) {
      sink.events(renumbering.applied(events));
    };
  run.range = [&, of = PointRange{number, {}, point.facts(), subjects}](const tally::BlockRange& blocks,
                                                                        tally::PointSums sums) {
    PointRange range = of;
    range.blocks = blocks;
    sink.range(range, renumbering.applied(std::move(sums)));
  };
  return run;
}

void begin_events(const SimulationPoint& point, const Renumbering& renumbering, std::size_t number,
                  ResultSink& sink) {
  if (!point.source().has_energy()) return;
  sink.begin_events(number, renumbering.applied(point.plan().channels.list), point.spec().readout);
}

}  // namespace scintray::simulation::detail
