#pragma once
/// Events read from another program's list of hits.

#include <string>
#include <vector>

#include "scintray/source/detail/hits_file.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// What came of the rows of a list of hits.
struct HitsReport {
  std::uint64_t rows = 0;
  std::uint64_t outside = 0;       ///< hits in no part; their energy counts as non-scintillating
  std::uint64_t out_of_order = 0;  ///< hits of an event that came after hits of another; they join it
  std::vector<std::string> first_outside, first_out_of_order;  ///< the first few, by name
};

/// Events of a list of hits, in the order of their numbers there. Times count from an event's first hit.
/// Hits outside every part, and in parts that do not scintillate, count as non-scintillating. Immutable.
class HitsEventSource : public EventSource {
 public:
  /// @param most  events to take; 0 for all
  /// Throws InputError as read_hits_file does, and when no hit lies in a part that scintillates.
  HitsEventSource(const scene_file::HitsSpec& spec, std::uint64_t most, const scene::Scene& scene);

  std::uint64_t events() const override { return events_.size(); }
  Event make(const scene::Scene& scene, std::uint64_t number, core::Rng& rng) const override;

  const HitsReport& report() const { return report_; }
  /// The report in words; empty when all is well.
  std::vector<std::string> notes() const;

 private:
  void count_out_of_order(const std::vector<Hit>& hits);
  void add(const Hit& hit, const scene::Scene& scene);

  std::vector<Event> events_;
  HitsReport report_;
};

}  // namespace scintray::source
