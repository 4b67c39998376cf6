#include "scintray/scene/detail/round_parts.hpp"

namespace scintray::scene {

std::uint32_t add_trimmed_face(const PartFace& face, const RegionFrame& frame, const ExactBody& body,
                               ExactBodies& exact) {
  TrimmedFace result;
  Eigen::AlignedBox3d box;
  for (const core::Vec3& corner : face.corners) box.extend(frame.point(corner));
  result.low = box.min() - core::Vec3::Constant(face.bulge_mm);
  result.high = box.max() + core::Vec3::Constant(face.bulge_mm);
  if (face.plane != kNoSurface) result.plane = body.planes_begin + face.plane;
  if (face.quadric != kNoSurface) result.quadric = body.quadrics_begin + face.quadric;
  result.wall = face.wall;
  result.trims_begin = static_cast<std::uint32_t>(exact.trims.size());
  for (const PartTrim& trim : face.trims) {
    Trim local;
    local.above = trim.above;
    if (trim.surface) {
      local.normal = core::Vec3(core::Vec3::Zero());
      local.surface = static_cast<std::uint32_t>(exact.trim_surfaces.size());
      exact.trim_surfaces.push_back(frame.surface(*trim.surface));
    } else {
      local.normal = frame.direction(trim.plane.normal);
      local.offset = trim.plane.offset - trim.plane.normal.dot(frame.centre);
    }
    exact.trims.push_back(local);
  }
  result.trims_end = static_cast<std::uint32_t>(exact.trims.size());
  result.cells_begin = static_cast<std::uint32_t>(exact.cells.size());
  exact.cells.insert(exact.cells.end(), face.cells.begin(), face.cells.end());
  result.cells_end = static_cast<std::uint32_t>(exact.cells.size());
  exact.build_trim_grid(result);
  exact.faces.push_back(result);
  return static_cast<std::uint32_t>(exact.faces.size() - 1);
}

void add_trimmed_faces(const PartBody& part, const RegionFrame& frame, ExactBody& body, ExactBodies& exact) {
  body.faces_begin = static_cast<std::uint32_t>(exact.faces.size());
  for (const PartFace& face : part.faces) add_trimmed_face(face, frame, body, exact);
  body.faces_end = static_cast<std::uint32_t>(exact.faces.size());
  // Of positions some metres from the origin, and of crossings.
  constexpr double kRounding = 1e-9, kRounding_mm = 1e-11;
  body.rounding_mm = kRounding * (body.high - body.low.vec()).norm() + kRounding_mm;
  body.off_surface_mm = part.off_surface_mm;
  exact.build_face_tree(body);
}

ExactBodies part_alone(const PartBody& part) {
  ExactBodies alone;
  ExactBody body;
  Eigen::AlignedBox3d box;
  for (const core::Vec3& corner : part.corners) box.extend(corner);
  const core::Vec3 bulge = core::Vec3::Constant(2.0 * part.deviation_mm + 1e-9 * box.diagonal().norm());
  body.low = box.min() - bulge;
  body.high = box.max() + bulge;
  for (const WorldPlane& plane : part.planes) alone.planes.push_back({plane.normal, plane.offset, {}});
  for (const mesh::SupportSurface& quadric : part.quadrics) alone.quadrics.push_back({quadric, {}, false});
  body.planes_end = static_cast<std::uint32_t>(alone.planes.size());
  body.quadrics_end = static_cast<std::uint32_t>(alone.quadrics.size());
  add_trimmed_faces(part, {core::Vec3::Zero(), Eigen::Matrix3d::Identity()}, body, alone);
  alone.bodies.push_back(body);
  alone.held = true;
  return alone;
}

}  // namespace scintray::scene
