#include "scintray/tally/block_tally.hpp"

#include <algorithm>

namespace scintray::tally {

namespace {

constexpr double kPathBin_mm = 10.0;

/// An empty result of the quantities that a block sums itself; contributions to counts are added to the total
/// one by one.
PointResult empty_block(const scene::Scene& scene, const TallyPlan& plan) {
  PointResult result;
  result.absorbed_in_medium.assign(scene.media.size(), 0);
  result.absorbed_at_surface.assign(scene.surfaces.size(), 0);
  result.events_in_medium.resize(scene.media.size());
  result.events_at_surface.resize(scene.surfaces.size());
  result.shifted_in_medium.resize(scene.media.size());
  result.shifted_at_surface.resize(scene.surfaces.size());
  result.sensor_faces = plan.sensor_face_names;
  return result;
}

/// Adds the numbers of photons of an event at each place to the sums over events.
void add_event_places(const PointResult& event, PointResult& total) {
  for (const core::MediumId medium : event.absorbed_in_medium.ids())
    total.events_in_medium[medium].add(event.absorbed_in_medium[medium], event.photons);
  for (const core::SurfaceId surface : event.absorbed_at_surface.ids())
    total.events_at_surface[surface].add(event.absorbed_at_surface[surface], event.photons);
  for (std::size_t i = 0; i < event.sensor_faces.size(); ++i) {
    const SensorFaceCount& at = event.sensor_faces[i];
    total.sensor_faces[i].events_detected.add(at.detected, event.photons);
    total.sensor_faces[i].events_not_detected.add(at.not_detected, event.photons);
    total.sensor_faces[i].events_both += at.detected * at.not_detected;
  }
}

}  // namespace

PointSums empty_sums(const scene::Scene& scene, const TallyPlan& plan) {
  PointSums sums;
  sums.counts = empty_block(scene, plan);
  sums.shifted_in_medium.resize(scene.media.size());
  sums.shifted_at_surface.resize(scene.surfaces.size());
  for (const CountRequest& count : plan.counts) sums.tallies.emplace_back(count.empty);
  return sums;
}

BlockTally::BlockTally(const scene::Scene& scene, const TallyPlan& plan)
    : plan_(plan), result_(empty_block(scene, plan)), records_(plan.history.has_value()) {
  if (!plan.counts.empty()) scorer_.emplace(scene, plan);
  if (plan.history) history_.emplace(scene, *plan.history);
}

void BlockTally::start(const source::Photon& emitted, std::uint64_t event, std::uint64_t photon) {
  start(event, photon);
  if (scorer_) scorer_->start(emitted);
  if (history_) history_->start(emitted);
}

void BlockTally::end(const source::Photon& photon, const transport::Step& step, std::uint32_t point) {
  count_step(step);
  if (scorer_) scorer_->step(photon, step);
  if (history_) history_->step(photon, step);
  switch (step.event) {
    case core::StepEvent::absorbed_in_medium:
      ++result_.absorbed_in_medium[step.medium];
      return finish(photon, core::Fate::absorbed_in_medium);
    case core::StepEvent::absorbed_at_surface:
      ++result_.absorbed_at_surface[step.surface];
      return finish(photon, core::Fate::absorbed_at_surface);
    case core::StepEvent::escaped:
      return finish(photon, core::Fate::escaped);
    case core::StepEvent::detected:
    case core::StepEvent::not_detected:
      break;
    default:
      return;  // not an end: the run then reports a photon without a fate
  }
  SensorFaceCount& at_face = result_.sensor_faces[plan_.sensor_faces[step.interface][step.from_back].index()];
  if (step.event == core::StepEvent::not_detected) {
    ++at_face.not_detected;
    return finish(photon, core::Fate::not_detected);
  }
  ++at_face.detected;
  result_.detected_path_mm.add(photon.path_mm);
  result_.detected_time_ns.add(photon.time_ns);
  result_.detected_interactions.add(photon.interactions);
  const auto last = result_.detected_path_histogram.size() - 1;
  ++result_.detected_path_histogram[std::min(last, static_cast<std::size_t>(photon.path_mm / kPathBin_mm))];
  if (history_) history_->keep(point, event_, photon_, records_.reflections());
  if (plan_.lists(step, event_, photon_)) {
    const core::PlainVec3 &p = photon.position, &d = photon.ray.direction;
    photons_.push_back({point,
                        event_,
                        photon_,
                        at_face.part,
                        at_face.face,
                        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())},
                        {static_cast<float>(d.x()), static_cast<float>(d.y()), static_cast<float>(d.z())},
                        static_cast<float>(photon.wavelength_nm),
                        static_cast<float>(photon.time_ns),
                        static_cast<float>(photon.path_mm),
                        photon.interactions});
  }
  finish(photon, core::Fate::detected);
}

void BlockTally::cut(const source::Photon& photon, core::Fate fate) {
  if (scorer_) scorer_->cut(photon, fate);
  finish(photon, fate);
}

void BlockTally::add_to(PointSums& total, bool is_event) const {
  total.add(result_, is_event);
  if (scorer_) add_contributions(scorer_->contributions(), total.tallies);
  if (!is_event) return;
  total.counts.event_fates.add(result_.fates);
  add_event_places(result_, total.counts);
  if (scorer_) add_event(scorer_->contributions(), event_, result_.photons, total.tallies);
}

void BlockTally::finish(const source::Photon& photon, core::Fate fate) {
  ++result_.photons;
  ++result_.fates[core::fate_index(fate)];
  result_.interactions.add(photon.interactions);
  result_.scatterings += photon.scatterings;
  for (const source::PhotonShifts& shifts : records_.shifts())
    (shifts.surface.has_value() ? result_.shifted_at_surface[shifts.surface]
                                : result_.shifted_in_medium[shifts.medium]) += shifts.count;
}

}  // namespace scintray::tally
