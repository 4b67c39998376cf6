#include "scintray/core/named_file.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/scene_file/shape_files.hpp"

namespace scintray::scene_file {

namespace {

/// Makes the mesh of each kind of shape.
struct MeshMaker {
  mesh::MeshFiles& files;
  const mesh::MeshFormats& formats;

  ShapeMesh operator()(const MeshFileSpec& file) const {
    mesh::MeshImport imported = core::read_named_file(file.where, [&] {
      return files.import(file.path,
                          {file.unit_mm.value_or(0.0), file.scale, file.body, file.tessellation, &formats});
    });
    return {std::move(imported.mesh), std::move(imported.notes)};
  }
  ShapeMesh operator()(const BoxSpec& box) const {
    constexpr int kSegments = 64;  // of a rounding's full circle
    if (box.rounding_mm > 0.0)
      return {mesh::make_rounded_box(box.low, box.high, box.rounding_mm, kSegments), {}};
    return {box.chamfer_mm > 0.0 ? mesh::make_chamfered_box(box.low, box.high, box.chamfer_mm)
                                 : mesh::make_box(box.low, box.high),
            {}};
  }
  ShapeMesh operator()(const CylinderSpec& c) const {
    return {mesh::make_cylinder(c.radius_mm, c.height_mm, c.segments), {}};
  }
  ShapeMesh operator()(const ConeSpec& c) const {
    return {mesh::make_cone(c.bottom_radius_mm, c.top_radius_mm, c.height_mm, c.segments), {}};
  }
  ShapeMesh operator()(const PrismSpec& p) const {
    return {mesh::make_prism(p.sides, p.circumradius_mm, p.height_mm, p.chamfer_mm), {}};
  }
  ShapeMesh operator()(const TaperedSpec& t) const {
    return {mesh::make_tapered(t.bottom, t.top, t.height_mm), {}};
  }
  ShapeMesh operator()(const WinstonSpec& w) const { return {mesh::make_winston(w.shape), {}}; }
  ShapeMesh operator()(const SphereSpec& s) const {
    return {mesh::make_sphere(s.radius_mm, s.subdivisions), {}};
  }
  ShapeMesh operator()(const LensSpec& l) const { return {mesh::make_lens(l.shape), {}}; }
  ShapeMesh operator()(const RevolvedSpec& r) const {
    return {mesh::make_revolved(r.profile, r.segments, r.smooth), {}};
  }
  ShapeMesh operator()(const TubeSpec& t) const { return {mesh::make_tube(t.shape), {}}; }
  ShapeMesh operator()(const TorusSpec& t) const { return {mesh::make_torus(t.shape), {}}; }
  ShapeMesh operator()(const SpheroidSpec& s) const {
    return {mesh::make_spheroid(s.radius_mm, s.half_height_mm, s.subdivisions), {}};
  }
  ShapeMesh operator()(const FibreSpec& f) const { return {mesh::make_fibre(f.shape), {}}; }
};

}  // namespace

core::FileLocation shape_location(const ShapeSpec& shape) {
  return std::visit([](const auto& s) { return s.where; }, shape);
}

ShapeMesh shape_mesh(const ShapeSpec& shape, const mesh::MeshFormats& formats) {
  mesh::MeshFiles files;
  return shape_mesh(shape, files, formats);
}

ShapeMesh shape_mesh(const ShapeSpec& shape, mesh::MeshFiles& files, const mesh::MeshFormats& formats) {
  return std::visit(MeshMaker{files, formats}, shape);
}

}  // namespace scintray::scene_file
