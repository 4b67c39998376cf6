#include "scintray/analysis/event_analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "scintray/analysis/position/detail/depth_slices.hpp"
#include "scintray/core/error.hpp"

namespace scintray::analysis {

namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kLeastTimed = 50, kLeastPlane = 4;
constexpr const char* kNoDepthAxis = "[analysis] states no direction of depth";
constexpr const char* kTooFewSlices = ": too few events for two slices of depth";

core::Vec3 to_vec(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

double earliest(double a, double b) { return std::isnan(a) ? b : std::isnan(b) ? a : std::min(a, b); }

/// Runs an analysis; where the events do not allow it, records the reason.
void attempt(const std::string& name, EventAnalysis& analysis, const std::function<void()>& action) {
  try {
    action();
  } catch (const core::InputError& error) {
    analysis.left_out.push_back(name + ": " + error.problems().front().what);
  }
}

template <typename Row, typename Member>
std::vector<double> column(const std::vector<const Row*>& rows, Member member) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const Row* row : rows) values.push_back(static_cast<double>(row->*member));
  return values;
}

}  // namespace

EventCollector::EventCollector(AnalysisSetup setup) : setup_(std::move(setup)), orders_(setup_.photon_order) {
  if (setup_.depth && std::abs(setup_.depth->direction.norm() - 1.0) > 1e-6)
    throw std::invalid_argument("the direction of depth does not have unit length");
  layout_ = layout_of(setup_.channels_mm, setup_.depth);
  if (!layout_) return;
  plane_channels_ = layout_->far.size() > layout_->near.size() ? layout_->far : layout_->near;
  if (plane_channels_.size() < kLeastPlane) plane_channels_.clear();
  for (const std::size_t channel : plane_channels_)
    plane_mm_.push_back(layout_->across(setup_.channels_mm[channel]));
}

void EventCollector::add_light(const tally::EventRecord& event, Row& row) const {
  const auto light = [&](std::size_t channel) {
    return tally::light_of(event.channels[channel], has_readout_);
  };
  for (std::size_t i = 0; i < event.channels.size(); ++i) row.light += light(i);
  if (!layout_) return;
  for (const std::size_t i : layout_->near) row.near_light += static_cast<float>(light(i));
  for (const std::size_t i : layout_->far) row.far_light += static_cast<float>(light(i));
  if (plane_channels_.empty()) return;
  std::vector<double> plane;
  for (const std::size_t channel : plane_channels_) plane.push_back(light(channel));
  if (const auto at = anger_position(plane, plane_mm_, setup_.anger))
    row.across_mm = {static_cast<float>((*at)[0]), static_cast<float>((*at)[1])};
}

void EventCollector::add_times(const tally::EventRecord& event, Row& row) const {
  const auto time = [&](std::size_t channel) {
    const tally::ChannelRecord& record = event.channels[channel];
    return static_cast<double>(has_readout_ ? record.time_ns : record.first_ns);
  };
  row.time_ns = row.first_ns = kNoNumber;
  for (std::size_t i = 0; i < event.channels.size(); ++i) {
    row.time_ns = earliest(row.time_ns, time(i));
    row.first_ns = earliest(row.first_ns, event.channels[i].first_ns);
  }
  if (!layout_) return;
  double near = kNoNumber, far = kNoNumber;
  for (const std::size_t i : layout_->near) near = earliest(near, time(i));
  for (const std::size_t i : layout_->far) far = earliest(far, time(i));
  row.end_difference_ns = near - far;
}

void EventCollector::add(const tally::EventRecord& event) {
  if (event.channels.size() != setup_.channels_mm.size())
    throw core::InputError(
        core::Problem{{},
                      fmt::format("event {} has {} readout channels; expected {}", event.event,
                                  event.channels.size(), setup_.channels_mm.size()),
                      "read events and channels from one results file"});
  if (events_++ == 0 && !event.channels.empty()) has_readout_ = !std::isnan(event.channels.front().charge);
  Row row;
  row.across_mm = {kNoNumber, kNoNumber};
  row.end_difference_ns = kNoNumber;
  const bool placed = setup_.depth && event.part.has_value();
  row.depth_mm = placed ? static_cast<float>(setup_.depth->depth_mm(to_vec(event.position_mm))) : kNoNumber;
  row.part = event.part;
  for (const tally::ChannelRecord& channel : event.channels) row.detected += channel.detected;
  add_light(event, row);
  if (event.energy_keV > 0.0F) {
    light_of_energy_.add(event.energy_keV, row.light);
    if (row.part.has_value()) light_of_energy_in_[row.part].add(event.energy_keV, row.light);
  }
  if (!(row.light > 0.0)) return;
  add_times(event, row);
  rows_.push_back(row);
  if (!orders_.empty()) orders_.add(event);
}

Photopeak EventCollector::peak_of(const std::vector<double>& light) const {
  Photopeak peak = fit_photopeak(light, setup_.photopeak);
  core::Estimate& pulses = peak.fit.events;
  // The fit takes the number of pulses as random; here it is a share of events whose number was set.
  const double square =
      pulses.error * pulses.error - pulses.value * pulses.value / static_cast<double>(events_);
  constexpr double kHalfAPulse = 0.5;  // where all events are in the peak, or none
  pulses.error = std::sqrt(std::max(kHalfAPulse, square));
  return peak;
}

std::vector<double> EventCollector::analyze_peak(EventAnalysis& analysis) const {
  std::vector<double> light;
  light.reserve(rows_.size());
  for (const Row& row : rows_) light.push_back(row.light);
  analysis.mean_light = mean_of(light);
  analysis.light_per_keV = light_of_energy_.ratio();
  analysis.peak = peak_of(light);
  return light;
}

void EventCollector::analyze_light(EventAnalysis& analysis) const {
  std::vector<double> depths;
  for (const Row& row : rows_) depths.push_back(row.depth_mm);
  const std::vector<double> light = analyze_peak(analysis);
  analysis.spectrum = automatic_histogram(light);
  // Bins made for the whole spectrum may be as wide as its peak.
  const double fine = analysis.peak.has_numbers() ? analysis.peak.fit.model.sigma / 3.0 : 0.0;
  if (analysis.spectrum && fine > 0.0 && fine < analysis.spectrum->width)
    analysis.spectrum =
        make_histogram_of_width(light, analysis.spectrum->low, analysis.spectrum->high(), fine);
  analyze_parts(analysis);
  analyze_depth(depths, light, analysis);
}

void EventCollector::analyze_parts(EventAnalysis& analysis) const {
  std::map<core::PartId, std::vector<double>> light_of;
  for (const Row& row : rows_)
    if (row.part.has_value()) light_of[row.part].push_back(row.light);
  for (const auto& [id, light] : light_of) {
    PartLight part;
    part.part = id;
    part.pulses = light.size();
    part.mean_light = mean_of(light);
    if (const auto ratio = light_of_energy_in_.find(id); ratio != light_of_energy_in_.end())
      part.light_per_keV = ratio->second.ratio();
    part.spectrum = automatic_histogram(light);
    part.peak = peak_of(light);
    analysis.parts.push_back(std::move(part));
  }
}

void EventCollector::analyze_depth(const std::vector<double>& depths, const std::vector<double>& light,
                                   EventAnalysis& analysis) const {
  // Without an axis there are none, and dark counts have no position.
  const std::vector<double> known = sorted_finite(depths);
  if (known.empty()) {
    analysis.left_out.push_back("light against depth: " +
                                (setup_.depth ? "no pulse has a position" : std::string(kNoDepthAxis)));
    return;
  }
  analysis.mean_depth_mm = mean_of(known);
  const std::vector<DepthPoint> points = depth_points(depths, light, setup_.slices);
  const bool spread = std::all_of(points.begin(), points.end(),
                                  [](const DepthPoint& point) { return point.value.error > 0.0; });
  if (known.front() == known.back())
    analysis.left_out.emplace_back("light against depth: the events lie at one depth");
  else if (points.size() < 2)
    analysis.left_out.emplace_back("light against depth: too few events for two slices of depth");
  else if (!spread)
    analysis.left_out.emplace_back(
        "light against depth: the light does not fluctuate, so that it has no errors");
  else
    analysis.light_against_depth = depth_curve(points, 0.5 * (known.front() + known.back()));
}

std::vector<const EventCollector::Row*> EventCollector::select(EventAnalysis& analysis) const {
  const bool by_peak = setup_.photopeak_only && analysis.peak.locates_peak();
  const double centre = analysis.peak.fit.model.position,
               reach = core::kFwhmPerSigma * analysis.peak.fit.model.sigma;
  std::vector<const Row*> rows;
  for (const Row& row : rows_)
    if (!by_peak || std::abs(row.light - centre) <= reach) rows.push_back(&row);
  analysis.selected = rows.size();
  analysis.selection = by_peak ? "pulses within one FWHM of the photopeak" : "all pulses";
  return rows;
}

void EventCollector::analyze_flood(const std::vector<const Row*>& rows, EventAnalysis& analysis) const {
  if (plane_channels_.empty()) {
    if (layout_)
      analysis.left_out.push_back(
          fmt::format("flood map: {} readout channels in the plane with the most; {} are needed",
                      std::max(layout_->near.size(), layout_->far.size()), kLeastPlane));
    return;
  }
  analysis.across_x = layout_->across_x;
  analysis.across_y = layout_->across_y;
  std::vector<std::array<double, 2>> positions;
  std::vector<core::PartId> parts;
  for (const Row* row : rows) {
    if (std::isnan(row->across_mm[0]) || !row->part.has_value()) continue;
    positions.push_back({row->across_mm[0], row->across_mm[1]});
    parts.push_back(row->part);
  }
  FloodOptions options = setup_.flood;
  if (!options.expected) {
    std::vector<core::PartId> parts_hit = parts;
    std::sort(parts_hit.begin(), parts_hit.end());
    options.expected =
        static_cast<std::size_t>(std::unique(parts_hit.begin(), parts_hit.end()) - parts_hit.begin());
  }
  attempt("flood map", analysis, [&] { analysis.flood = flood_map(positions, parts, options); });
  if (!analysis.flood || setup_.layer_of_part.empty()) return;
  const FloodMap& flood = *analysis.flood;
  std::vector<std::size_t> truth, assigned;
  std::size_t layers = 0;
  for (const auto& [part, layer] : setup_.layer_of_part) layers = std::max(layers, layer + 1);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto of_event = setup_.layer_of_part.find(parts[i]);
    const core::PartId owner = flood.crystals[flood.peaks[flood.peak_of(positions[i])].owner];
    const auto of_owner = setup_.layer_of_part.find(owner);
    if (of_event == setup_.layer_of_part.end() || of_owner == setup_.layer_of_part.end()) continue;
    truth.push_back(of_event->second);
    assigned.push_back(of_owner->second);
  }
  analysis.layers_by_flood = confusion_of(truth, assigned, layers);
}

void EventCollector::analyze_ends(const std::vector<const Row*>& rows, EventAnalysis& analysis) const {
  if (!layout_) return;
  if (layout_->far.empty()) {
    analysis.left_out.emplace_back(
        "depth of interaction: the readout channels are at one end; the light of two ends is needed");
    return;
  }
  std::vector<double> ratios, layer_ratios;
  std::vector<std::size_t> layer;
  for (const Row* row : rows) {
    ratios.push_back(end_ratio(setup_.ratio, row->near_light, row->far_light));
    const auto found = setup_.layer_of_part.find(row->part);
    if (found == setup_.layer_of_part.end() || std::isnan(ratios.back())) continue;
    layer.push_back(found->second);
    layer_ratios.push_back(ratios.back());
  }
  if (setup_.depth)
    attempt("depth of interaction", analysis, [&] {
      analysis.doi =
          analyze_doi(column(rows, &Row::depth_mm), ratios, setup_.ratio, setup_.calibration, setup_.slices);
    });
  else
    analysis.left_out.push_back(std::string("depth of interaction: ") + kNoDepthAxis);
  std::vector<std::size_t> evens;
  for (std::size_t i = 0; i < layer.size(); i += 2) evens.push_back(layer[i]);
  std::sort(evens.begin(), evens.end());
  evens.erase(std::unique(evens.begin(), evens.end()), evens.end());
  const std::size_t layers = layer.empty() ? 0 : *std::max_element(layer.begin(), layer.end()) + 1;
  if (layers > 1 && evens.size() == layers)
    analysis.layers_by_ratio = classify_layers(layer, layer_ratios, layers);
}

void EventCollector::analyze_timing(const std::vector<const Row*>& rows, EventAnalysis& analysis) const {
  const std::vector<double> times = column(rows, &Row::time_ns);
  const std::vector<double> pairs = paired_differences(times);
  if (pairs.size() < kLeastTimed) {
    analysis.left_out.push_back(
        fmt::format("timing: {} pairs of events with times; {} are needed", pairs.size(), kLeastTimed));
    return;
  }
  analysis.pair_difference_ns = spread_of(pairs);
  if (has_readout_)
    analysis.first_photon_difference_ns = spread_of(paired_differences(column(rows, &Row::first_ns)));
  const Spread ends = spread_of(column(rows, &Row::end_difference_ns));
  if (ends.count >= kLeastTimed)
    analysis.end_difference_ns = ends;
  else if (layout_ && !layout_->far.empty())
    analysis.left_out.push_back(fmt::format(
        "time between the ends: {} events with a time at both ends; {} are needed", ends.count, kLeastTimed));
  if (!setup_.depth) {
    analysis.left_out.push_back(std::string("timing against depth: ") + kNoDepthAxis);
    return;
  }
  const TimingDepth timing = timing_against_depth(column(rows, &Row::depth_mm), times, setup_.slices);
  if (timing.slices.size() > 1)
    analysis.timing_against_depth = timing;
  else
    analysis.left_out.push_back(std::string("timing against depth") + kTooFewSlices);
}

void EventCollector::analyze_photon_orders(const std::vector<const Row*>& rows,
                                           EventAnalysis& analysis) const {
  if (orders_.empty()) return;
  std::vector<std::size_t> events;
  for (const Row* row : rows) events.push_back(static_cast<std::size_t>(row - rows_.data()));
  const std::vector<OrderTimes> times = orders_.times(events);
  OrderAnalysis orders = analyze_orders(times);
  if (orders.single.empty()) {
    analysis.left_out.emplace_back("timing by order of photons: too few events have that many photons");
    return;
  }
  const std::vector<double> detected = column(rows, &Row::detected);
  const auto bound = [&](double photons, const OrderAnalysis& of) {
    return setup_.light_timing ? timing_bound(*setup_.light_timing, photons, of.single) : std::nullopt;
  };
  analysis.orders_bound = bound(mean_of(detected).value, orders);
  analysis.orders = std::move(orders);
  if (!setup_.depth) return;
  std::vector<OrderSlice> slices =
      orders_against_depth(column(rows, &Row::depth_mm), times, detected, setup_.slices);
  if (slices.size() < 2) {
    analysis.left_out.push_back(std::string("timing by order of photons against depth") + kTooFewSlices);
    return;
  }
  for (const OrderSlice& slice : slices) analysis.depth_bounds.push_back(bound(slice.photons, slice.orders));
  analysis.orders_against_depth = std::move(slices);
}

EventAnalysis EventCollector::counted() const {
  EventAnalysis analysis;
  analysis.events = events_;
  analysis.pulses = rows_.size();
  analysis.has_readout = has_readout_;
  return analysis;
}

EventAnalysis EventCollector::finish() const {
  EventAnalysis analysis = counted();
  analyze_light(analysis);
  if (!layout_) {
    std::string reason = ": there are no readout channels";
    if (!setup_.channels_mm.empty()) {
      reason = ": the readout channels are neither in one plane nor at two ends";
      if (!setup_.depth) reason += std::string(", and ") + kNoDepthAxis;
    }
    for (const char* name : {"flood map", "depth of interaction"}) analysis.left_out.push_back(name + reason);
  }
  const std::vector<const Row*> rows = select(analysis);
  analyze_flood(rows, analysis);
  analyze_ends(rows, analysis);
  analyze_timing(rows, analysis);
  analyze_photon_orders(rows, analysis);
  return analysis;
}

EventAnalysis EventCollector::finish_figures() const {
  EventAnalysis analysis = counted();
  analyze_peak(analysis);
  analyze_timing(select(analysis), analysis);
  return analysis;
}

std::string reason_left_out(const EventAnalysis& analysis, const std::string& name) {
  for (const std::string& line : analysis.left_out)
    if (line.rfind(name + ": ", 0) == 0) return line.substr(name.size() + 2);
  return "";
}

EventAnalysis analyze_events(std::span<const tally::EventRecord> events, const AnalysisSetup& setup) {
  EventCollector collector(setup);
  for (const tally::EventRecord& event : events) collector.add(event);
  return collector.finish();
}

std::optional<DepthPoint> depth_point(const EventAnalysis& analysis) {
  if (!analysis.mean_depth_mm || analysis.pulses == 0) return std::nullopt;
  const bool peak = analysis.peak.locates_peak();
  return DepthPoint{analysis.mean_depth_mm->value, analysis.pulses,
                    peak ? analysis.peak.fit.position : analysis.mean_light, peak};
}

}  // namespace scintray::analysis
