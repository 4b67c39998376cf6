#include "scintray/transport/detail/surface_lanes.hpp"

#include <algorithm>
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

LaneTable lane_table(const optics::SurfaceTable& table, double wavelength_nm) {
  LaneTable lanes;
  const optics::SurfaceTable::BetweenWavelengths between = table.between_wavelengths(wavelength_nm);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t slice = between.first + (between.to_next ? k : 0);
    lanes.view[k][0] = table.sampler(slice, optics::Side::inside).view();
    lanes.view[k][1] = table.sampler(slice, optics::Side::outside).view();
  }
  lanes.to_next = between.to_next ? std::max(0.0, *between.to_next) : -1.0;
  lanes.absorbs = table.absorbs();
  return lanes;
}

}  // namespace

LaneRegion LaneScene::region_of(const source::Photon& photon, std::size_t photon_index) {
  const Planes& planes = planes_of(scene_.regions[photon.region]);
  Faces* faces = &faces_[photon.region.index()];
  if (faces->faces.empty()) {
    make_faces(photon, planes, *faces);
  } else if (faces->wavelength_nm != photon.wavelength_nm) {
    faces = &own_[photon_index];
    if (faces->region != photon.region || faces->wavelength_nm != photon.wavelength_nm)
      make_faces(photon, planes, *faces);
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

void LaneScene::make_faces(const source::Photon& photon, const Planes& planes, Faces& faces) const {
  faces.region = photon.region;
  faces.wavelength_nm = photon.wavelength_nm;
  faces.faces.clear();
  faces.tables.clear();
  faces.tables.reserve(planes.triangles.size());  // faces point to them
  for (std::size_t plane = 0; plane < planes.triangles.size(); ++plane) {
    faces.faces.push_back(face(photon, planes.triangles[plane], faces.tables));
    if (planes.mixed[plane]) faces.faces.back().kind = lane_state::kUnclear;
  }
}

LaneFace LaneScene::face(const source::Photon& photon, std::uint32_t triangle,
                         std::vector<LaneTable>& tables) const {
  const scene::Region& region = scene_.regions[photon.region];
  const scene::BoundaryLink& link = scene_.link(region, triangle);
  const scene::Interface& interface = scene_.interfaces[link.interface];
  const core::PlainVec3& normal = scene_.accelerator(region).normal(triangle);
  LaneFace face{};
  for (int axis = 0; axis < 3; ++axis) face.normal[axis] = normal[axis];
  face.kind = lane_state::kBoundary;
  face.least_sin2 = kNoTotalReflection;
  const std::optional<optics::LaneSurface> surface = scene::lane_surface_at(scene_, link);
  if (!surface) return face;

  const double here = photon.optics.index;
  face.kind = state_of(surface->micro);
  face.index_behind = index_behind(scene_, link, photon);
  face.counted = !interface.plain || here != face.index_behind ? 1.0 : 0.0;
  if (interface.plain) face.least_sin2 = critical_sin2(scene_, link.smooth_to, photon);
  const scene::LinkSurface first = scene::first_surface(interface, link.from_back);
  if (surface->facets) set_facets(*surface->facets, face);
  if (surface->table) {
    tables.push_back(lane_table(*surface->table, photon.wavelength_nm));
    face.table = &tables.back();
  }
  if (!surface->reflector) return face;
  const optics::Surface& stack = scene_.surfaces[first.id];
  face.index_behind = surface->micro == Micro::painted ? here : stack.gap_index(photon.wavelength_nm);
  face.reflector = 1.0;
  face.reflectance = surface->reflector->reflectance(photon.wavelength_nm);
  face.specular_share = surface->reflector->specular_share;
  return face;
}

}  // namespace scintray::transport
