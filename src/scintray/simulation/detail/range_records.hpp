#pragma once
/// The content of a file of block ranges as bytes: one function for each type serves writer and reader.
///
/// Numbers are stored as they are in memory, the least significant byte first, so that all bits return.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scintray/simulation/range_file.hpp"

namespace scintray::simulation::detail {

static_assert(std::endian::native == std::endian::little, "files of block ranges are little-endian");

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
  end
};

/// First bytes of a file, and the version of its layout after them.
inline constexpr std::string_view kMagic = "ScintRay block ranges\n";
inline constexpr std::uint32_t kRangesVersion = 2;
/// Of a record: its kind and the number of its bytes before them, their CRC-32 and those of both after.
inline constexpr std::size_t kRecordHead = 1 + sizeof(std::uint64_t), kRecordTail = sizeof(std::uint32_t);

/// Thrown for bytes that are not what was written. Not seen outside of the reader.
struct Undecodable {};

/// Writer of values as bytes.
class Encoder {
 public:
  static constexpr bool kReads = false;

  template <typename T>
  void plain(T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <typename T>
  void plain_list(std::vector<T>& values) {
    std::uint64_t count = values.size();
    plain(count);
    bytes.append(reinterpret_cast<const char*>(values.data()), count * sizeof(T));
  }
  void text(std::string& value) {
    std::uint64_t count = value.size();
    plain(count);
    bytes.append(value);
  }

  std::string bytes;
};

/// Reader of values. @throws Undecodable
class Decoder {
 public:
  static constexpr bool kReads = true;

  explicit Decoder(std::string_view bytes) : left_(bytes) {}

  template <typename T>
  void plain(T& value) {
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
  }
  template <typename T>
  void plain_list(std::vector<T>& values) {
    std::uint64_t count = 0;
    plain(count);
    if (count > left_.size() / sizeof(T)) throw Undecodable();
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), take(count * sizeof(T)).data(), count * sizeof(T));
  }
  void text(std::string& value) {
    std::uint64_t count = 0;
    plain(count);
    value = take(count);
  }
  bool at_end() const { return left_.empty(); }

 private:
  std::string_view take(std::uint64_t count) {
    if (count > left_.size()) throw Undecodable();
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }
  std::string_view left_;
};

// exchange(archive, value) writes or reads one value; pass(archive, values...) several, in the order of the
// file.

template <typename A, typename... T>
void pass(A& archive, T&... values);

template <typename A, typename T>
requires std::is_arithmetic_v<T>
void exchange(A& archive, T& value) { archive.plain(value); }

template <typename A>
void exchange(A& archive, bool& value) {
  std::uint8_t byte = value ? 1 : 0;
  archive.plain(byte);
  value = byte != 0;
}

template <typename A, typename T>
requires std::is_enum_v<T>
void exchange(A& archive, T& value) {
  auto number = static_cast<std::int32_t>(value);
  archive.plain(number);
  value = static_cast<T>(number);
}

template <typename A>
void exchange(A& archive, std::string& value) {
  archive.text(value);
}

template <typename A, typename Tag>
void exchange(A& archive, core::Id<Tag>& id) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t index = id.has_value() ? id.index() : kNone;
  archive.plain(index);
  id = index == kNone ? core::Id<Tag>() : core::Id<Tag>(index);
}

template <typename A>
void exchange(A& archive, core::Vec3& value) {
  pass(archive, value.x(), value.y(), value.z());
}

template <typename A, typename T, std::size_t N>
void exchange(A& archive, std::array<T, N>& values) {
  for (T& value : values) pass(archive, value);
}

template <typename A, typename T>
void exchange(A& archive, std::vector<T>& values) {
  if constexpr (std::is_arithmetic_v<T>) {
    archive.plain_list(values);
  } else {
    std::uint64_t count = values.size();
    archive.plain(count);
    if constexpr (A::kReads) {
      values.clear();  // each takes a byte or more, so that a wrong count ends with the bytes
      for (std::uint64_t i = 0; i < count; ++i) pass(archive, values.emplace_back());
    } else {
      for (T& value : values) pass(archive, value);
    }
  }
}

template <typename A, typename IdType, typename T>
void exchange(A& archive, core::IdVector<IdType, T>& values) {
  std::vector<T> list = values.values();
  pass(archive, list);
  if constexpr (A::kReads) values = core::IdVector<IdType, T>(std::move(list));
}

template <typename A, typename T>
void exchange(A& archive, std::optional<T>& value) {
  bool has = value.has_value();
  pass(archive, has);
  if constexpr (A::kReads) {
    value.reset();
    if (has) value.emplace();
  }
  if (has) pass(archive, *value);
}

/// Words most of which may be zero: numbers of zeros and of others in turns, the others in full.
template <typename A>
void exchange_sparse(A& archive, std::vector<std::uint64_t>& words) {
  constexpr std::uint64_t kMostWords = 80'000'000;  // of two words of four for each bin of the largest tally
  std::uint64_t count = words.size();
  archive.plain(count);
  if constexpr (A::kReads) {
    if (count > kMostWords) throw Undecodable();
    words.clear();
  }
  for (std::uint64_t at = 0; at < count;) {
    std::uint64_t zeros = 0;
    std::vector<std::uint64_t> others;
    if constexpr (!A::kReads) {
      while (at + zeros < count && words[at + zeros] == 0) ++zeros;
      for (std::uint64_t k = at + zeros; k < count && words[k] != 0; ++k) others.push_back(words[k]);
    }
    pass(archive, zeros, others);
    if constexpr (A::kReads) {
      const std::uint64_t left = count - at;
      if (zeros > left || others.size() > left - zeros || zeros + others.size() == 0) throw Undecodable();
      words.resize(at + zeros, 0);
      words.insert(words.end(), others.begin(), others.end());
    }
    at += zeros + others.size();
  }
}

template <typename A>
void exchange(A& archive, core::ExactSum& sum) {
  core::ExactSum::Words words = sum.words();
  pass(archive, words);
  sum = core::ExactSum::from_words(words);
}

template <typename A>
void exchange_sparse(A& archive, std::vector<core::ExactSum>& sums) {
  std::vector<std::uint64_t> words;
  for (const core::ExactSum& sum : sums) words.insert(words.end(), sum.words().begin(), sum.words().end());
  exchange_sparse(archive, words);
  if constexpr (A::kReads) {
    if (words.size() % 4 != 0) throw Undecodable();
    sums.clear();
    for (std::size_t i = 0; i < words.size(); i += 4)
      sums.push_back(core::ExactSum::from_words({words[i], words[i + 1], words[i + 2], words[i + 3]}));
  }
}

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
void exchange(A& a, RunOutline& v) {
  pass(a, v.header, v.photon_list, v.histories, v.has_energy, v.points, v.inputs);
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
void exchange(A& a, tally::DetectedPhoton& v) {
  pass(a, v.point, v.event, v.photon, v.part, v.face, v.position_mm, v.direction, v.wavelength_nm, v.time_ns,
       v.path_mm, v.interactions);
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
void exchange(A& a, tally::SensorFaceCount& v) {
  pass(a, v.part, v.face, v.detected, v.not_detected);
}
template <typename A>
void exchange(A& a, tally::MomentSums& v) {
  pass(a, v.count, v.sum, v.sum_of_squares);
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
}
template <typename A>
void exchange(A& a, tally::PointSums& v) {
  tally::PointResult& c = v.counts;
  pass(a, c.emitted, c.photons, c.fates, c.absorbed_in_medium, c.absorbed_at_surface, c.sensor_faces,
       c.detected_path_histogram, c.scatterings, c.segments, c.resolved_misses, c.wall_seconds);
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

template <typename A, typename... T>
void pass(A& archive, T&... values) {
  (exchange(archive, values), ...);
}

/// Bytes of values.
template <typename... T>
std::string encoded(const T&... values) {
  Encoder encoder;
  pass(encoder, const_cast<T&>(values)...);  // an Encoder only reads them
  return std::move(encoder.bytes);
}

}  // namespace scintray::simulation::detail
