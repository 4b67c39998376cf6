#include "scintray/scene/read_shape.hpp"

#include "scintray/mesh/file_checks.hpp"
#include "scintray/mesh/import.hpp"
#include "scintray/scene/read_parts.hpp"

namespace scintray {

namespace {

/// box = [size, size, size], centred in x and y, from z = 0; or box = { low, high }.
BoxSpec read_box(const TomlTable& table) {
  const TomlNode* node = table.node()->find("box");
  if (node->kind == TomlNode::Kind::table) return read_low_high(table, "box").value_or(BoxSpec{});
  BoxSpec box;
  box.where = node->where;
  const Vec3 size = table.optional_quantity3("box", Dimension::length).value_or(Vec3::Zero());
  table.expect("box", size.minCoeff() > 0.0, "a side of the box is not positive",
               "give three lengths above 0");
  box.low = Vec3(-0.5 * size.x(), -0.5 * size.y(), 0.0);
  box.high = Vec3(0.5 * size.x(), 0.5 * size.y(), size.z());
  return box;
}

CylinderSpec read_cylinder(const TomlTable& part) {
  const TomlTable table = part.table("cylinder");
  CylinderSpec cylinder;
  cylinder.where = table.where();
  cylinder.radius_mm = table.quantity("radius", Dimension::length);
  cylinder.height_mm = table.quantity("height", Dimension::length);
  const std::int64_t segments = table.integer("segments", cylinder.segments);
  for (const char* key : {"radius", "height"})
    table.expect(key, (std::string(key) == "radius" ? cylinder.radius_mm : cylinder.height_mm) > 0.0,
                 std::string("the ") + key + " of a cylinder is not positive", "give a length above 0");
  table.expect("segments", segments >= 3 && segments <= 1000000,
               "a cylinder of " + std::to_string(segments) + " segments",
               "give 3 or more (64 is the default), up to 1000000");
  cylinder.segments = static_cast<int>(segments);
  return cylinder;
}

/// body = "NAME", or its number.
std::string read_body(const TomlTable& part) {
  if (!part.has("body")) return {};
  if (part.node()->find("body")->kind == TomlNode::Kind::integer) {
    const std::int64_t number = part.integer("body");
    part.expect("body", number >= 1, "bodies are numbered from 1", "give the name or the number of a body");
    return std::to_string(number);
  }
  const std::string name = part.string("body");
  part.expect("body", !name.empty(), "a body without a name", "give the name or the number of a body");
  return name;
}

Tessellation read_tessellation(const TomlTable& part) {
  constexpr double kLeast_rad = 0.1 * kDegree, kMost_rad = 90.0 * kDegree;
  Tessellation tessellation;
  const std::optional<TomlTable> table = part.optional_table("tessellation");
  if (!table) return tessellation;
  tessellation.deviation_mm = table->quantity("deviation", Dimension::length, tessellation.deviation_mm);
  table->expect("deviation", tessellation.deviation_mm > 0.0, "a deviation that is not positive",
                "give the largest distance of a triangle from its CAD face, as \"0.01 mm\"");
  tessellation.angle_rad = table->quantity("angle", Dimension::angle, tessellation.angle_rad);
  table->expect("angle",
                tessellation.angle_rad >= kLeast_rad * (1.0 - 1e-9) &&
                    tessellation.angle_rad <= kMost_rad * (1.0 + 1e-9),
                "an angle between neighbouring triangles outside 0.1 to 90 deg",
                "give an angle as \"5 deg\"");
  return tessellation;
}

MeshFileSpec read_mesh(const TomlTable& table) {
  MeshFileSpec mesh;
  mesh.where = table.where("mesh");
  mesh.path = table.existing_file("mesh");
  const std::optional<std::string> unit = table.optional_string("unit");
  if (unit) {
    try {
      mesh.unit_mm = unit_factor(*unit, Dimension::length);
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) table.report("unit", problem.what, problem.hint);
    }
  } else if (!table.has("unit")) {
    table.expect("mesh", states_its_unit(lower_extension(mesh.path)),
                 "the mesh file \"" + mesh.path.string() + "\" does not say in which unit its numbers are",
                 "add the unit it was exported in, as unit = \"mm\"");
  }
  mesh.scale = table.number("scale", 1.0);
  table.expect("scale", mesh.scale > 0.0, "a scale that is not positive", "give a factor above 0");
  mesh.body = read_body(table);
  mesh.tessellation = read_tessellation(table);
  const bool cad = is_step(lower_extension(mesh.path));
  table.expect("tessellation", cad,
               "a tessellation of \"" + mesh.path.filename().string() + "\", which holds triangles already",
               "remove tessellation: it is for STEP files");
  return mesh;
}

}  // namespace

ShapeSpec read_shape(const TomlTable& part) {
  const std::optional<std::string> kind = part.one_of({"mesh", "box", "cylinder"}, true);
  for (const char* key : {"unit", "scale", "body", "tessellation"}) part.has(key);
  if (kind == "mesh") return read_mesh(part);
  if (kind == "cylinder") return read_cylinder(part);
  if (kind == "box") return read_box(part);
  return BoxSpec{};
}

}  // namespace scintray
