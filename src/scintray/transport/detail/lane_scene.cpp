#include "scintray/transport/detail/surface_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scintray/optics/facet_laws.hpp"
#include "scintray/scene/lane_surface_at.hpp"
#include "scintray/transport/detail/step_parts.hpp"

namespace scintray::transport {

namespace {

using Micro = optics::LaneSurface::Micro;

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

void set_facets(const optics::FacetSurface& facets, LaneFace& face) {
  const optics::FacetLimits limits(facets.sigma_alpha_rad,
                                   facets.sampling == optics::FacetSampling::projected_area);
  face.sigma_rad = facets.sigma_alpha_rad;
  face.widest_rad = limits.widest_rad;
  face.sin_widest = limits.of_widest.sine;
  face.cos_widest = limits.of_widest.cosine;
  face.by_area = limits.by_area ? 1.0 : 0.0;
}

/// The least 1 - cosine^2 for which Fresnel's equations (optics::RefractionOf) find total reflection, to the
/// last bit; for a surface that is met as Fresnel's equations see it, not by the critical angle of a plain
/// interface. Products of positive numbers are monotonic, so that there is one.
double least_total_sin2(double n1, double n2) {
  const double ratio = n1 / n2, ratio2 = ratio * ratio;
  if (!(ratio2 > 1.0)) return kNoTotalReflection;
  double least = 1.0 / ratio2;
  while (ratio2 * least < 1.0) least = std::nextafter(least, 2.0);
  while (ratio2 * std::nextafter(least, 0.0) >= 1.0) least = std::nextafter(least, 0.0);
  return least;
}

/// True when photons meet the same at two links: the same surface, from the same side, and then the same
/// medium.
bool meet_the_same(const scene::Scene& scene, const scene::BoundaryLink& a, const scene::BoundaryLink& b) {
  if (a.interface == b.interface) return a.from_back == b.from_back;
  const scene::Interface &at_a = scene.interfaces[a.interface], &at_b = scene.interfaces[b.interface];
  const auto behind = [&](const scene::BoundaryLink& link, const scene::Interface& at) {
    return scene.regions[link.from_back ? at.front : at.back].medium;
  };
  const scene::LinkSurface first = scene::first_surface(at_a, a.from_back),
                           other = scene::first_surface(at_b, b.from_back);
  return first.id == other.id && first.own == other.own && at_a.plain == at_b.plain &&
         a.smooth_to == b.smooth_to && behind(a, at_a) == behind(b, at_b);
}

}  // namespace

LaneRegion LaneScene::region_of(const source::Photon& photon, std::size_t photon_index) {
  const Planes& planes = planes_of(scene_.regions[photon.region]);
  RegionFaces& known = faces_[photon.region.index()];
  if (known.at_first.faces.empty()) make_faces(photon, planes, known);
  const Faces* faces = &known.at_first;
  if (faces->wavelength_nm != photon.wavelength_nm) {
    Faces& own = own_[photon_index];
    faces = &own;
    if (own.region != photon.region) own = known.at_first;
    if (own.wavelength_nm != photon.wavelength_nm) {
      set_wavelength(photon, known.alike, own.faces);
      own.wavelength_nm = photon.wavelength_nm;
    }
  }
  return {planes.planes.data(), faces->faces.data(), planes.planes.size()};
}

const LaneScene::Planes& LaneScene::planes_of(const scene::Region& region) {
  std::unique_ptr<Planes>& known = planes_[region.accelerator.index()];
  if (known) return *known;
  known = std::make_unique<Planes>();
  const scene::Boundary& boundary = scene_.accelerator(region).boundary();
  for (std::size_t i = 0; i < boundary.planes.size();) {
    const scene::BoundingPlane& first = boundary.planes[i];
    const bool paired = i < boundary.opposite_planes;
    const scene::BoundingPlane& second = boundary.planes[paired ? i + 1 : i];
    known->planes.push_back({{first.normal.x(), first.normal.y(), first.normal.z()},
                             first.offset,
                             paired ? second.offset : std::numeric_limits<double>::infinity()});
    for (const scene::BoundingPlane* plane : {&first, &second}) {
      known->triangles.push_back(plane->first);
      known->mixed.push_back(plane->triangles_begin != plane->triangles_end);
    }
    i += paired ? 2 : 1;
  }
  return *known;
}

void LaneScene::make_faces(const source::Photon& photon, const Planes& planes, RegionFaces& made) {
  const scene::Region& region = scene_.regions[photon.region];
  Faces& at_first = made.at_first;
  at_first.region = photon.region;
  at_first.wavelength_nm = photon.wavelength_nm;
  for (std::uint32_t plane = 0; plane < planes.triangles.size(); ++plane) {
    const scene::BoundaryLink& link = scene_.link(region, planes.triangles[plane]);
    const std::optional<optics::LaneSurface> surface = scene::lane_surface_at(scene_, link);
    at_first.faces.push_back(face(photon.region, planes.triangles[plane], surface));
    if (planes.mixed[plane])
      at_first.faces.back().kind = lane_state::kUnclear;
    else if (surface)
      alike(link, *surface, made.alike).planes.push_back(plane);
  }
  set_wavelength(photon, made.alike, at_first.faces);
}

LaneFace LaneScene::face(core::RegionId region, std::uint32_t triangle,
                         const std::optional<optics::LaneSurface>& surface) const {
  const core::PlainVec3& normal = scene_.accelerator(scene_.regions[region]).normal(triangle);
  LaneFace face{};
  for (int axis = 0; axis < 3; ++axis) face.normal[axis] = normal[axis];
  face.kind = lane_state::kBoundary;
  face.least_sin2 = kNoTotalReflection;
  if (!surface) return face;
  face.kind = state_of(surface->micro);
  if (surface->facets) set_facets(*surface->facets, face);
  if (!surface->reflector) return face;
  face.reflector = 1.0;
  face.specular_share = surface->reflector->specular_share;
  return face;
}

LaneScene::AlikeFaces& LaneScene::alike(const scene::BoundaryLink& link, const optics::LaneSurface& surface,
                                        std::vector<AlikeFaces>& of_region) {
  for (AlikeFaces& known : of_region)
    if (meet_the_same(scene_, known.link, link)) return known;
  of_region.push_back({link, surface, surface.table ? tables_of(*surface.table) : nullptr, {}});
  return of_region.back();
}

const LaneTable* LaneScene::tables_of(const optics::SurfaceTable& table) {
  std::vector<LaneTable>& known = tables_[&table];
  if (!known.empty()) return known.data();
  const std::size_t slices = table.wavelengths_nm().size();
  for (std::size_t first = 0; first < std::max<std::size_t>(slices, 2) - 1; ++first) {
    LaneTable lanes;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t slice = std::min(first + k, slices - 1);
      lanes.view[k][0] = table.sampler(slice, optics::Side::inside).view();
      lanes.view[k][1] = table.sampler(slice, optics::Side::outside).view();
    }
    lanes.absorbs = table.absorbs();
    known.push_back(lanes);
  }
  return known.data();
}

void LaneScene::set_wavelength(const source::Photon& photon, const std::vector<AlikeFaces>& alike,
                               std::vector<LaneFace>& faces) const {
  const double here = photon.optics.index;
  for (const AlikeFaces& set : alike) {
    const scene::Interface& interface = scene_.interfaces[set.link.interface];
    LaneFace at = faces[set.planes.front()];  // alike but for their normals
    at.index_behind = index_behind(scene_, set.link, photon);
    at.counted = !interface.plain || here != at.index_behind ? 1.0 : 0.0;
    if (interface.plain) at.least_sin2 = critical_sin2(scene_, set.link.smooth_to, photon);
    if (set.surface.table) {
      const auto between = set.surface.table->between_wavelengths(photon.wavelength_nm);
      at.table = set.tables + between.first;
      at.to_next = between.to_next ? std::max(0.0, *between.to_next) : -1.0;
    }
    if (set.surface.reflector) {
      const optics::Surface& stack = scene_.surfaces[scene::first_surface(interface, set.link.from_back).id];
      const bool painted = set.surface.micro == Micro::painted;
      at.index_behind = painted ? here : stack.gap_index(photon.wavelength_nm);
      at.reflectance = set.surface.reflector->reflectance(photon.wavelength_nm);
    }
    if (!interface.plain && set.surface.micro == Micro::smooth)
      at.least_sin2 = least_total_sin2(here, at.index_behind);
    for (const std::uint32_t plane : set.planes) {
      LaneFace& face = faces[plane];
      face.index_behind = at.index_behind;
      face.least_sin2 = at.least_sin2;
      face.counted = at.counted;
      face.reflectance = at.reflectance;
      if (!set.surface.table) continue;
      face.table = at.table;
      face.to_next = at.to_next;
    }
  }
}

}  // namespace scintray::transport
