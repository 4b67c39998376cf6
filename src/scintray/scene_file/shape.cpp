#include "scintray/scene_file/shape.hpp"

#include <algorithm>

#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/import.hpp"
#include "scintray/scene_file/detail/round_shapes.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

/// body = "NAME", or its number.
std::string read_mesh_body(const config::TomlTable& part) {
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

/// mesh = "FILE" of a [[part]], with the keys that belong to it: unit, scale, body,
/// tessellation, curved.
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
    // For a format added in code, its reader determines whether the file defines a unit.
    const std::string extension = mesh::lower_extension(mesh.path);
    const mesh::MeshFormat* format = mesh::MeshFormats::built_in().find(extension);
    table.expect("mesh", format ? format->states_unit : !extension.empty(),
                 "the mesh file \"" + mesh.path.string() + "\" does not say in which unit its numbers are",
                 "add the unit it was exported in, as unit = \"mm\"");
  }
  mesh.scale = table.number("scale", 1.0);
  table.expect("scale", mesh.scale > 0.0, "a scale that is not positive", "give a factor above 0");
  mesh.body = read_mesh_body(table);
  mesh.tessellation = read_tessellation(table);
  const bool cad = mesh::is_step(mesh::lower_extension(mesh.path));
  table.expect("tessellation", cad,
               "a tessellation of \"" + mesh.path.filename().string() + "\", which holds triangles already",
               "remove tessellation: it is for STEP files");
  table.expect("curved", !cad,
               "curved of \"" + mesh.path.filename().string() + "\", a STEP file, whose faces are known",
               "remove curved: [run] curved chooses between exact faces and facets");
  mesh.curved = table.choice("curved", kRoundFacesOfFile, RoundFacesOfFile::facets);
  return mesh;
}

/// box = [size, size, size], centred in x and y, from z = 0; or box = { low, high }.
BoxSpec read_box(const config::TomlTable& table) {
  const config::TomlNode* node = table.node()->find("box");
  if (node->kind == Kind::table) return read_low_high(table, "box").value_or(BoxSpec{});
  BoxSpec box;
  box.where = node->where;
  const core::Vec3 size =
      table.optional_quantity3("box", core::Dimension::length).value_or(core::Vec3::Zero());
  table.expect("box", size.minCoeff() > 0.0, "a side of the box is not positive: " + node->as_written(),
               "give three lengths above 0");
  box.low = core::Vec3(-0.5 * size.x(), -0.5 * size.y(), 0.0);
  box.high = core::Vec3(0.5 * size.x(), 0.5 * size.y(), size.z());
  return box;
}

CylinderSpec read_cylinder(const config::TomlTable& part) {
  const config::TomlTable table = part.table("cylinder");
  CylinderSpec cylinder;
  cylinder.where = table.where();
  cylinder.radius_mm = positive_length(table, "radius", "cylinder");
  cylinder.height_mm = positive_length(table, "height", "cylinder");
  cylinder.segments = number_of_pieces(table, "segments", cylinder.segments, 3, "cylinder");
  return cylinder;
}

ConeSpec read_cone(const config::TomlTable& part) {
  const config::TomlTable table = part.table("cone");
  ConeSpec cone;
  cone.where = table.where();
  const auto radius = [&](const char* key) {
    const double value = table.quantity(key, core::Dimension::length);
    table.expect(key, value >= 0.0, std::string("a negative ") + key + " of a cone",
                 "give a length, or \"0 mm\" for a tip");
    return value;
  };
  cone.bottom_radius_mm = radius("bottom_radius");
  cone.top_radius_mm = radius("top_radius");
  table.expect("top_radius",
               cone.bottom_radius_mm > 0.0 || cone.top_radius_mm > 0.0 || !table.good("bottom_radius"),
               "both radii of a cone are 0", "give one of them a length above 0");
  cone.height_mm = positive_length(table, "height", "cone");
  cone.segments = number_of_pieces(table, "segments", cone.segments, 3, "cone");
  return cone;
}

/// Keys for the width of a prism.
enum class PrismWidth { radius, flat_to_flat };
constexpr core::Word<PrismWidth> kPrismWidths[] = {{"radius", PrismWidth::radius},
                                                   {"flat_to_flat", PrismWidth::flat_to_flat}};

PrismSpec read_prism(const config::TomlTable& part) {
  const config::TomlTable table = part.table("prism");
  PrismSpec prism;
  prism.where = table.where();
  prism.sides = number_of_pieces(table, "sides", prism.sides, 3, "prism");
  if (const auto* width = table.one_of(kPrismWidths, true)) {
    const bool radius = width->value == PrismWidth::radius;
    const double length = positive_length(table, width->word, "prism");
    prism.circumradius_mm = radius ? length : 0.5 * length / std::cos(core::kPi / prism.sides);
    const bool has_flats = prism.sides % 2 == 0 || (table.has("sides") && !table.good("sides"));
    table.expect(width->word, radius || has_flats,
                 "a prism of " + std::to_string(prism.sides) + " sides has no flats opposite each other",
                 "give its radius, through the corners");
  }
  prism.height_mm = positive_length(table, "height", "prism");
  return prism;
}

/// Two lengths above 0.
std::array<double, 2> positive_pair(const config::TomlTable& table, const std::string& key) {
  const std::vector<double> mm = table.quantities(key, core::Dimension::length, 2);
  if (mm.empty()) return {1.0, 1.0};
  table.expect(key, mm[0] > 0.0 && mm[1] > 0.0, "a side of \"" + key + "\" is not positive",
               "give two lengths above 0");
  return {mm[0], mm[1]};
}

TaperedSpec read_tapered(const config::TomlTable& part) {
  const config::TomlTable table = part.table("tapered");
  TaperedSpec tapered;
  tapered.where = table.where();
  tapered.bottom.size = positive_pair(table, "bottom");
  tapered.top.size = positive_pair(table, "top");
  tapered.height_mm = positive_length(table, "height", "taper");
  const std::vector<double> offset = table.quantities("top_offset", core::Dimension::length, 2, false);
  if (!offset.empty()) tapered.top.centre = {offset[0], offset[1]};
  return tapered;
}

/// Keys for the opening of a Winston cone.
enum class WinstonOpening { acceptance, entrance_radius };
constexpr core::Word<WinstonOpening> kWinstonOpenings[] = {
    {"acceptance", WinstonOpening::acceptance}, {"entrance_radius", WinstonOpening::entrance_radius}};

WinstonSpec read_winston(const config::TomlTable& part) {
  const config::TomlTable table = part.table("winston");
  WinstonSpec winston;
  winston.where = table.where();
  mesh::WinstonShape& shape = winston.shape;
  shape.exit_radius = positive_length(table, "exit_radius", "Winston cone");
  const core::Word<WinstonOpening>* opening = table.one_of(kWinstonOpenings, true);
  if (opening && opening->value == WinstonOpening::acceptance) {
    shape.acceptance_rad = table.quantity("acceptance", core::Dimension::angle);
    table.expect("acceptance", shape.acceptance_rad > 0.0 && shape.acceptance_rad < 0.5 * core::kPi,
                 "an acceptance angle outside 0 to 90 deg",
                 "give the largest angle to the axis that is taken in");
  } else if (opening) {
    const double entrance = positive_length(table, "entrance_radius", "Winston cone");
    table.expect("entrance_radius", entrance > shape.exit_radius, "an entrance not wider than the exit",
                 "give a radius above exit_radius");
    shape.acceptance_rad = std::asin(std::min(1.0, shape.exit_radius / entrance));
  }
  if (const auto length = table.optional_quantity("length", core::Dimension::length)) {
    shape.length = *length;
    const double full = opening && table.good(opening->word) && table.good("exit_radius")
                            ? mesh::winston_length(shape.exit_radius, shape.acceptance_rad)
                            : HUGE_VAL;
    table.expect(
        "length", *length > 0.0 && *length <= full,
        "a Winston cone is " + std::to_string(full) + " mm long at most, where its walls become parallel",
        "give a length above 0 up to that, or leave it out");
  }
  if (const auto width = table.optional_quantity("trough", core::Dimension::length)) {
    shape.trough_width = *width;
    table.expect("trough", *width > 0.0, "the width of a trough is not positive", "give a length above 0");
  }
  shape.segments = number_of_pieces(table, "segments", shape.segments, 3, "Winston cone");
  shape.rings = number_of_pieces(table, "rings", shape.rings, 1, "Winston cone");
  constexpr std::int64_t kMostPieces = 250'000;  // two triangles each
  table.expect("rings", std::int64_t{shape.segments} * shape.rings <= kMostPieces,
               "a Winston cone of " + std::to_string(shape.segments) + " segments and " +
                   std::to_string(shape.rings) + " rings has " +
                   std::to_string(2 * std::int64_t{shape.segments} * shape.rings) + " triangles",
               "give fewer: segments times rings may be " + std::to_string(kMostPieces));
  return winston;
}

/// Bevels the edges of the shapes that have such edges.
void read_chamfer(const config::TomlTable& part, ShapeSpec& shape) {
  auto* box = std::get_if<BoxSpec>(&shape);
  auto* prism = std::get_if<PrismSpec>(&shape);
  part.has("chamfer");
  if (!box && !prism) return;
  const std::optional<double> chamfer = part.optional_quantity("chamfer", core::Dimension::length);
  if (!chamfer) return;
  double shortest = 0.0;
  if (box) {
    shortest = (box->high - box->low).minCoeff();
    box->chamfer_mm = *chamfer;
  } else {
    shortest = std::min(prism->height_mm, 2.0 * prism->circumradius_mm * std::sin(core::kPi / prism->sides));
    prism->chamfer_mm = *chamfer;
  }
  // In a face with corners other than 90 deg a bevel shortens each edge by more: checked by the mesh maker.
  part.expect("chamfer", *chamfer > 0.0 && 2.0 * *chamfer < shortest,
              "a chamfer that is not positive, or leaves nothing of the shortest edge",
              "give a length above 0 and below half of the shortest edge");
}

/// Rounds the edges of a box.
void read_rounding(const config::TomlTable& part, ShapeSpec& shape) {
  auto* box = std::get_if<BoxSpec>(&shape);
  part.has("rounding");
  if (!box) return;
  const std::optional<double> radius = part.optional_quantity("rounding", core::Dimension::length);
  if (!radius) return;
  part.expect("rounding", box->chamfer_mm == 0.0, "a box with a chamfer and a rounding",
              "remove one of them");
  part.expect("rounding", *radius > 0.0 && 2.0 * *radius < (box->high - box->low).minCoeff(),
              "a rounding that is not positive, or leaves nothing of the shortest edge",
              "give the radius of the edges, above 0 and below half of the shortest edge");
  box->rounding_mm = *radius;
}

using ShapeReader = ShapeSpec (*)(const config::TomlTable&);

template <auto Read>
ShapeSpec shape_of(const config::TomlTable& part) {
  return Read(part);
}

constexpr core::Word<ShapeReader> kShapes[] = {
    {"mesh", shape_of<read_mesh>},         {"box", shape_of<read_box>},
    {"cylinder", shape_of<read_cylinder>}, {"prism", shape_of<read_prism>},
    {"tapered", shape_of<read_tapered>},   {"winston", shape_of<read_winston>},
    {"sphere", shape_of<read_sphere>},     {"cone", shape_of<read_cone>},
    {"lens", shape_of<read_lens>},         {"revolved", shape_of<read_revolved>},
    {"tube", shape_of<read_tube>},         {"torus", shape_of<read_torus>},
    {"spheroid", shape_of<read_spheroid>}, {"fibre", shape_of<read_fibre>}};

}  // namespace

ShapeSpec read_shape(const config::TomlTable& part) {
  const core::Word<ShapeReader>* kind = part.one_of(kShapes, true);
  for (const char* key : {"unit", "scale", "body", "tessellation", "curved"}) part.has(key);
  ShapeSpec shape = kind ? kind->value(part) : BoxSpec{};
  read_chamfer(part, shape);
  read_rounding(part, shape);
  return shape;
}

std::optional<BoxSpec> read_low_high(const config::TomlTable& table, const std::string& key) {
  if (table.is_array(key)) {
    table.report(key, "\"" + key + "\" is an array, but a table is expected",
                 "write " + key + " = { low = [\"0 mm\", \"0 mm\", \"0 mm\"], high = [...] }");
    table.take(key);
    return std::nullopt;
  }
  const std::optional<config::TomlTable> corners = table.optional_table(key);
  if (!corners) return std::nullopt;
  BoxSpec box;
  box.where = corners->where();
  for (const char* corner : {"low", "high"}) {
    const std::vector<double> mm = corners->quantities(corner, core::Dimension::length, 3);
    if (mm.empty()) continue;
    (corner == std::string("low") ? box.low : box.high) = core::Vec3(mm[0], mm[1], mm[2]);
  }
  if (corners->good("low"))
    corners->expect("high", (box.high - box.low).minCoeff() > 0.0,
                    "a coordinate of \"high\" is not above that of \"low\"",
                    "give the corner with the larger x, y and z");
  return box;
}

}  // namespace scintray::scene_file
