#pragma once
/// All analyses of the events of one point.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scintray/analysis/position/channel_layout.hpp"
#include "scintray/analysis/position/confusion.hpp"
#include "scintray/analysis/position/depth_curve.hpp"
#include "scintray/analysis/position/depth_of_interaction.hpp"
#include "scintray/analysis/position/flood_map.hpp"
#include "scintray/analysis/ratio.hpp"
#include "scintray/analysis/spectrum/histogram.hpp"
#include "scintray/analysis/spectrum/photopeak.hpp"
#include "scintray/analysis/timing/coincidence_timing.hpp"
#include "scintray/analysis/timing/event_orders.hpp"
#include "scintray/tally/event_record.hpp"

namespace scintray::analysis {

/// Setup of the analyses: quantities that are not in the events, and options.
struct AnalysisSetup {
  std::vector<core::Vec3> channels_mm;                ///< position of each readout channel, in order
  std::optional<DepthAxis> depth;                     ///< empty: no depth, no depth of interaction
  std::map<core::PartId, std::size_t> layer_of_part;  ///< for parts in layers: 0, 1, ...; else empty
  PhotopeakOptions photopeak;
  AngerOptions anger;
  FloodOptions flood;  ///< without `expected`: the number of parts with interactions
  EndRatio ratio = EndRatio::share;
  DoiCalibrationKind calibration = DoiCalibrationKind::monotone;
  std::size_t slices = 10;                         ///< of depth
  std::vector<std::uint64_t> photon_order;         ///< n of the n-th photon times of the events; empty: none
  std::optional<tally::LightTiming> light_timing;  ///< when set, bounds on timing are computed
  bool photopeak_only =
      true;  ///< flood map, depth of interaction and timing use the peak's events, if a fit locates it
};

/// Light of the events of one part, the part of their largest deposit.
struct PartLight {
  core::PartId part;
  std::uint64_t pulses = 0;
  core::Estimate mean_light;     ///< of pulses
  core::Estimate light_per_keV;  ///< light of the events over the energy deposited in scintillators
  std::optional<Histogram> spectrum;
  Photopeak peak;
};

struct EventAnalysis {
  std::uint64_t events = 0;    ///< of the point
  std::uint64_t pulses = 0;    ///< events with light in a channel
  std::uint64_t selected = 0;  ///< pulses in flood map, depth of interaction and timing
  bool has_readout = false;    ///< light is charge in photoelectrons and times are picked off; else photons
  std::string selection;       ///< description of those pulses

  std::optional<Histogram> spectrum;  ///< of the light of all channels together
  Photopeak peak;
  core::Estimate mean_light;     ///< of pulses
  core::Estimate light_per_keV;  ///< light of the events over the energy deposited in scintillators
  std::vector<PartLight> parts;  ///< by part; without pulses that have no part (dark counts)
  /// Directions of the axes of the flood map.
  core::Vec3 across_x = core::Vec3::UnitX(), across_y = core::Vec3::UnitY();
  std::optional<core::Estimate> mean_depth_mm;
  std::optional<DepthCurve> light_against_depth;  ///< the reference is the middle of the depths
  std::optional<DoiAnalysis> doi;
  std::optional<LayerAnalysis> layers_by_ratio;
  std::optional<Confusion> layers_by_flood;
  std::optional<FloodMap> flood;
  std::optional<Spread> pair_difference_ns;  ///< CTR: two such detectors, pick-off (first photon without)
  std::optional<Spread> first_photon_difference_ns;  ///< the same by the first photon
  std::optional<Spread> end_difference_ns;           ///< near end minus far end of one event
  std::optional<TimingDepth> timing_against_depth;
  std::optional<OrderAnalysis> orders;  ///< CTR by the n-th photon, with a readout that records their times
  std::optional<TimingBound> orders_bound;  ///< in step with `orders->single`
  std::vector<OrderSlice> orders_against_depth;
  std::vector<std::optional<TimingBound>> depth_bounds;  ///< in step with `orders_against_depth`
  /// "flood map: REASON", for each analysis that has no result: "light against depth", "flood map", "depth
  /// of interaction", "timing", "timing by order of photons".
  std::vector<std::string> left_out;
};

/// The reason why an analysis has no result; empty when it has one.
/// @param name  of the analysis, as in EventAnalysis::left_out
std::string reason_left_out(const EventAnalysis& analysis, const std::string& name);

/// Accumulator of events, which keeps 64 bytes of each, and 8 for each n-th photon.
class EventCollector {
 public:
  /// @throws std::invalid_argument when a direction has no unit length
  explicit EventCollector(AnalysisSetup setup);
  /// @throws InputError when the number of channels of the event differs from that of the setup
  void add(const tally::EventRecord& event);
  /// Sets AnalysisSetup::light_timing, where that is known after the events only.
  void set_light_timing(std::optional<tally::LightTiming> timing) { setup_.light_timing = std::move(timing); }
  EventAnalysis finish() const;
  /// Light, photopeak and timing only, without spectra and results by part or depth: for repeated evaluation
  /// during a run.
  EventAnalysis finish_figures() const;

 private:
  struct Row {
    double light = 0.0, time_ns = 0.0, first_ns = 0.0, end_difference_ns = 0.0;
    float depth_mm = 0.0F, near_light = 0.0F, far_light = 0.0F;
    std::array<float, 2> across_mm{};
    core::PartId part;
    std::uint32_t detected = 0;
  };
  void add_light(const tally::EventRecord& event, Row& row) const;
  void add_times(const tally::EventRecord& event, Row& row) const;
  /// The numbers of events and pulses only.
  EventAnalysis counted() const;
  /// Photopeak of the light of pulses; the error of its content is that of a share of all events.
  Photopeak peak_of(const std::vector<double>& light) const;
  /// Mean light, light per energy and photopeak. Returns the light of the pulses.
  std::vector<double> analyze_peak(EventAnalysis& analysis) const;
  void analyze_light(EventAnalysis& analysis) const;
  void analyze_parts(EventAnalysis& analysis) const;
  void analyze_depth(const std::vector<double>& depths, const std::vector<double>& light,
                     EventAnalysis& analysis) const;
  std::vector<const Row*> select(EventAnalysis& analysis) const;
  void analyze_flood(const std::vector<const Row*>& rows, EventAnalysis& analysis) const;
  void analyze_ends(const std::vector<const Row*>& rows, EventAnalysis& analysis) const;
  void analyze_timing(const std::vector<const Row*>& rows, EventAnalysis& analysis) const;
  void analyze_photon_orders(const std::vector<const Row*>& rows, EventAnalysis& analysis) const;

  AnalysisSetup setup_;
  std::optional<ChannelLayout> layout_;
  std::vector<std::array<double, 2>> plane_mm_;  ///< transverse positions of the channels of the flood map
  std::vector<std::size_t> plane_channels_;
  std::vector<Row> rows_;
  OrderCollector orders_;  ///< of the same events as `rows_`
  RatioOfSums light_of_energy_;
  std::map<core::PartId, RatioOfSums> light_of_energy_in_;  ///< by part
  std::uint64_t events_ = 0;
  bool has_readout_ = false;
};

/// Analysis of events in memory. Throws as EventCollector.
EventAnalysis analyze_events(std::span<const tally::EventRecord> events, const AnalysisSetup& setup);

/// The point of a sweep in a depth curve: mean depth, and the photopeak where a fit locates it, else the
/// mean light. Empty without a depth or without light.
std::optional<DepthPoint> depth_point(const EventAnalysis& analysis);

}  // namespace scintray::analysis
