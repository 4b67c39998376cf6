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

core::Vec3 to_vec(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

double earliest(double a, double b) { return std::isnan(a) ? b : std::isnan(b) ? a : std::min(a, b); }

/// Runs a study; where the events do not allow it, says why.
void attempt(const std::string& name, EventStudy& study, const std::function<void()>& action) {
  try {
    action();
  } catch (const core::InputError& error) {
    study.left_out.push_back(name + ": " + error.problems().front().what);
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

EventCollector::EventCollector(StudySetup setup) : setup_(std::move(setup)), orders_(setup_.photon_order) {
  if (setup_.depth && std::abs(setup_.depth->direction.norm() - 1.0) > 1e-6)
    throw std::invalid_argument("the direction of depth has no unit length");
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
  const bool placed = setup_.depth && event.part != tally::EventRecord::kNoPart;
  row.depth_mm = placed ? static_cast<float>(setup_.depth->depth_mm(to_vec(event.position_mm))) : kNoNumber;
  row.part = event.part;
  for (const tally::ChannelRecord& channel : event.channels) row.detected += channel.detected;
  add_light(event, row);
  if (event.energy_keV > 0.0F) light_of_energy_.add(event.energy_keV, row.light);
  if (!(row.light > 0.0)) return;
  add_times(event, row);
  rows_.push_back(row);
  if (!orders_.empty()) orders_.add(event);
}

void EventCollector::study_light(EventStudy& study) const {
  std::vector<double> light, depths;
  for (const Row& row : rows_) {
    light.push_back(row.light);
    depths.push_back(row.depth_mm);
  }
  study.mean_light = mean_of(light);
  study.light_per_keV = light_of_energy_.ratio();
  study.spectrum = automatic_histogram(light);
  study.peak = fit_photopeak(light, setup_.photopeak);
  // Bins made for the whole spectrum may be as wide as its peak.
  const double fine = study.peak.has_numbers() ? study.peak.fit.model.sigma / 3.0 : 0.0;
  if (study.spectrum && fine > 0.0 && fine < study.spectrum->width)
    study.spectrum = make_histogram_of_width(light, study.spectrum->low, study.spectrum->high(), fine);
  study_depth(depths, light, study);
}

void EventCollector::study_depth(const std::vector<double>& depths, const std::vector<double>& light,
                                 EventStudy& study) const {
  // Without an axis there are none, and dark counts happened nowhere.
  const std::vector<double> known = sorted_finite(depths);
  if (known.empty()) return;
  study.mean_depth_mm = mean_of(known);
  const std::vector<DepthPoint> points = depth_points(depths, light, setup_.slices);
  const bool spread = std::all_of(points.begin(), points.end(),
                                  [](const DepthPoint& point) { return point.value.error > 0.0; });
  if (known.front() == known.back())
    study.left_out.emplace_back("light against depth: the events lie at one depth");
  else if (points.size() < 2)
    study.left_out.emplace_back("light against depth: too few events for two slices of depth");
  else if (!spread)
    study.left_out.emplace_back("light against depth: the light does not fluctuate, so it has no errors");
  else
    study.light_against_depth = depth_curve(points, 0.5 * (known.front() + known.back()));
}

std::vector<const EventCollector::Row*> EventCollector::select(EventStudy& study) const {
  const bool by_peak = setup_.photopeak_only && study.peak.locates_peak();
  const double centre = study.peak.fit.model.position,
               reach = core::kFwhmPerSigma * study.peak.fit.model.sigma;
  std::vector<const Row*> rows;
  for (const Row& row : rows_)
    if (!by_peak || std::abs(row.light - centre) <= reach) rows.push_back(&row);
  study.selected = rows.size();
  study.selection = by_peak ? "pulses within one FWHM of the photopeak" : "all pulses";
  return rows;
}

void EventCollector::study_flood(const std::vector<const Row*>& rows, EventStudy& study) const {
  if (plane_channels_.empty()) return;
  std::vector<std::array<double, 2>> positions;
  std::vector<std::uint32_t> parts;
  for (const Row* row : rows) {
    if (std::isnan(row->across_mm[0]) || row->part == tally::EventRecord::kNoPart) continue;
    positions.push_back({row->across_mm[0], row->across_mm[1]});
    parts.push_back(row->part);
  }
  FloodOptions options = setup_.flood;
  if (!options.expected) {
    std::vector<std::uint32_t> met = parts;
    std::sort(met.begin(), met.end());
    options.expected = static_cast<std::size_t>(std::unique(met.begin(), met.end()) - met.begin());
  }
  attempt("flood map", study, [&] { study.flood = flood_map(positions, parts, options); });
  if (!study.flood || setup_.layer_of_part.empty()) return;
  const FloodMap& flood = *study.flood;
  std::vector<std::size_t> truth, told;
  std::size_t layers = 0;
  for (const auto& [part, layer] : setup_.layer_of_part) layers = std::max(layers, layer + 1);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto of_event = setup_.layer_of_part.find(parts[i]);
    const std::uint32_t owner = flood.crystals[flood.peaks[flood.peak_of(positions[i])].owner];
    const auto of_owner = setup_.layer_of_part.find(owner);
    if (of_event == setup_.layer_of_part.end() || of_owner == setup_.layer_of_part.end()) continue;
    truth.push_back(of_event->second);
    told.push_back(of_owner->second);
  }
  study.layers_by_flood = confusion_of(truth, told, layers);
}

void EventCollector::study_ends(const std::vector<const Row*>& rows, EventStudy& study) const {
  if (!layout_ || layout_->far.empty()) return;
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
    attempt("depth of interaction", study, [&] {
      study.doi =
          study_doi(column(rows, &Row::depth_mm), ratios, setup_.ratio, setup_.calibration, setup_.slices);
    });
  std::vector<std::size_t> evens;
  for (std::size_t i = 0; i < layer.size(); i += 2) evens.push_back(layer[i]);
  std::sort(evens.begin(), evens.end());
  evens.erase(std::unique(evens.begin(), evens.end()), evens.end());
  const std::size_t layers = layer.empty() ? 0 : *std::max_element(layer.begin(), layer.end()) + 1;
  if (layers > 1 && evens.size() == layers) study.layers_by_ratio = tell_layers(layer, layer_ratios, layers);
}

void EventCollector::study_timing(const std::vector<const Row*>& rows, EventStudy& study) const {
  const std::vector<double> times = column(rows, &Row::time_ns);
  const std::vector<double> pairs = paired_differences(times);
  if (pairs.size() < kLeastTimed) {
    study.left_out.push_back(
        fmt::format("timing: {} pairs of events with times; {} are needed", pairs.size(), kLeastTimed));
    return;
  }
  study.pair_difference_ns = spread_of(pairs);
  if (has_readout_)
    study.first_photon_difference_ns = spread_of(paired_differences(column(rows, &Row::first_ns)));
  const Spread ends = spread_of(column(rows, &Row::end_difference_ns));
  if (ends.count >= kLeastTimed) study.end_difference_ns = ends;
  if (!setup_.depth) return;
  const TimingDepth timing = timing_against_depth(column(rows, &Row::depth_mm), times, setup_.slices);
  if (timing.slices.size() > 1) study.timing_against_depth = timing;
}

void EventCollector::study_photon_orders(const std::vector<const Row*>& rows, EventStudy& study) const {
  if (orders_.empty()) return;
  std::vector<std::size_t> events;
  for (const Row* row : rows) events.push_back(static_cast<std::size_t>(row - rows_.data()));
  const std::vector<OrderTimes> times = orders_.times(events);
  OrderStudy orders = study_orders(times);
  if (orders.single.empty()) {
    study.left_out.emplace_back("timing by order of photons: too few events have so many photons");
    return;
  }
  const std::vector<double> detected = column(rows, &Row::detected);
  const auto bound = [&](double photons, const OrderStudy& of) {
    return setup_.light_timing ? timing_bound(*setup_.light_timing, photons, of.single) : std::nullopt;
  };
  study.orders_bound = bound(mean_of(detected).value, orders);
  study.orders = std::move(orders);
  if (!setup_.depth) return;
  std::vector<OrderSlice> slices =
      orders_against_depth(column(rows, &Row::depth_mm), times, detected, setup_.slices);
  if (slices.size() < 2) return;
  for (const OrderSlice& slice : slices) study.depth_bounds.push_back(bound(slice.photons, slice.orders));
  study.orders_against_depth = std::move(slices);
}

EventStudy EventCollector::finish() const {
  EventStudy study;
  study.events = events_;
  study.pulses = rows_.size();
  study.has_readout = has_readout_;
  study_light(study);
  if (!layout_ && !setup_.channels_mm.empty())
    study.left_out.emplace_back(
        "flood map, depth of interaction: the channels lie neither in one plane nor at two ends");
  const std::vector<const Row*> rows = select(study);
  study_flood(rows, study);
  study_ends(rows, study);
  study_timing(rows, study);
  study_photon_orders(rows, study);
  return study;
}

EventStudy study_events(std::span<const tally::EventRecord> events, const StudySetup& setup) {
  EventCollector collector(setup);
  for (const tally::EventRecord& event : events) collector.add(event);
  return collector.finish();
}

std::optional<DepthPoint> depth_point(const EventStudy& study) {
  if (!study.mean_depth_mm || study.pulses == 0) return std::nullopt;
  const bool peak = study.peak.locates_peak();
  return DepthPoint{study.mean_depth_mm->value, study.pulses,
                    peak ? study.peak.fit.position : study.mean_light, peak};
}

}  // namespace scintray::analysis
