#include "scintray/scene_file/detail/read_mesh.hpp"

#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/scene_file/detail/read_parts.hpp"

namespace scintray::scene_file {

namespace {

/// body = "NAME", or its number.
std::string read_body(const config::TomlTable& part) {
  if (!part.has("body")) return {};
  if (part.node()->find("body")->kind == config::TomlNode::Kind::integer) {
    const std::int64_t number = part.integer("body");
    part.expect("body", number >= 1, "bodies are numbered from 1", "give the name or the number of a body");
    return std::to_string(number);
  }
  const std::string name = part.string("body");
  part.expect("body", !name.empty(), "a body without a name", "give the name or the number of a body");
  return name;
}

mesh::Tessellation read_tessellation(const config::TomlTable& part) {
  constexpr double kLeast_rad = 0.1 * core::kDegree, kMost_rad = 90.0 * core::kDegree;
  mesh::Tessellation tessellation;
  const std::optional<config::TomlTable> table = part.optional_table("tessellation");
  if (!table) return tessellation;
  tessellation.deviation_mm =
      table->quantity("deviation", core::Dimension::length, tessellation.deviation_mm);
  table->expect("deviation", tessellation.deviation_mm > 0.0, "a deviation that is not positive",
                "give the largest distance of a triangle from its CAD face, as \"0.01 mm\"");
  tessellation.angle_rad = table->quantity("angle", core::Dimension::angle, tessellation.angle_rad);
  table->expect("angle",
                tessellation.angle_rad >= kLeast_rad * (1.0 - 1e-9) &&
                    tessellation.angle_rad <= kMost_rad * (1.0 + 1e-9),
                "an angle between neighbouring triangles outside 0.1 to 90 deg",
                "give an angle as \"5 deg\"");
  return tessellation;
}

}  // namespace

MeshFileSpec read_mesh(const config::TomlTable& table) {
  MeshFileSpec mesh;
  mesh.where = table.where("mesh");
  mesh.path = table.existing_file("mesh");
  const std::optional<std::string> unit = table.optional_string("unit");
  if (unit) {
    try {
      mesh.unit_mm = core::unit_factor(*unit, core::Dimension::length);
    } catch (const core::InputError& error) {
      for (const core::Problem& problem : error.problems()) table.report("unit", problem.what, problem.hint);
    }
  } else if (!table.has("unit")) {
    table.expect("mesh", mesh::states_its_unit(mesh::lower_extension(mesh.path)),
                 "the mesh file \"" + mesh.path.string() + "\" does not say in which unit its numbers are",
                 "add the unit it was exported in, as unit = \"mm\"");
  }
  mesh.scale = table.number("scale", 1.0);
  table.expect("scale", mesh.scale > 0.0, "a scale that is not positive", "give a factor above 0");
  mesh.body = read_body(table);
  mesh.tessellation = read_tessellation(table);
  const bool cad = mesh::is_step(mesh::lower_extension(mesh.path));
  table.expect("tessellation", cad,
               "a tessellation of \"" + mesh.path.filename().string() + "\", which holds triangles already",
               "remove tessellation: it is for STEP files");
  return mesh;
}

}  // namespace scintray::scene_file
