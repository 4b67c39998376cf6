#include "scintray/transport/detail/lane_scene.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <new>

#include "scintray/optics/facet_laws.hpp"
#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/scene/total_reflection.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

using Micro = optics::LaneSurface::Micro;

static_assert(scene::kNeverTotal == kNoTotalReflection, "one number, where lanes include no scene");

/// A triangle that is on none of the faces at gaps.
constexpr std::uint32_t kNotAtGaps = std::numeric_limits<std::uint32_t>::max();

double state_of(Micro micro) {
  switch (micro) {
    case Micro::smooth:
      return lane_state::kSmooth;
    case Micro::facets:
      return lane_state::kFacets;
    case Micro::table:
      return lane_state::kTable;
    case Micro::painted:
      break;
  }
  return lane_state::kReflector;
}

void set_facets(const optics::FacetSurface& facets, LaneFaceOptics& face) {
  const optics::FacetLimits limits(facets.sigma_alpha_rad,
                                   facets.sampling == optics::FacetSampling::projected_area);
  face.sigma_rad = facets.sigma_alpha_rad;
  face.widest_rad = limits.widest_rad;
  face.sin_widest = limits.of_widest.sine;
  face.cos_widest = limits.of_widest.cosine;
  face.by_area = limits.by_area ? 1.0 : 0.0;
}

template <typename Record>
Record& record_at(std::vector<LaneRecord>& records, std::size_t place) {
  return *std::launder(reinterpret_cast<Record*>(&records[place]));
}

/// True when the surface and the media are the same at two links of regions of one medium.
bool are_alike(const scene::Scene& scene, const scene::BoundaryLink& a, const scene::BoundaryLink& b) {
  if (a.interface == b.interface) return a.from_back == b.from_back;
  const scene::Interface &at_a = scene.interfaces[a.interface], &at_b = scene.interfaces[b.interface];
  const scene::LinkSurface first = scene::first_surface(at_a, a.from_back),
                           other = scene::first_surface(at_b, b.from_back);
  return first.id == other.id && first.own == other.own && at_a.plain == at_b.plain &&
         at_a.gap_medium == at_b.gap_medium &&
         scene::absorbing_surface(scene, a) == scene::absorbing_surface(scene, b) &&
         a.smooth_to == b.smooth_to &&
         scene.regions[scene.behind(a)].medium == scene.regions[scene.behind(b)].medium;
}

}  // namespace

LaneScene::LaneScene(const scene::Scene& scene, const LaneKinds& kinds) : scene_(scene) {
  shapes_.resize(scene.accelerators.size());
  regions_.resize(scene.regions.size());
  const auto each = [&](const auto& act) {
    for (std::uint32_t i = 0; i < scene.regions.size(); ++i)
      if (kinds[core::RegionId(i)] == LaneKind::surfaces) act(core::RegionId(i));
  };
  each([&](core::RegionId id) { make_faces(id); });
  each([&](core::RegionId id) {
    if (scene.regions[id].unfolds) make_mirrors(regions_[id]);
  });
  each([&](core::RegionId id) {
    link_faces(id, kinds);
    LaneRegion& region = regions_[id].region;
    if (region.planes != nullptr) return;
    region.planes = any_planes().planes;
    region.box = any_planes().box;
    region.count = any_planes().count;
  });
  initial_ = initial_records();
  if (!has_one_wavelength()) return;
  AtWavelength at;
  set_wavelength(scene.low_nm, at);
  each([&](core::RegionId id) {
    for (LaneFace& face : regions_[id].faces)
      face.at_one = record_at<LaneFaceOptics>(at.records, face.optics);
  });
}

LaneRegion LaneScene::any_planes() const {
  static constexpr PlanePair kPlanes{};
  static constexpr LaneBoxPlaces kBox{};
  static constexpr LaneFace kFaces[2] = {};
  LaneRegion region;
  region.planes = any_planes_.planes == nullptr ? &kPlanes : any_planes_.planes;
  region.count = any_planes_.planes == nullptr ? 1 : any_planes_.count;
  region.box = any_planes_.box == nullptr ? &kBox : any_planes_.box;
  region.faces = kFaces;
  return region;
}

const LaneScene::Shape& LaneScene::shape_of(const scene::Region& region) {
  Shape& known = shapes_[region.accelerator];
  if (!known.triangles.empty()) return known;
  const scene::Accelerator& accelerator = scene_.accelerator(region);
  if (accelerator.uses_planes())
    add_planes(accelerator.boundary(), known);
  else
    add_gaps(accelerator, known);
  return known;
}

void LaneScene::add_planes(const scene::Boundary& boundary, Shape& shape) {
  has_boxes_alone_ = has_boxes_alone_ && boundary.is_box;
  for (std::size_t axis = 0; boundary.is_box && axis < 3; ++axis) {
    shape.box.first_mm[axis] = boundary.planes[2 * axis].offset;
    shape.box.second_mm[axis] = boundary.planes[2 * axis + 1].offset;
    shape.box.per_length[axis] = 1.0 / (shape.box.first_mm[axis] + shape.box.second_mm[axis]);
  }
  for (std::size_t i = 0; i < boundary.planes.size();) {
    const scene::BoundingPlane& first = boundary.planes[i];
    const bool paired = i < boundary.opposite_planes;
    const scene::BoundingPlane& second = boundary.planes[paired ? i + 1 : i];
    shape.planes.push_back({{first.normal.x(), first.normal.y(), first.normal.z()},
                            first.offset,
                            paired ? second.offset : std::numeric_limits<double>::infinity()});
    for (const scene::BoundingPlane* plane : {&first, &second}) {
      shape.triangles.push_back(plane->first);
      shape.mixed.push_back(plane->triangles_begin != plane->triangles_end);
      shape.gaps_of.emplace_back();
    }
    i += paired ? 2 : 1;
  }
}

void LaneScene::add_gaps(const scene::Accelerator& accelerator, Shape& shape) {
  const scene::ThinGaps& thin = accelerator.boundary().thin_gaps;
  shape.face_of.assign(thin.of_triangle.size(), kNotAtGaps);
  const auto add = [&](std::uint32_t triangle) {
    const auto number = static_cast<std::uint32_t>(shape.triangles.size());
    shape.triangles.push_back(triangle);
    shape.mixed.push_back(false);
    shape.gaps_of.push_back(thin.of_triangle[triangle]);
    return shape.face_of[triangle] = number;
  };
  // Triangles of one face have the same gaps.
  std::map<std::uint32_t, std::uint32_t> by_gaps;
  for (std::uint32_t triangle = 0; triangle < thin.of_triangle.size(); ++triangle) {
    const scene::ThinGaps::Range range = thin.of_triangle[triangle];
    if (range.begin == range.end) continue;
    const auto known = by_gaps.find(range.begin);
    if (known != by_gaps.end())
      shape.face_of[triangle] = known->second;
    else
      by_gaps[range.begin] = add(triangle);
  }
  for (const scene::ThinGap& gap : thin.gaps) {
    LaneGap lanes{};
    const core::Lanes plane = accelerator.plane(gap.beyond);
    for (int axis = 0; axis < 3; ++axis) {
      lanes.normal[axis] = accelerator.normal(gap.beyond)[axis];
      lanes.x[axis] = gap.x[axis];
      lanes.y[axis] = gap.y[axis];
    }
    lanes.offset_mm = plane.zw[1];
    lanes.low_x = gap.low_x;
    lanes.high_x = gap.high_x;
    lanes.low_y = gap.low_y;
    lanes.high_y = gap.high_y;
    const std::uint32_t beyond = shape.face_of[gap.beyond];
    lanes.beyond = beyond != kNotAtGaps ? beyond : add(gap.beyond);
    // The one that light reaches: others of the face may have another normal in the last bit.
    shape.triangles[static_cast<std::size_t>(lanes.beyond)] = gap.beyond;
    shape.gaps.push_back(lanes);
  }
}

std::optional<std::uint32_t> LaneScene::face_at_gap(const scene::Region& region,
                                                    std::uint32_t triangle) const {
  if (triangle == scene::kNoTriangle) return std::nullopt;
  const Shape& shape = shapes_[region.accelerator];
  const std::uint32_t face = shape.face_of[triangle];
  if (face == kNotAtGaps || shape.gaps_of[face].begin == shape.gaps_of[face].end) return std::nullopt;
  return face;
}

void LaneScene::make_faces(core::RegionId id) {
  const scene::Region& region = scene_.regions[id];
  const Shape& shape = shape_of(region);
  MadeRegion& made = regions_[id];
  for (std::uint32_t number = 0; number < shape.triangles.size(); ++number)
    made.faces.push_back(face(region, shape, number));
  made.region.faces = made.faces.data();
  if (!shape.planes.empty()) {
    made.region.planes = shape.planes.data();
    made.region.count = static_cast<std::uint32_t>(shape.planes.size());
    made.region.box = &shape.box;
    if (any_planes_.planes == nullptr) any_planes_ = made.region;
    has_one_shape_ = has_one_shape_ && any_planes_.planes == made.region.planes;
  }
  has_gaps_ = has_gaps_ || region.thin_gaps;
  made.region.has_gaps = region.thin_gaps ? 1 : 0;
  made.region.number = static_cast<std::uint32_t>(id.index());
  made.region.medium = static_cast<std::uint32_t>(region.medium.index());
  add_medium(region.medium);
}

void LaneScene::make_mirrors(MadeRegion& region) {
  Mirrors mirrors;
  for (std::size_t i = 0; i < mirrors.size(); ++i) mirrors[i] = region.faces[i].optics;
  const auto known = std::find(mirrors_.begin(), mirrors_.end(), mirrors);
  region.region.unfolds = 1;
  region.region.mirrors = static_cast<std::uint32_t>(place_of_mirrors(known - mirrors_.begin()));
  if (known == mirrors_.end()) mirrors_.push_back(mirrors);
  unfolds_ = true;
}

void LaneScene::add_medium(core::MediumId medium) {
  if (medium.has_value() && std::find(media_.begin(), media_.end(), medium) == media_.end())
    media_.push_back(medium);
}

LaneFace LaneScene::face(const scene::Region& region, const Shape& shape, std::uint32_t number) {
  const std::uint32_t triangle = shape.triangles[number];
  const core::PlainVec3& normal = scene_.accelerator(region).normal(triangle);
  LaneFace face{};
  for (int axis = 0; axis < 3; ++axis) face.normal[axis] = normal[axis];
  face.kind = lane_state::kBoundary;
  face.optics = no_surface();
  static constexpr LaneGap kNoGap{};
  const scene::ThinGaps::Range gaps = shape.gaps_of[number];
  face.gap = gaps.begin != gaps.end ? &shape.gaps[gaps.begin] : &kNoGap;
  const scene::BoundaryLink& link = scene_.link(region, triangle);
  const std::optional<optics::LaneSurface> surface = scene::lane_surface_at(scene_, link);
  if (surface && !shape.mixed[number]) {
    face.kind = state_of(surface->micro);
    face.optics = alike(link, region.medium, *surface);
  }
  if (shape.mixed[number]) face.kind = lane_state::kUnclear;
  return face;
}

void LaneScene::link_faces(core::RegionId id, const LaneKinds& kinds) {
  const scene::Region& region = scene_.regions[id];
  const Shape& shape = shapes_[region.accelerator];
  for (std::size_t number = 0; number < shape.triangles.size(); ++number) {
    LaneFace& face = regions_[id].faces[number];
    if (face.optics == no_surface()) continue;
    const std::uint32_t triangle = shape.triangles[number];
    const scene::BoundaryLink& link = scene_.link(region, triangle);
    const core::RegionId next = scene_.behind(link);
    if (kinds[next] != LaneKind::surfaces ||
        scene_.reaches_sensor(scene_.interfaces[link.interface], link.from_back))
      continue;
    const scene::Region& there = scene_.regions[next];
    face.behind_face = 0.0;
    if (there.thin_gaps) {
      const std::optional<std::uint32_t> at = face_at_gap(there, scene_.twin(region, triangle));
      if (!at) continue;
      face.behind_face = *at;
    }
    for (int axis = 0; axis < 3; ++axis) face.behind_centre[axis] = there.centre[axis];
    face.behind = &regions_[next].region;
    has_neighbours_ = true;
  }
}

std::size_t LaneScene::alike(const scene::BoundaryLink& link, core::MediumId here,
                             const optics::LaneSurface& surface) {
  for (std::size_t i = 0; i < alike_.size(); ++i)
    if (alike_[i].here == here && are_alike(scene_, alike_[i].link, link)) return place_of(i);
  const scene::Interface& interface = scene_.interfaces[link.interface];
  AlikeFaces faces{link, here, scene::medium_behind_surface(scene_, link), surface};
  if (surface.table) faces.tables = tables_of(*surface.table);
  if (surface.facets) set_facets(*surface.facets, faces.constant);
  if (surface.reflector) {
    faces.constant.reflector = 1.0;
    faces.constant.specular_share = surface.reflector->specular_share;
    const optics::Surface& stack = scene_.surfaces[scene::first_surface(interface, link.from_back).id];
    if (surface.micro != Micro::painted && stack.reflector) faces.gap_index = &stack.gap_index;
  }
  faces.total = scene::total_reflection(scene_, link);
  faces.plain = interface.plain;
  add_medium(faces.behind);
  alike_.push_back(faces);
  return place_of(alike_.size() - 1);
}

const LaneTable* LaneScene::tables_of(const optics::SurfaceTable& table) {
  std::vector<LaneTable>& known = tables_[&table];
  if (!known.empty()) return known.data();
  const std::size_t slices = table.wavelengths_nm().size();
  for (std::size_t first = 0; first < std::max<std::size_t>(slices, 2) - 1; ++first) {
    LaneTable lanes;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t slice = std::min(first + k, slices - 1);
      lanes.view[2 * k] = table.sampler(slice, optics::Side::inside).view();
      lanes.view[2 * k + 1] = table.sampler(slice, optics::Side::outside).view();
    }
    known.push_back(lanes);
  }
  return known.data();
}

std::vector<LaneRecord> LaneScene::initial_records() const {
  std::vector<LaneRecord> records(place_of_mirrors(mirrors_.size()));
  for (const core::MediumId medium : media_) new (&records[medium.index()]) LaneMedium{};
  (new (&records[no_surface()]) LaneFaceOptics{})->least_sin2 = kNoTotalReflection;
  for (std::size_t i = 0; i < alike_.size(); ++i)
    (new (&records[place_of(i)]) LaneFaceOptics(alike_[i].constant))->least_sin2 = kNoTotalReflection;
  return records;
}

void LaneScene::set_wavelength(double wavelength_nm, AtWavelength& to) const {
  to.wavelength_nm = wavelength_nm;
  if (to.records.empty()) to.records = initial_;
  for (const core::MediumId medium : media_) {
    const optics::MediumOptics at = scene_.optics.at(medium, wavelength_nm);
    auto& record = record_at<LaneMedium>(to.records, medium.index());
    record.index = at.index;
    record.group_index = at.group_index;
    record.attenuation_per_mm = at.absorption_per_mm + at.scattering_per_mm;
  }
  const auto index_of = [&to](core::MediumId medium) {
    return record_at<LaneMedium>(to.records, medium.index()).index;
  };
  for (std::size_t i = 0; i < alike_.size(); ++i) {
    const AlikeFaces& alike = alike_[i];
    auto& at = record_at<LaneFaceOptics>(to.records, place_of(i));
    const double here = index_of(alike.here), next = alike.behind.has_value() ? index_of(alike.behind) : here;
    const double beneath = alike.surface.micro == Micro::painted ? here : next;
    const double index_behind = alike.gap_index != nullptr ? (*alike.gap_index)(wavelength_nm) : beneath;
    at.index_behind = index_behind;
    at.counted = !alike.plain || here != next ? 1.0 : 0.0;
    at.least_sin2 = scene::least_sin2(scene_, alike.total, here, wavelength_nm);
    if (alike.surface.table) {
      const auto between = alike.surface.table->between_wavelengths(wavelength_nm);
      at.table = alike.tables + between.first;
      at.to_next = between.to_next ? std::max(0.0, *between.to_next) : -1.0;
    }
    if (alike.surface.reflector) at.reflectance = alike.surface.reflector->reflectance(wavelength_nm);
  }
  for (std::size_t i = 0; i < mirrors_.size(); ++i)
    for (std::size_t face = 0; face < mirrors_[i].size(); ++face)
      to.records[place_of_mirrors(i) + face / 4].of[face % 4] =
          record_at<LaneFaceOptics>(to.records, mirrors_[i][face]).least_sin2;
}

}  // namespace scintray::transport
