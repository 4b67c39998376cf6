#include "scintray/mesh/import/import.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/scene_file/shape.hpp"

namespace scintray::scene_file {

namespace {

ShapeMesh make(const MeshFileSpec& file) {
  mesh::MeshImport imported =
      mesh::import_mesh(file.path, {file.unit_mm.value_or(0.0), file.scale, file.body, file.tessellation});
  return {std::move(imported.mesh), std::move(imported.notes)};
}

ShapeMesh make(const BoxSpec& box) {
  return {box.chamfer_mm > 0.0 ? mesh::make_chamfered_box(box.low, box.high, box.chamfer_mm)
                               : mesh::make_box(box.low, box.high),
          {}};
}

ShapeMesh make(const CylinderSpec& c) {
  return {mesh::make_cylinder(c.radius_mm, c.height_mm, c.segments), {}};
}

ShapeMesh make(const PrismSpec& p) {
  return {mesh::make_prism(p.sides, p.circumradius_mm, p.height_mm, p.chamfer_mm), {}};
}

ShapeMesh make(const TaperedSpec& t) { return {mesh::make_tapered(t.bottom, t.top, t.height_mm), {}}; }

ShapeMesh make(const WinstonSpec& w) { return {mesh::make_winston(w.shape), {}}; }

ShapeMesh make(const SphereSpec& s) { return {mesh::make_sphere(s.radius_mm, s.subdivisions), {}}; }

}  // namespace

core::FileLocation shape_location(const ShapeSpec& shape) {
  return std::visit([](const auto& s) { return s.where; }, shape);
}

ShapeMesh shape_mesh(const ShapeSpec& shape) {
  return std::visit([](const auto& s) { return make(s); }, shape);
}

}  // namespace scintray::scene_file
