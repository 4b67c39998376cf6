#include "scintray/source/detail/event_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "scintray/core/text.hpp"
#include "scintray/source/detail/scintillation.hpp"

namespace scintray::source {

namespace {

constexpr std::size_t kNamed = 5;

void name_first(std::vector<std::string>& named, const Hit& hit) {
  if (named.size() >= kNamed) return;
  named.push_back(fmt::format("row {} (event {}, at {:.6g}, {:.6g}, {:.6g} mm)", hit.row, hit.event,
                              hit.position.x(), hit.position.y(), hit.position.z()));
}

std::string first_of(const std::vector<std::string>& words, std::uint64_t all) {
  return core::list_of(words) + (all > words.size() ? ", ..." : "");
}

}  // namespace

HitsEventSource::HitsEventSource(const scene_file::HitsSpec& spec, std::uint64_t most,
                                 const scene::Scene& scene, bool cherenkov)
    : cherenkov_(cherenkov) {
  std::vector<Hit> hits = read_hits(spec);
  has_steps_ = std::any_of(hits.begin(), hits.end(), [](const Hit& hit) { return hit.step.has_value(); });
  report_.rows = hits.size();
  count_out_of_order(hits);
  std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.event < b.event; });
  bool any_seen = false;
  for (auto first = hits.begin(); first != hits.end() && (most == 0 || events_.size() < most);) {
    const auto last =
        std::find_if(first, hits.end(), [&](const Hit& hit) { return hit.event != first->event; });
    const double begin_ns = std::min_element(first, last, [](const Hit& a, const Hit& b) {
                              return a.time_ns < b.time_ns;
                            })->time_ns;
    events_.emplace_back();
    for (auto hit = first; hit != last; ++hit) {
      hit->time_ns -= begin_ns;
      add(*hit, scene);
    }
    any_seen = any_seen || !events_.back().deposits.empty();
    first = last;
  }
  if (any_seen) return;
  throw core::InputError({spec.where,
                          fmt::format("none of the {} hits of {} lies in a part that scintillates",
                                      report_.rows, origin_of_hits(spec)),
                          "check length_unit, and that both programs place the parts alike: " +
                              first_of(report_.first_outside, report_.outside)});
}

void HitsEventSource::count_out_of_order(const std::vector<Hit>& hits) {
  std::unordered_set<std::uint64_t> seen;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const bool follows = i > 0 && hits[i - 1].event == hits[i].event;
    if (seen.insert(hits[i].event).second || follows) continue;
    ++report_.out_of_order;
    name_first(report_.first_out_of_order, hits[i]);
  }
}

void HitsEventSource::add(const Hit& hit, const scene::Scene& scene) {
  // A step starts and ends at faces; its middle lies in the region.
  const core::Vec3 inside = hit.step ? core::Vec3(hit.position + 0.5 * hit.step->displacement) : hit.position;
  const core::RegionId region = scene.locate(inside);
  Event& event = events_.back();
  const bool radiates = cherenkov_ && hit.step && region != scene::kAmbientRegion &&
                        !scene.optics.is_opaque(scene.regions[region].medium);
  if (radiates && !scintillates(scene, region)) {
    // It may emit Cherenkov light, but no energy of it is a scintillator's.
    event.non_scintillating_keV += hit.energy_keV;
    event.deposits.push_back({hit.position, region, 0.0, hit.time_ns, hit.step});
  } else if (region == scene::kAmbientRegion) {
    ++report_.outside;
    name_first(report_.first_outside, hit);
    event.non_scintillating_keV += hit.energy_keV;
  } else {
    leave_energy(scene, {hit.position, region, hit.energy_keV, hit.time_ns, hit.step}, event);
  }
}

Event HitsEventSource::make(const scene::Scene&, std::uint64_t number, core::Rng&) const {
  return events_[number];
}

std::vector<std::string> HitsEventSource::notes() const {
  std::vector<std::string> notes;
  if (report_.outside > 0)
    notes.push_back(fmt::format("{} of {} hits lie outside every part and make no light: {}", report_.outside,
                                report_.rows, first_of(report_.first_outside, report_.outside)));
  if (report_.out_of_order > 0)
    notes.push_back(fmt::format("{} of {} hits came after hits of a later event, and were put to theirs: {}",
                                report_.out_of_order, report_.rows,
                                first_of(report_.first_out_of_order, report_.out_of_order)));
  return notes;
}

}  // namespace scintray::source
