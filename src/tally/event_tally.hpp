#pragma once
/// Records of events.

#include "scintray/source/light_source.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/tally_plan.hpp"

namespace scintray {

/// Gathers one event after the other.
class EventTally {
 public:
  EventTally(const Scene& scene, const TallyPlan& plan) : scene_(scene), plan_(plan) {}

  /// Begins an event.
  void begin(std::uint64_t event, std::uint32_t point, const EventLight& light);
  /// A photon of it that a sensor converted.
  void detected(std::uint32_t channel, const Photon& photon);
  /// Ends it.
  void end();

  const std::vector<EventRecord>& events() const { return events_; }
  /// Adds the events to the total of those before them.
  void add_to(EnergyBalance& total) const;

 private:
  const Scene& scene_;
  const TallyPlan& plan_;
  std::vector<EventRecord> events_;  ///< the last is under way
  EnergyBalance balance_;
};

}  // namespace scintray
