#pragma once
/// Passing the blocks of a point on to a sink, with the ids of the run.

#include "scintray/simulation/result_sink.hpp"
#include "scintray/simulation/run_names.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::simulation::detail {

/// What histories of a point are of; null when none are kept.
const tally::HistorySubjects* subjects_of(const SimulationPoint& point);

/// Hooks that pass all of a point's blocks on.
/// @param point, renumbering, sink  must outlive the hooks
/// @param number                    of the point
RunHooks passing_on(const SimulationPoint& point, const Renumbering& renumbering, std::size_t number,
                    ResultSink& sink);

/// Passes the readout of a point's events on, where its source is of events.
void begin_events(const SimulationPoint& point, const Renumbering& renumbering, std::size_t number,
                  ResultSink& sink);

}  // namespace scintray::simulation::detail
