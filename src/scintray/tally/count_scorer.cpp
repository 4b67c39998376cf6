#include "scintray/tally/count_scorer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scintray::tally {

namespace {

bool among(const std::vector<bool>& set, core::PartId part) {
  return set.empty() || set[scene_file::place_of(part)];
}

bool before_in_order(const Contribution& a, const Contribution& b) {
  return a.count != b.count ? a.count < b.count : a.bin < b.bin;
}

}  // namespace

CountScorer::CountScorer(const scene::Scene& scene, const TallyPlan& plan) : scene_(scene), plan_(plan) {
  view_.direction_before.setConstant(std::numeric_limits<double>::quiet_NaN());
}

void CountScorer::start(const source::Photon& photon) {
  const core::PartId part = scene_.regions[photon.region].part;
  view_.start = photon.position;
  view_.source_part = part;
  view_.crossings = 0;
  if (plan_.follows_reflections) view_.direction_before = photon.ray.direction;
  visited_.assign(plan_.follows_regions ? 1 : 0, photon.region);
  score_anywhere(photon, core::StepEvent::emitted, part);
}

void CountScorer::step(const source::Photon& photon, const transport::Step& step) {
  if (photon.region != step.region) {
    ++view_.crossings;
    if (plan_.follows_regions) visited_.push_back(photon.region);
  }
  if (plan_.counts_event(step.event)) score_step(photon, step);
  if (plan_.follows_reflections) view_.direction_before = photon.ray.direction;
  if (core::is_final(step.event)) end(step.event);
}

void CountScorer::score_step(const source::Photon& photon, const transport::Step& step) {
  const bool at_sensor =
      step.event == core::StepEvent::detected || step.event == core::StepEvent::not_detected;
  const core::PartId part = at_sensor ? step.sensor_part : scene_.regions[photon.region].part;
  score_anywhere(photon, step.event, part);
  if (step.triangle != scene::kNoTriangle) score_at_faces(photon, step, part);
}

void CountScorer::cut(const source::Photon& photon, core::Fate fate) {
  score_anywhere(photon, fate, scene_.regions[photon.region].part);
  end(fate);
}

void CountScorer::look_at(const source::Photon& photon, core::StepEvent event, core::PartId part) {
  view_.event = event;
  view_.wavelength_nm = photon.wavelength_nm;
  view_.time_ns = photon.time_ns;
  view_.path_mm = photon.path_mm;
  view_.interactions = photon.interactions;
  view_.scatterings = photon.scatterings;
  view_.position = photon.position;
  view_.direction = photon.ray.direction;
  view_.part = part;
}

void CountScorer::score_anywhere(const source::Photon& photon, core::StepEvent event, core::PartId part) {
  const std::vector<std::uint32_t>& counts = plan_.counts_on[static_cast<std::size_t>(event)];
  if (counts.empty()) return;
  look_at(photon, event, part);
  for (const std::uint32_t number : counts) score(number);
}

void CountScorer::score_at_faces(const source::Photon& photon, const transport::Step& step,
                                 core::PartId part) {
  const auto& at_faces = plan_.counts_at[step.interface][step.from_back];
  const auto counts = [&](const TallyPlan::CountAtFace& at) {
    return (plan_.events_of[at.count] >> static_cast<unsigned>(step.event) & 1u) != 0;
  };
  if (std::none_of(at_faces.begin(), at_faces.end(), counts)) return;
  look_at(photon, step.event, part);
  view_.cos_before = step.cos_before;
  const core::Vec3 outward = scene_.normal_at(scene_.regions[step.region], step.triangle, photon.position);
  for (const TallyPlan::CountAtFace& at : at_faces) {
    if (!counts(at)) continue;
    view_.face = at.face;
    view_.normal = at.inwards ? core::Vec3(-outward) : outward;
    score(at.count);
  }
}

bool CountScorer::accepts(const CountRequest& count) const {
  if (!among(count.parts, view_.part) || !among(count.source_parts, view_.source_part)) return false;
  return std::all_of(count.ranges.begin(), count.ranges.end(), [&](const CountRange& range) {
    const double x = range.variable->number(view_, range.along);
    return x >= range.low && x < range.high;
  });
}

std::uint32_t CountScorer::bin_of(const CountRequest& count, bool& named) const {
  std::uint32_t bin = 0;
  bool inside = true;
  for (const CountAxis& axis : count.axes) {
    bin *= axis.bins;
    if (axis.variable->is_name()) {
      const BinId of_name = axis.bin_of[axis.variable->place(view_)];
      if (!of_name.has_value()) {
        named = false;
        return Contribution::kOutside;
      }
      bin += of_name.index();
      continue;
    }
    double position = (axis.variable->number(view_, axis.along) - axis.low) * axis.per_bin;
    if (axis.ends_low) position = std::max(position, 0.0);
    if (axis.ends_high) position = std::min(position, std::nextafter(static_cast<double>(axis.bins), 0.0));
    if (position >= 0.0 && position < axis.bins)
      bin += static_cast<std::uint32_t>(position);
    else
      inside = false;
  }
  return inside ? bin : Contribution::kOutside;
}

void CountScorer::score(std::uint32_t number) {
  const CountRequest& count = plan_.counts[number];
  if (!accepts(count)) return;
  bool named = true;
  const std::uint32_t bin = bin_of(count, named);
  if (!named) return;
  const double what = count.score ? count.score->number(view_, core::Vec3::Zero()) : 1.0;
  if (count.each != scene_file::TallyEach::time) {
    const auto known = std::find_if(pending_.begin(), pending_.end(),
                                    [&](const Contribution& c) { return c.count == number; });
    if (known != pending_.end()) {
      if (count.each == scene_file::TallyEach::last) *known = {number, bin, what};
      return;
    }
  }
  pending_.push_back({number, bin, what});
}

void CountScorer::end(core::Fate fate) {
  const auto keeps = [&](const Contribution& c) {
    const CountRequest& count = plan_.counts[c.count];
    const auto seen = [&](const core::IdVector<core::RegionId, bool>& set) {
      return std::any_of(visited_.begin(), visited_.end(),
                         [&](core::RegionId region) { return set[region]; });
    };
    if (count.fates != 0 && (count.fates >> static_cast<unsigned>(fate) & 1u) == 0) return false;
    if (!count.visited.empty() && !seen(count.visited)) return false;
    return count.not_visited.empty() || !seen(count.not_visited);
  };
  if (!std::is_sorted(pending_.begin(), pending_.end(), before_in_order))
    std::stable_sort(pending_.begin(), pending_.end(), before_in_order);
  const std::size_t first = contributions_.size();
  for (const Contribution& c : pending_) {
    if (!keeps(c)) continue;
    if (contributions_.size() > first && contributions_.back().count == c.count &&
        contributions_.back().bin == c.bin)
      contributions_.back().score += c.score;
    else
      contributions_.push_back(c);
  }
  pending_.clear();
}

void add_contributions(const std::vector<Contribution>& contributions, std::vector<TallySums>& total) {
  for (const Contribution& c : contributions) {
    TallySums& tally = total[c.count];
    if (c.bin == Contribution::kOutside)
      tally.add_outside(c.score);
    else
      tally.add(c.bin, c.score);
  }
}

void add_event(std::vector<Contribution> contributions, std::uint64_t event, std::uint64_t photons,
               std::vector<TallySums>& total) {
  // Stable, so that scores are summed in the order of photons.
  std::stable_sort(contributions.begin(), contributions.end(), before_in_order);
  for (auto first = contributions.begin(); first != contributions.end();) {
    double score = 0.0;
    auto last = first;
    for (; last != contributions.end() && !before_in_order(*first, *last); ++last) score += last->score;
    if (first->bin != Contribution::kOutside)
      total[first->count].add_event(first->bin, score, event, photons);
    first = last;
  }
}

}  // namespace scintray::tally
