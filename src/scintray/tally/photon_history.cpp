#include "scintray/tally/photon_history.hpp"

#include <algorithm>

namespace scintray::tally {

namespace {

/// Extremes of a piecewise linear curve over [low, high].
TracedRange range_of(const core::Curve& curve, double low, double high) {
  const double first = curve(low), last = curve(high);
  TracedRange range{std::min(first, last), std::max(first, last)};
  for (std::size_t i = 0; i < curve.x().size(); ++i) {
    if (curve.x()[i] <= low || curve.x()[i] >= high) continue;
    range.least = std::min(range.least, curve.y()[i]);
    range.most = std::max(range.most, curve.y()[i]);
  }
  return range;
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// Absorption coefficient (1/mm) of a medium without re-emission, as in transport: that of a wavelength
/// shifter is not included.
double absorption_per_mm(const scene::Scene& scene, core::MediumId medium, double wavelength_nm) {
  const double all_per_mm = scene.optics.at(medium, wavelength_nm).absorption_per_mm;
  return scene.optics.media[medium].shifts
             ? std::max(0.0, all_per_mm - scene.optics.shifting_at(medium, wavelength_nm))
             : all_per_mm;
}

}  // namespace

HistoryPlan::HistoryPlan(const scene::Scene& scene) {
  add_media(scene);
  for (const optics::Surface& surface : scene.surfaces) add_surface(scene, surface, surface.definition);
}

void HistoryPlan::add_media(const scene::Scene& scene) {
  core::IdVector<core::MediumId, HistoryColumn> column_of_medium(scene.media.size());
  for (const scene::Region& region : scene.regions) {
    HistoryColumn& column = column_of_medium[region.medium];
    const scene::SceneMedium& medium = scene.media[region.medium];
    // Absorption along a path in a birefringent medium depends on the light's mode: it is not in one column.
    if (!column.has_value() && !medium.is_opaque() && !medium.medium().birefringence) {
      column = HistoryColumn(subjects_.media.size());
      subjects_.media.push_back(medium.medium().name);
      subjects_.absorption_per_mm.push_back(
          range_of(medium.medium().absorption_per_mm, scene.low_nm, scene.high_nm));
    }
    column_of_region_.push_back(column);
  }
}

void HistoryPlan::add_surface(const scene::Scene& scene, const optics::Surface& surface,
                              const std::string& within) {
  for (const optics::SurfaceShare& share : surface.mixture) add_surface(scene, *share.surface, within);
  if (surface.gap_thickness_um && !surface.gap.empty()) add_once(subjects_.gap_media, surface.gap);
  if (!surface.reflector) return;
  if (surface.reflector->transmittance) {
    for (const std::string& name : {within, surface.definition, surface.reflector->name})
      add_once(subjects_.transmitting, name);
    return;
  }
  const ReflectorSite site{within, surface.definition, surface.reflector->name};
  const auto known = std::find(subjects_.reflectors.begin(), subjects_.reflectors.end(), site);
  column_of_reflector_[&*surface.reflector] = HistoryColumn(known - subjects_.reflectors.begin());
  if (known != subjects_.reflectors.end()) return;
  subjects_.reflectors.push_back(site);
  subjects_.reflectance.push_back(range_of(surface.reflector->reflectance, scene.low_nm, scene.high_nm));
}

HistoryRecorder::HistoryRecorder(const scene::Scene& scene, const HistoryPlan& plan)
    : scene_(scene),
      plan_(plan),
      path_in_mm_(plan.subjects().media.size()),
      depth_in_(plan.subjects().media.size()) {}

void HistoryRecorder::start(const source::Photon& emitted) {
  path_mm_ = emitted.path_mm;
  wavelength_nm_ = emitted.wavelength_nm;
  std::fill(path_in_mm_.begin(), path_in_mm_.end(), 0.0);
  std::fill(depth_in_.begin(), depth_in_.end(), 0.0);
}

void HistoryRecorder::step(const source::Photon& photon, const transport::Step& step) {
  const HistoryColumn column = plan_.column_of_region(step.region);
  const double segment_mm = photon.path_mm - path_mm_;
  if (column.has_value()) {
    const core::MediumId medium = scene_.regions[step.region].medium;
    path_in_mm_[column.index()] += segment_mm;
    depth_in_[column.index()] += segment_mm * absorption_per_mm(scene_, medium, wavelength_nm_);
  }
  path_mm_ = photon.path_mm;
  wavelength_nm_ = photon.wavelength_nm;  // changed at the end of the segment
}

void HistoryRecorder::keep(std::uint32_t point, std::uint64_t event, std::uint64_t photon,
                           const optics::ReflectionLog& survived) {
  kept_.point.push_back(point);
  kept_.event.push_back(event);
  kept_.photon.push_back(photon);
  for (const double path : path_in_mm_) kept_.path_mm.push_back(static_cast<float>(path));
  for (const double depth : depth_in_) kept_.absorption_depth.push_back(static_cast<float>(depth));
  const std::size_t first = kept_.reflections.size(), reflectors = plan_.subjects().reflectors.size();
  kept_.reflections.resize(first + reflectors);
  kept_.reflection_depth.resize(first + reflectors);
  for (const optics::ReflectionLog::Entry& entry : survived.entries()) {
    const HistoryColumn column = plan_.column_of(*entry.reflector);
    if (!column.has_value()) continue;
    const std::size_t at = first + column.index();
    kept_.reflections[at] += entry.count;
    kept_.reflection_depth[at] += static_cast<float>(entry.depth);
  }
}

}  // namespace scintray::tally
