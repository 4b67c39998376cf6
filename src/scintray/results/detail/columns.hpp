#pragma once
/// Columns of a results file's tables (those of detected photons: results/photon_columns.hpp): events,
/// signals of channels, the channels, and wavelength shifting.

#include <cmath>

#include "scintray/optics/wavelength_shifter.hpp"
#include "scintray/results/photon_columns.hpp"
#include "scintray/tally/event_record.hpp"
#include "scintray/tally/photon_path.hpp"
#include "scintray/tally/readout_channels.hpp"
#include "scintray/tally/result.hpp"

namespace scintray::results::format {

/// A row of /events: an event without its channels, which are rows of /signals.
struct EventRow {
  tally::EventRecord event;
  std::uint64_t first_signal = 0;  ///< row of /signals
};

/// A row of /signals.
struct SignalRow {
  std::uint64_t event_row = 0;  ///< row of /events
  std::uint32_t channel = 0;    ///< number within the point
  tally::ChannelRecord signal;
};

template <typename Visit>
void for_each_column(const EventRow*, const Visit& visit) {
  visit(
      "point", [](auto& r) -> auto& { return r.event.point; });
  visit(
      "event", [](auto& r) -> auto& { return r.event.event; });
  visit(
      "energy_keV", [](auto& r) -> auto& { return r.event.energy_keV; });
  visit(
      "escaped_keV", [](auto& r) -> auto& { return r.event.escaped_keV; });
  visit(
      "unseen_keV", [](auto& r) -> auto& { return r.event.non_scintillating_keV; });
  visit(
      "mean_x_mm", [](auto& r) -> auto& { return r.event.position_mm[0]; });
  visit(
      "mean_y_mm", [](auto& r) -> auto& { return r.event.position_mm[1]; });
  visit(
      "mean_z_mm", [](auto& r) -> auto& { return r.event.position_mm[2]; });
  visit(
      "main_part", [](auto& r) -> auto& { return r.event.part; });
  visit(
      "photons_emitted", [](auto& r) -> auto& { return r.event.emitted; });
  visit(
      "photons_detected", [](auto& r) -> auto& { return r.event.detected; });
  visit(
      "first_signal", [](auto& r) -> auto& { return r.first_signal; });
}

template <typename Visit>
void for_each_column(const SignalRow*, const Visit& visit) {
  visit(
      "event_row", [](auto& r) -> auto& { return r.event_row; });
  visit(
      "channel", [](auto& r) -> auto& { return r.channel; });
  visit(
      "photons_detected", [](auto& r) -> auto& { return r.signal.detected; });
  visit(
      "first_ns", [](auto& r) -> auto& { return r.signal.first_ns; });
  visit(
      "charge", [](auto& r) -> auto& { return r.signal.charge; });
  visit(
      "amplitude", [](auto& r) -> auto& { return r.signal.amplitude; });
  visit(
      "pickoff_ns", [](auto& r) -> auto& { return r.signal.time_ns; });
}

/// A row of /paths: a path without its steps, which are rows of /path_steps.
struct PathRow {
  std::uint32_t point = 0;
  std::uint64_t event = 0, photon = 0;
  std::uint32_t fate = 0;        ///< index into /fate_names
  std::uint64_t first_step = 0;  ///< row of /path_steps
};

/// A row of /path_steps.
struct PathStepRow {
  std::uint64_t path_row = 0;  ///< row of /paths
  tally::PathStep step;
  std::uint32_t text = 0;  ///< index into /step_texts
};

template <typename Visit>
void for_each_column(const PathRow*, const Visit& visit) {
  visit(
      "point", [](auto& r) -> auto& { return r.point; });
  visit(
      "event", [](auto& r) -> auto& { return r.event; });
  visit(
      "photon", [](auto& r) -> auto& { return r.photon; });
  visit(
      "path_fate", [](auto& r) -> auto& { return r.fate; });
  visit(
      "first_step", [](auto& r) -> auto& { return r.first_step; });
}

template <typename Visit>
void for_each_column(const PathStepRow*, const Visit& visit) {
  visit(
      "path_row", [](auto& r) -> auto& { return r.path_row; });
  visit(
      "step_x_mm", [](auto& r) -> auto& { return r.step.position.x(); });
  visit(
      "step_y_mm", [](auto& r) -> auto& { return r.step.position.y(); });
  visit(
      "step_z_mm", [](auto& r) -> auto& { return r.step.position.z(); });
  visit(
      "step_ns", [](auto& r) -> auto& { return r.step.time_ns; });
  visit(
      "step_nm", [](auto& r) -> auto& { return r.step.wavelength_nm; });
  visit(
      "step_text", [](auto& r) -> auto& { return r.text; });
}

/// The numbers of a channel.
template <typename Visit>
void for_each_channel_number(const Visit& visit) {
  visit(
      "channel_x_mm", [](auto& c) -> auto& { return c.position.x(); });
  visit(
      "channel_y_mm", [](auto& c) -> auto& { return c.position.y(); });
  visit(
      "channel_z_mm", [](auto& c) -> auto& { return c.position.z(); });
  visit(
      "channel_normal_x", [](auto& c) -> auto& { return c.normal.x(); });
  visit(
      "channel_normal_y", [](auto& c) -> auto& { return c.normal.y(); });
  visit(
      "channel_normal_z", [](auto& c) -> auto& { return c.normal.z(); });
  visit(
      "channel_area_mm2", [](auto& c) -> auto& { return c.area_mm2; });
}

/// True when a channel has a signal in an event; other channels have no row.
inline bool has_signal(const tally::ChannelRecord& record) {
  return record.detected > 0 || !std::isnan(record.charge);  // NaN: no readout
}

/// Calls `visit(name, member)` for each column; `member` points to the field of ShiftCount that it holds.
template <typename Visit>
void for_each_shift_column(Visit&& visit) {
  visit("shifter_absorbed", &optics::ShiftCount::absorbed);
  visit("shifter_emitted", &optics::ShiftCount::emitted);
  visit("shifter_additional", &optics::ShiftCount::additional);
  visit("energy_before", &optics::ShiftCount::before_eV);
  visit("energy_after", &optics::ShiftCount::after_eV);
  visit("energy_kept", &optics::ShiftCount::kept_eV);
}

/// Calls `visit(name, member)` for each column of sums over events of the faces of sensors; `member(count)`
/// is a reference to its value.
template <typename Visit>
void for_each_face_event_column(const Visit& visit) {
  visit(
      "detected_event_squares", [](auto& c) -> auto& { return c.events_detected.squares; });
  visit(
      "detected_event_products", [](auto& c) -> auto& { return c.events_detected.products; });
  visit(
      "unconverted_event_squares", [](auto& c) -> auto& { return c.events_not_detected.squares; });
  visit(
      "unconverted_event_products", [](auto& c) -> auto& { return c.events_not_detected.products; });
  visit(
      "detected_unconverted_products", [](auto& c) -> auto& { return c.events_both; });
}

/// Columns of omitted effects; `member` points to the text, or to the truth value, that a column holds.
template <typename Visit>
void for_each_omission_text(Visit&& visit) {
  visit("effect", &tally::OmittedEffect::effect);
  visit("subject", &tally::OmittedEffect::subject);
  visit("remedy", &tally::OmittedEffect::remedy);
}
template <typename Visit>
void for_each_omission_figure(Visit&& visit) {
  visit("in_resolution", &tally::OmittedEffect::in_resolution);
  visit("in_timing", &tally::OmittedEffect::in_timing);
  visit("in_fraction", &tally::OmittedEffect::in_fraction);
}

}  // namespace scintray::results::format
