#pragma once
/// The records of files of block ranges and of shards of response maps, and their members in the order of the
/// file.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scintray/simulation/detail/byte_archive.hpp"
#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation::detail {

/// Kinds of records. Those of a range end with its `range`.
enum class Record : std::uint8_t {
  outline = 1,
  surfaces,
  readout,
  subjects,
  photons,
  histories,
  events,
  range,
  end,
  paths,
  piece  ///< of a response map
};

/// First bytes of a file, and the version of its layout after them.
inline constexpr std::string_view kMagic = "ScintRay block ranges\n";
inline constexpr std::uint32_t kRangesVersion = 6;
/// Of a record: its kind and the number of its bytes before them, their CRC-32 and those of both after.
inline constexpr std::size_t kRecordHead = 1 + sizeof(std::uint64_t), kRecordTail = sizeof(std::uint32_t);

template <typename A>
void exchange(A& a, core::InputFile& v) {
  pass(a, v.name, v.sha256);
}
template <typename A>
void exchange(A& a, core::FileLocation& v) {
  std::int64_t line = v.line, column = v.column;
  pass(a, v.file, line, column);
  v.line = static_cast<long>(line);
  v.column = static_cast<long>(column);
}
template <typename A>
void exchange(A& a, core::Estimate& v) {
  pass(a, v.value, v.error);
}
template <typename A>
void exchange(A& a, tally::ReflectorSite& v) {
  pass(a, v.surface, v.stack, v.reflector);
}
template <typename A>
void exchange(A& a, tally::TracedRange& v) {
  pass(a, v.least, v.most);
}
template <typename A>
void exchange(A& a, tally::HistorySubjects& v) {
  pass(a, v.media, v.absorption_per_mm, v.reflectors, v.reflectance, v.transmitting, v.gap_media);
}
template <typename A>
void exchange(A& a, tally::PhotonHistories& v) {
  pass(a, v.point, v.event, v.photon, v.path_mm, v.absorption_depth, v.reflections, v.reflection_depth);
}
template <typename A>
void exchange(A& a, results::HistoryColumns& v) {
  pass(a, v.media, v.reflectors, v.transmitting, v.gap_media);
}
template <typename A>
void exchange(A& a, tally::RunHeader& v) {
  pass(a, v.title, v.version, v.scene_file, v.scene_text, v.seed, v.sweep_keys, v.media, v.surfaces, v.parts,
       v.faces, v.note);
}
template <typename A>
void exchange(A& a, PointOutline& v) {
  pass(a, v.parameters, v.work, v.blocks, v.max_interactions, v.max_time_ns);
}
template <typename A>
void exchange(A& a, results::PhotonListLayout& v) {
  pass(a, v.columns, v.every, v.channels);
}
template <typename A>
void exchange(A& a, RunOutline& v) {
  pass(a, v.header, v.photon_list, v.photons, v.paths, v.histories, v.has_energy, v.points, v.inputs);
}
template <typename A>
void exchange(A& a, Shard& v) {
  pass(a, v.number, v.of);
}
template <typename A>
void exchange(A& a, tally::ReadoutChannel& v) {
  pass(a, v.name, v.part, v.sensor, v.face, v.position, v.normal, v.x, v.y, v.width_mm, v.height_mm,
       v.area_mm2);
}
template <typename A>
void exchange(A& a, detector::ReadoutSpec& v) {
  pass(a, v.period_ns, v.before_ns, v.window_ns, v.gate_ns, v.shaping_ns, v.noise, v.adc_bits, v.adc_range);
  pass(a, v.time_pickoff, v.threshold, v.fraction, v.delay_ns, v.pulses, v.photon_order, v.where);
}
template <typename A>
void exchange(A& a, tally::PathStep& v) {
  pass(a, v.position, v.time_ns, v.wavelength_nm, v.text);
}
template <typename A>
void exchange(A& a, tally::PhotonPath& v) {
  pass(a, v.event, v.photon, v.fate, v.steps);
}
template <typename A>
void exchange(A& a, tally::ChannelRecord& v) {
  pass(a, v.detected, v.first_ns, v.charge, v.amplitude, v.time_ns, v.order_ns, v.waveform);
}
template <typename A>
void exchange(A& a, tally::EventRecord& v) {
  pass(a, v.point, v.event, v.energy_keV, v.escaped_keV, v.non_scintillating_keV, v.position_mm, v.part,
       v.emitted, v.detected, v.channels);
}
template <typename A>
void exchange(A& a, optics::DecayComponent& v) {
  pass(a, v.decay_ns, v.rise_ns, v.fraction);
}
template <typename A>
void exchange(A& a, tally::LightTiming& v) {
  pass(a, v.decay, v.time_spread_ns);
}
template <typename A>
void exchange(A& a, tally::OmittedEffect& v) {
  pass(a, v.effect, v.subject, v.remedy, v.in_resolution, v.in_timing, v.in_fraction);
}
template <typename A>
void exchange(A& a, tally::PointFacts& v) {
  pass(a, v.light_timing, v.omitted, v.birth_efficiency);
}
template <typename A>
void exchange(A& a, tally::EventShare& v) {
  pass(a, v.squares, v.products);
}
template <typename A>
void exchange(A& a, tally::SensorFaceCount& v) {
  pass(a, v.part, v.face, v.detected, v.not_detected, v.events_detected, v.events_not_detected,
       v.events_both);
}
template <typename A>
void exchange(A& a, tally::MomentSums& v) {
  pass(a, v.count, v.sum, v.sum_of_squares);
}
template <typename A>
void exchange(A& a, tally::PhotonMomentSums& v) {
  pass(a, v.photons, v.events, v.count_squares, v.squares, v.products);
}
template <typename A>
void exchange(A& a, tally::ShiftSums& v) {
  pass(a, v.absorbed, v.emitted, v.additional, v.before_eV, v.after_eV, v.kept_eV);
}
template <typename A>
void exchange(A& a, tally::EnergySums& v) {
  pass(a, v.events, v.silent, v.started, v.deposited, v.escaped, v.non_scintillating, v.detected);
}
template <typename A>
void exchange(A& a, tally::TallyAxis& v) {
  pass(a, v.variable, v.unit, v.edges, v.names, v.along);
}
template <typename A>
void exchange(A& a, tally::TallySums& v) {
  tally::TallyResult& tally = v.empty;
  pass(a, tally.name, tally.type, tally.score, tally.unit, tally.faces, tally.detected_only, tally.axes,
       tally.index, v.outside);
  exchange_sparse(a, v.counts);
  exchange_sparse(a, v.count_squares);
  exchange_sparse(a, v.sums);
  exchange_sparse(a, v.sum_squares);
  exchange_sparse(a, v.event_count_squares);
  exchange_sparse(a, v.event_count_products);
  exchange_sparse(a, v.event_squares);
  exchange_sparse(a, v.event_products);
  exchange_sparse(a, v.group_counts);
}
template <typename A>
void exchange(A& a, tally::EventFates& v) {
  pass(a, v.events);
  for (auto& row : v.products) pass(a, row);
}
template <typename A>
void exchange(A& a, tally::PointSums& v) {
  tally::PointResult& c = v.counts;
  pass(a, c.emitted, c.photons, c.fates, c.absorbed_in_medium, c.absorbed_at_surface, c.events_in_medium,
       c.events_at_surface, c.sensor_faces, c.detected_path_histogram, c.scatterings, c.segments,
       c.resolved_misses, c.wall_seconds, c.event_fates);
  pass(a, v.shifted_in_medium, v.shifted_at_surface, v.interactions, v.detected_path_mm, v.detected_time_ns,
       v.detected_interactions, v.energy, v.tallies);
}
template <typename A>
void exchange(A& a, tally::BlockRange& v) {
  pass(a, v.first, v.last);
}
template <typename A>
void exchange(A& a, analysis::SamplePlace& v) {
  pass(a, v.surface, v.inside, v.outside, v.wavelength_nm);
}
template <typename A>
void exchange(A& a, optics::IndexPair& v) {
  pass(a, v.inside, v.outside);
}
template <typename A>
void exchange(A& a, analysis::GoniometerSettings& v) {
  pass(a, v.side, v.incidence_rad, v.wavelength_nm, v.rays, v.seed, v.stream, v.profile_half_width_rad);
}
template <typename A>
void exchange(A& a, analysis::DirectionCounts& v) {
  const std::size_t cells = v.cells.size(), bins = v.profile.size();
  pass(a, v.cells, v.profile);
  if constexpr (A::kReads)
    if (v.cells.size() != cells || v.profile.size() != bins) throw Undecodable();
}
template <typename A>
void exchange(A& a, analysis::Lobe& v) {
  pass(a, v.rays, v.in_plane_rad, v.across_rad, v.width_in_plane, v.width_across);
}
template <typename A>
void exchange(A& a, analysis::GoniometerReading& v) {
  pass(a, v.settings, v.reflected, v.transmitted, v.absorbed, v.reflected_directions,
       v.transmitted_directions, v.reflected_lobe, v.transmitted_lobe);
}
template <typename A>
void exchange(A& a, analysis::SurfaceAnalysis& v) {
  pass(a, v.goniometer, v.place, v.index, v.rays, v.incidence_rad, v.reflectance, v.slope_rad, v.directions);
}

}  // namespace scintray::simulation::detail
