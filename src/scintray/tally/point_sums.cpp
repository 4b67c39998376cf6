#include "scintray/tally/point_sums.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/scene_file/tally.hpp"

namespace scintray::tally {

namespace {

template <typename Into, typename From>
void add_each(Into& into, const From& from) {
  auto more = from.begin();
  for (auto& value : into) value += *more++;
}

template <typename T>
void merge_each(std::vector<T>& into, const std::vector<T>& from) {
  for (std::size_t i = 0; i < into.size(); ++i) into[i].merge(from[i]);
}

/// The same where either may be empty, which means zeros.
void add_to_some(std::vector<std::uint64_t>& into, const std::vector<std::uint64_t>& from) {
  if (into.empty()) into.resize(from.size());
  if (!from.empty()) add_each(into, from);
}

template <typename T>
void merge_some(std::vector<T>& into, const std::vector<T>& from) {
  if (into.empty()) into.resize(from.size());
  if (!from.empty()) merge_each(into, from);
}

/// Adds the integers of a result.
void add_counts(PointResult& total, const PointResult& more) {
  total.emitted += more.emitted;
  total.photons += more.photons;
  add_each(total.fates, more.fates);
  total.event_fates += more.event_fates;
  add_each(total.absorbed_in_medium, more.absorbed_in_medium);
  add_each(total.absorbed_at_surface, more.absorbed_at_surface);
  add_each(total.events_in_medium, more.events_in_medium);
  add_each(total.events_at_surface, more.events_at_surface);
  for (std::size_t i = 0; i < total.sensor_faces.size(); ++i) {
    total.sensor_faces[i].detected += more.sensor_faces[i].detected;
    total.sensor_faces[i].not_detected += more.sensor_faces[i].not_detected;
    total.sensor_faces[i].events_detected += more.sensor_faces[i].events_detected;
    total.sensor_faces[i].events_not_detected += more.sensor_faces[i].events_not_detected;
    total.sensor_faces[i].events_both += more.sensor_faces[i].events_both;
  }
  add_each(total.detected_path_histogram, more.detected_path_histogram);
  total.scatterings += more.scatterings;
  total.segments += more.segments;
  total.resolved_misses += more.resolved_misses;
  total.wall_seconds += more.wall_seconds;
}

template <typename IdType>
core::IdVector<IdType, optics::ShiftCount> values(const core::IdVector<IdType, ShiftSums>& sums) {
  core::IdVector<IdType, optics::ShiftCount> values;
  for (const ShiftSums& sum : sums) values.push_back(sum.value());
  return values;
}

}  // namespace

void MomentSums::add(const core::Moments& block) {
  count += block.count;
  sum.add(block.sum);
  sum_of_squares.add(block.sum_of_squares);
}

void MomentSums::merge(const MomentSums& other) {
  count += other.count;
  sum.merge(other.sum);
  sum_of_squares.merge(other.sum_of_squares);
}

core::Moments MomentSums::value() const { return {count, sum.value(), sum_of_squares.value()}; }

void PhotonMomentSums::add(const core::Moments& block, bool is_event) {
  photons.add(block);
  if (!is_event || block.count == 0) return;
  ++events;
  count_squares += block.count * block.count;
  squares.add(block.sum * block.sum);
  products.add(block.sum * static_cast<double>(block.count));
}

void PhotonMomentSums::merge(const PhotonMomentSums& other) {
  photons.merge(other.photons);
  events += other.events;
  count_squares += other.count_squares;
  squares.merge(other.squares);
  products.merge(other.products);
}

PhotonMoments PhotonMomentSums::value() const {
  return {photons.value(), {events, count_squares, squares.value(), products.value()}};
}

void ShiftSums::add(const optics::ShiftCount& block) {
  absorbed += block.absorbed;
  emitted += block.emitted;
  additional += block.additional;
  before_eV.add(block.before_eV);
  after_eV.add(block.after_eV);
  kept_eV.add(block.kept_eV);
}

ShiftSums& ShiftSums::operator+=(const ShiftSums& other) {
  absorbed += other.absorbed;
  emitted += other.emitted;
  additional += other.additional;
  before_eV.merge(other.before_eV);
  after_eV.merge(other.after_eV);
  kept_eV.merge(other.kept_eV);
  return *this;
}

optics::ShiftCount ShiftSums::value() const {
  return {absorbed, emitted, additional, before_eV.value(), after_eV.value(), kept_eV.value()};
}

void EnergySums::add(const EnergyBalance& block) {
  events += block.events;
  silent += block.silent;
  started.add(block.started);
  deposited.add(block.deposited);
  escaped.add(block.escaped);
  non_scintillating.add(block.non_scintillating);
  detected.add(block.detected);
}

void EnergySums::merge(const EnergySums& other) {
  events += other.events;
  silent += other.silent;
  started.merge(other.started);
  deposited.merge(other.deposited);
  escaped.merge(other.escaped);
  non_scintillating.merge(other.non_scintillating);
  detected.merge(other.detected);
}

EnergyBalance EnergySums::value() const {
  EnergyBalance balance;
  balance.events = events;
  balance.silent = silent;
  balance.started = started.value();
  balance.deposited = deposited.value();
  balance.escaped = escaped.value();
  balance.non_scintillating = non_scintillating.value();
  balance.detected = detected.value();
  return balance;
}

TallySums::TallySums(const TallyResult& tally) : empty(tally), grouped_(tally.is_grouped()) {
  const std::size_t bins = empty.sum.size();
  if (empty.score == scene_file::kPhotonScore) {
    counts.assign(bins, 0);
    count_squares.assign(bins, 0);
  } else {
    sums.resize(bins);
    sum_squares.resize(bins);
  }
  empty.sum.clear();
  empty.sum_of_squares.clear();
}

void TallySums::add(std::size_t bin, double score) {
  if (counts.empty()) {
    sums[bin].add(score);
    sum_squares[bin].add(score * score);
    return;
  }
  const auto photons = static_cast<std::uint64_t>(score);
  counts[bin] += photons;
  count_squares[bin] += photons * photons;
}

void TallySums::add_outside(double score) { outside.add(score); }

void TallySums::add_event(std::size_t bin, double score, std::uint64_t event, std::uint64_t photons) {
  if (counts.empty()) {
    if (event_squares.empty()) {
      event_squares.resize(sums.size());
      event_products.resize(sums.size());
    }
    event_squares[bin].add(score * score);
    event_products[bin].add(score * static_cast<double>(photons));
    return;
  }
  if (event_count_squares.empty()) {
    event_count_squares.assign(counts.size(), 0);
    event_count_products.assign(counts.size(), 0);
  }
  const auto scored = static_cast<std::uint64_t>(score);
  event_count_squares[bin] += scored * scored;
  event_count_products[bin] += scored * photons;
  if (!grouped_) return;
  if (group_counts.empty()) group_counts.resize(kEventGroups * counts.size());
  group_counts[event % kEventGroups * counts.size() + bin] += scored;
}

void TallySums::merge(const TallySums& other) {
  add_each(counts, other.counts);
  add_each(count_squares, other.count_squares);
  merge_each(sums, other.sums);
  merge_each(sum_squares, other.sum_squares);
  add_to_some(event_count_squares, other.event_count_squares);
  add_to_some(event_count_products, other.event_count_products);
  merge_some(event_squares, other.event_squares);
  merge_some(event_products, other.event_products);
  add_to_some(group_counts, other.group_counts);
  outside.merge(other.outside);
}

TallyResult TallySums::value() const {
  TallyResult result = empty;
  result.sum.assign(counts.begin(), counts.end());
  result.sum_of_squares.assign(count_squares.begin(), count_squares.end());
  for (const core::ExactSum& sum : sums) result.sum.push_back(sum.value());
  for (const core::ExactSum& sum : sum_squares) result.sum_of_squares.push_back(sum.value());
  result.event_squares.assign(event_count_squares.begin(), event_count_squares.end());
  result.event_products.assign(event_count_products.begin(), event_count_products.end());
  for (const core::ExactSum& sum : event_squares) result.event_squares.push_back(sum.value());
  for (const core::ExactSum& sum : event_products) result.event_products.push_back(sum.value());
  result.group_sums.assign(group_counts.begin(), group_counts.end());
  result.outside = outside.value();
  return result;
}

void PointSums::add(const PointResult& block, bool is_event) {
  add_counts(counts, block);
  for (const core::MediumId id : shifted_in_medium.ids())
    shifted_in_medium[id].add(block.shifted_in_medium[id]);
  for (const core::SurfaceId id : shifted_at_surface.ids())
    shifted_at_surface[id].add(block.shifted_at_surface[id]);
  interactions.add(block.interactions, is_event);
  detected_path_mm.add(block.detected_path_mm, is_event);
  detected_time_ns.add(block.detected_time_ns, is_event);
  detected_interactions.add(block.detected_interactions, is_event);
}

void PointSums::merge(const PointSums& other) {
  add_counts(counts, other.counts);
  add_each(shifted_in_medium, other.shifted_in_medium);
  add_each(shifted_at_surface, other.shifted_at_surface);
  interactions.merge(other.interactions);
  detected_path_mm.merge(other.detected_path_mm);
  detected_time_ns.merge(other.detected_time_ns);
  detected_interactions.merge(other.detected_interactions);
  energy.merge(other.energy);
  merge_each(tallies, other.tallies);
}

bool PointSums::alike(const PointSums& other) const {
  const auto same_faces = [](const SensorFaceCount& a, const SensorFaceCount& b) {
    return a.part == b.part && a.face == b.face;
  };
  const auto same_tally = [](const TallySums& a, const TallySums& b) {
    return a.empty.name == b.empty.name && a.empty.type == b.empty.type && a.empty.score == b.empty.score &&
           a.counts.size() == b.counts.size() && a.sums.size() == b.sums.size();
  };
  return counts.absorbed_in_medium.size() == other.counts.absorbed_in_medium.size() &&
         counts.absorbed_at_surface.size() == other.counts.absorbed_at_surface.size() &&
         counts.events_in_medium.size() == other.counts.events_in_medium.size() &&
         counts.events_at_surface.size() == other.counts.events_at_surface.size() &&
         shifted_in_medium.size() == other.shifted_in_medium.size() &&
         shifted_at_surface.size() == other.shifted_at_surface.size() &&
         std::equal(counts.sensor_faces.begin(), counts.sensor_faces.end(), other.counts.sensor_faces.begin(),
                    other.counts.sensor_faces.end(), same_faces) &&
         std::equal(tallies.begin(), tallies.end(), other.tallies.begin(), other.tallies.end(), same_tally);
}

PointResult PointSums::result() const {
  PointResult result = counts;
  result.shifted_in_medium = values(shifted_in_medium);
  result.shifted_at_surface = values(shifted_at_surface);
  result.interactions = interactions.value();
  result.detected_path_mm = detected_path_mm.value();
  result.detected_time_ns = detected_time_ns.value();
  result.detected_interactions = detected_interactions.value();
  result.energy = energy.value();
  const EventCounts events = result.event_counts();
  for (const TallySums& tally : tallies) {
    result.tallies.push_back(tally.value());
    TallyResult& made = result.tallies.back();
    made.events = events;
    // No event scored in a tally whose sums are empty, but there were events.
    if (events.all > 0 && made.event_squares.empty()) {
      made.event_squares.assign(made.sum.size(), 0.0);
      made.event_products = made.event_squares;
      if (made.is_grouped()) made.group_sums.assign(kEventGroups * made.sum.size(), 0.0);
    }
  }
  return result;
}

}  // namespace scintray::tally
