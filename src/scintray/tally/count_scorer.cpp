#include "scintray/tally/count_scorer.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/tally/detail/face_axes.hpp"

namespace scintray::tally {

namespace {

bool among(const std::vector<bool>& set, core::PartId part) { return set.empty() || set[part_slot(part)]; }

double azimuth(const core::Vec3& direction, const core::Vec3& normal) {
  const auto [x, y] = face_axes(normal);
  return std::atan2(direction.dot(y), direction.dot(x));
}

double sine_squared(const core::Vec3& direction, const core::Vec3& normal) {
  const double cosine = direction.dot(normal);
  return std::max(0.0, 1.0 - cosine * cosine);
}

double angle(const core::Vec3& direction, const core::Vec3& normal) {
  return std::acos(std::min(1.0, std::abs(direction.dot(normal))));
}

}  // namespace

void CountScorer::start(const source::Photon& photon) {
  start_ = photon.position;
  direction_before_ = photon.ray.direction;
  source_part_ = scene_.regions[photon.region].part;
  crossings_ = 0;
  visited_.assign(plan_.follows_regions ? 1 : 0, photon.region);
  Moment moment{core::StepEvent::emitted, photon, source_part_};
  happened(moment, nullptr);
}

void CountScorer::step(const source::Photon& photon, const transport::Step& step) {
  Moment moment{step.event, photon, scene_.regions[photon.region].part};
  if (photon.region != step.region) {
    ++crossings_;
    if (plan_.follows_regions) visited_.push_back(photon.region);
  }
  if (step.event == core::StepEvent::detected || step.event == core::StepEvent::not_detected)
    moment.part = step.sensor_part;
  happened(moment, &step);
  direction_before_ = photon.ray.direction;
  if (core::is_final(step.event)) end(step.event);
}

void CountScorer::cut(const source::Photon& photon, core::Fate fate) {
  Moment moment{fate, photon, scene_.regions[photon.region].part};
  happened(moment, nullptr);
  end(fate);
}

void CountScorer::happened(Moment& moment, const transport::Step* step) {
  for (const std::uint32_t number : plan_.counts_on[static_cast<std::size_t>(moment.event)])
    score(number, moment);
  if (!step || step->triangle == scene::kNoTriangle) return;
  const auto& at_face = plan_.counts_at[step->interface][step->from_back];
  if (at_face.empty()) return;
  const scene::Region& region = scene_.regions[step->region];
  const core::Vec3 outward = scene_.normal(region, step->triangle);
  for (const TallyPlan::CountAtFace& count : at_face) {
    if ((plan_.events_of[count.count] >> static_cast<unsigned>(moment.event) & 1u) == 0) continue;
    moment.face = count.face;
    moment.normal = count.inwards ? core::Vec3(-outward) : outward;
    score(count.count, moment);
  }
}

double CountScorer::value(scene_file::TallyVariable variable, const core::Vec3& along,
                          const Moment& moment) const {
  const source::Photon& photon = moment.photon;
  switch (variable) {
    case scene_file::TallyVariable::wavelength:
      return photon.wavelength_nm;
    case scene_file::TallyVariable::time:
      return photon.time_ns;
    case scene_file::TallyVariable::path:
      return photon.path_mm;
    case scene_file::TallyVariable::interactions:
      return photon.interactions;
    case scene_file::TallyVariable::scatterings:
      return photon.scatterings;
    case scene_file::TallyVariable::crossings:
      return crossings_;
    case scene_file::TallyVariable::position:
      return along.dot(photon.position.vec());
    case scene_file::TallyVariable::start:
      return along.dot(start_);
    case scene_file::TallyVariable::direction:
      return along.dot(photon.ray.direction.vec());
    case scene_file::TallyVariable::angle_before:
      return angle(direction_before_, moment.normal);
    case scene_file::TallyVariable::angle_after:
      return angle(photon.ray.direction, moment.normal);
    case scene_file::TallyVariable::sin2_before:
      return sine_squared(direction_before_, moment.normal);
    case scene_file::TallyVariable::sin2_after:
      return sine_squared(photon.ray.direction, moment.normal);
    case scene_file::TallyVariable::azimuth_before:
      return azimuth(direction_before_, moment.normal);
    case scene_file::TallyVariable::azimuth_after:
      return azimuth(photon.ray.direction, moment.normal);
    default:
      throw core::InternalError(std::string("the number ") + scene_file::tally_variable_name(variable) +
                                " is a name");
  }
}

bool CountScorer::accepts(const CountRequest& count, const Moment& moment) const {
  if (!among(count.parts, moment.part) || !among(count.source_parts, source_part_)) return false;
  return std::all_of(count.ranges.begin(), count.ranges.end(), [&](const CountRange& range) {
    const double x = value(range.variable, range.along, moment);
    return x >= range.low && x < range.high;
  });
}

std::uint32_t CountScorer::bin_of(const CountRequest& count, const Moment& moment, bool& named) const {
  std::uint32_t bin = 0;
  bool inside = true;
  for (const CountAxis& axis : count.axes) {
    bin *= axis.bins;
    if (scene_file::is_category(axis.variable)) {
      const std::size_t slot = axis.variable == scene_file::TallyVariable::event
                                   ? static_cast<std::size_t>(moment.event)
                               : axis.variable == scene_file::TallyVariable::face ? moment.face.index()
                               : axis.variable == scene_file::TallyVariable::part ? part_slot(moment.part)
                                                                                  : part_slot(source_part_);
      const BinId name = axis.bin_of[slot];
      if (!name.has_value()) {
        named = false;
        return Contribution::kOutside;
      }
      bin += name.index();
      continue;
    }
    double position = (value(axis.variable, axis.along, moment) - axis.low) * axis.per_bin;
    if (axis.to_the_edge || scene_file::needs_face(axis.variable))  // ends that nothing can lie beyond
      position = std::clamp(position, 0.0, std::nextafter(static_cast<double>(axis.bins), 0.0));
    if (position >= 0.0 && position < axis.bins)
      bin += static_cast<std::uint32_t>(position);
    else
      inside = false;
  }
  return inside ? bin : Contribution::kOutside;
}

void CountScorer::score(std::uint32_t number, const Moment& moment) {
  const CountRequest& count = plan_.counts[number];
  if (!accepts(count, moment)) return;
  bool named = true;
  const std::uint32_t bin = bin_of(count, moment, named);
  if (!named) return;
  const double what = count.score ? value(*count.score, core::Vec3::Zero(), moment) : 1.0;
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
  std::stable_sort(pending_.begin(), pending_.end(), [](const Contribution& a, const Contribution& b) {
    return a.count != b.count ? a.count < b.count : a.bin < b.bin;
  });
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

void add_contributions(const std::vector<Contribution>& contributions, std::vector<TallyResult>& total) {
  for (const Contribution& c : contributions) {
    TallyResult& tally = total[c.count];
    if (c.bin == Contribution::kOutside) {
      tally.outside += c.score;
      continue;
    }
    tally.sum[c.bin] += c.score;
    tally.sum_of_squares[c.bin] += c.score * c.score;
  }
}

}  // namespace scintray::tally
