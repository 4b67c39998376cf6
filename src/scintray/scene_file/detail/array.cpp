#include "scintray/scene_file/detail/array.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/scene_file/detail/names.hpp"

namespace scintray::scene_file {

namespace {

using Kind = config::TomlNode::Kind;

/// Keys for the distance of neighbours.
enum class Spacing { pitch, gap };
constexpr core::Word<Spacing> kSpacings[] = {{"pitch", Spacing::pitch}, {"gap", Spacing::gap}};

constexpr core::Word<int> kCheckers[] = {{"even", 1}, {"odd", 2}};

std::string mm_text(double mm) {
  std::string text = std::to_string(mm);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text + " mm";
}

/// Extent of an element after its own rotation; a unit box where that is not available.
Eigen::AlignedBox3d element_bounds(const config::TomlTable& table, const PartSpec& element,
                                   const mesh::MeshFormats& formats) {
  Eigen::AlignedBox3d bounds;
  try {
    const Eigen::Matrix3d rotation = rotation_of(element.placement);
    for (const core::Vec3& vertex : shape_mesh(element.shape, formats).mesh.vertices)
      bounds.extend(rotation * vertex);
  } catch (const core::InputError& error) {
    for (const core::Problem& problem : error.problems()) table.report("element", problem.what, problem.hint);
    return {core::Vec3::Zero(), core::Vec3::Ones()};
  }
  return bounds;
}

/// The whole element, of the array or of a layer.
void read_element(const config::TomlTable& owner, LayerSpec& layer, const mesh::MeshFormats& formats) {
  const config::TomlTable table = owner.table("element");
  const std::size_t problems = table.problem_count();
  layer.element = {};
  layer.element.where = table.where();
  layer.element.placement.rotate = read_rotations(table);
  read_body(table, layer.element);
  if (table.problem_count() == problems) layer.element_bounds = element_bounds(owner, layer.element, formats);
}

/// Pitch along x and y from "pitch" or "gap". Not required for a single element.
void read_pitch(const config::TomlTable& table, LayerSpec& layer) {
  const bool needed = layer.count[0] > 1 || layer.count[1] > 1;
  const core::Word<Spacing>* kind = table.one_of(kSpacings, needed);
  if (!kind) return;
  const std::string key = kind->word;
  const bool pitch = kind->value == Spacing::pitch;
  const auto lengths = read_length_pair(table, key);
  if (!lengths) return;
  const core::Vec3 element = layer.element_bounds.sizes();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double size = element[static_cast<int>(axis)];
    layer.pitch_mm[axis] = (*lengths)[axis] + (pitch ? 0.0 : size);
    table.expect(key, pitch ? (*lengths)[axis] > 0.0 : (*lengths)[axis] >= 0.0,
                 "a " + key + " below " + (pitch ? "or at 0" : "0"),
                 pitch ? "give the distance of neighbours from middle to middle"
                       : "give the distance between neighbours, 0 for elements that touch");
  }
}

/// Reports elements of box shape that overlap their neighbours. Overlaps of other shapes are found when they
/// are placed.
void check_pitch(const config::TomlTable& table, const LayerSpec& layer) {
  if (!std::holds_alternative<BoxSpec>(layer.element.shape) || !layer.element.placement.rotate.empty())
    return;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double size = layer.element_bounds.sizes()[static_cast<int>(axis)];
    if (layer.count[axis] == 1 || layer.pitch_mm[axis] >= size * (1.0 - 1e-12)) continue;
    table.expect("pitch", false,
                 "the pitch of " + mm_text(layer.pitch_mm[axis]) + " along " + (axis == 0 ? "x" : "y") +
                     " is less than the element's " + mm_text(size),
                 "give a pitch of the element's size (they touch) or more");
  }
}

/// Offset of a layer: two lengths, or two plain numbers in pitches.
void read_offset(const config::TomlTable& table, LayerSpec& layer) {
  const config::TomlNode* node = table.node()->find("offset");
  table.has("offset");
  if (!node) return;
  const bool in_pitches =
      node->kind == Kind::array && !node->items.empty() && node->items.front().kind != Kind::string;
  if (!in_pitches) {
    layer.offset_mm = read_length_pair(table, "offset").value_or(std::array{0.0, 0.0});
    return;
  }
  const std::vector<double> pitches = table.numbers("offset", 2);
  for (std::size_t axis = 0; axis < pitches.size(); ++axis)
    layer.offset_mm[axis] = pitches[axis] * layer.pitch_mm[axis];
}

/// Shift of odd rows: a length, or a plain number in pitches.
double read_row_shift(const config::TomlTable& table, const LayerSpec& layer) {
  const config::TomlNode* node = table.node()->find("row_shift");
  if (!node || node->kind == Kind::string) return table.quantity("row_shift", core::Dimension::length, 0.0);
  return table.number("row_shift", 0.0) * layer.pitch_mm[0];
}

void read_septa(const config::TomlTable& owner, LayerSpec& layer, InlineTables& surfaces) {
  const std::optional<config::TomlTable> table = owner.optional_table("septa");
  if (!table) return;
  SeptaSpec septa;
  septa.where = table->where();
  septa.sheet = read_sheet(*table, surfaces);
  septa.thickness_mm = table->quantity("thickness", core::Dimension::length);
  septa.x = table->boolean("x", true);
  septa.y = table->boolean("y", true);
  table->expect("thickness", septa.thickness_mm > 0.0, "the thickness of septa is not positive",
                "give a length above 0");
  const core::Vec3 element = layer.element_bounds.sizes();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double gap = layer.pitch_mm[axis] - element[static_cast<int>(axis)];
    // Elements that overlap are reported for the pitch.
    if (layer.count[axis] == 1 || gap < -1e-9 || !(axis == 0 ? septa.x : septa.y)) continue;
    table->expect("thickness", septa.thickness_mm <= gap + 1e-9,
                  "septa of " + mm_text(septa.thickness_mm) + " do not fit the gap of " + mm_text(gap) +
                      " along " + (axis == 0 ? "x" : "y"),
                  "make the septa thinner or the pitch larger");
  }
  table->expect("x", layer.row_shift_mm == 0.0 || !septa.x, "septa between columns cut rows that are shifted",
                "write x = false, or remove row_shift");
  const std::vector<double> height = table->quantities("height", core::Dimension::length, 2, false);
  if (!height.empty()) {
    septa.height_mm = {height[0], height[1]};
    table->expect("height", height[0] >= 0.0 && height[1] > height[0] && height[1] <= element.z() + 1e-9,
                  "septa from " + mm_text(height[0]) + " to " + mm_text(height[1]) + " between elements " +
                      mm_text(element.z()) + " high",
                  "give the lower end first, both measured from the bottom of the elements");
  }
  layer.septa = septa;
}

std::optional<GlueSpec> read_glue(const config::TomlTable& owner) {
  const std::optional<config::TomlTable> table = owner.optional_table("glue");
  if (!table) return std::nullopt;
  GlueSpec glue{read_name(*table, "medium", true), table->quantity("thickness", core::Dimension::length)};
  table->expect(
      "thickness", glue.thickness_mm > 0.0, "glue of no thickness",
      "give a thickness above 0, or remove glue: layers that touch are bonded or dry as contacts say");
  return glue;
}

/// Replaces the height of a box, cylinder, prism, cone or tube.
void read_height(const config::TomlTable& table, LayerSpec& layer, const mesh::MeshFormats& formats) {
  const std::optional<double> height = table.optional_quantity("height", core::Dimension::length);
  if (!height) return;
  ShapeSpec& shape = layer.element.shape;
  if (auto* box = std::get_if<BoxSpec>(&shape))
    box->high.z() = box->low.z() + *height;
  else if (auto* cylinder = std::get_if<CylinderSpec>(&shape))
    cylinder->height_mm = *height;
  else if (auto* prism = std::get_if<PrismSpec>(&shape))
    prism->height_mm = *height;
  else if (auto* cone = std::get_if<ConeSpec>(&shape))
    cone->height_mm = *height;
  else if (auto* tube = std::get_if<TubeSpec>(&shape))
    tube->shape.height = *height;
  else
    table.expect("height", false, "only boxes, cylinders, cones, prisms and tubes have a height to change",
                 "give this layer an element of its own");
  table.expect("height", *height > 0.0, "the height of a layer is not positive", "give a length above 0");
  if (table.good("height")) layer.element_bounds = element_bounds(table, layer.element, formats);
}

/// Reads one layer: a key that its own table lacks is taken from the array's.
class LayerReader {
 public:
  /// @param own  the layer's table; the array's where it has no [[array.layer]]
  LayerReader(const config::TomlTable& array, const config::TomlTable& own, InlineTables& surfaces,
              const mesh::MeshFormats& formats)
      : array_(array), own_(own), surfaces_(surfaces), formats_(formats) {}

  LayerSpec read() {
    LayerSpec layer;
    layer.where = own_.where();
    read_element(pick({"element"}), layer, formats_);
    const bool one_of_several = own_.node() != array_.node();
    if (one_of_several) read_changes(layer);
    layer.count = read_count(pick({"count"}), "count");
    const config::TomlTable& distance = pick({"pitch", "gap"});
    read_pitch(distance, layer);
    layer.row_shift_mm = read_row_shift(pick({"row_shift"}), layer);
    if (layer.row_shift_mm == 0.0) check_pitch(distance, layer);
    if (one_of_several) read_offset(own_, layer);
    read_septa(pick({"septa"}), layer, surfaces_);
    layer.filler = read_name(pick({"filler"}), "filler", false);
    layer.glue = read_glue(pick({"glue"}));
    return layer;
  }

 private:
  const config::TomlTable& pick(const std::vector<std::string>& keys) const {
    bool own = false;
    for (const std::string& key : keys) {
      array_.has(key);
      own |= own_.has(key);
    }
    return own ? own_ : array_;
  }

  void read_changes(LayerSpec& layer) const {
    read_height(own_, layer, formats_);
    if (own_.has("medium")) layer.element.medium = read_name(own_, "medium", true);
    if (own_.has("surface")) layer.element.surface = read_name(own_, "surface", true);
  }

  const config::TomlTable& array_;
  const config::TomlTable& own_;
  InlineTables& surfaces_;
  const mesh::MeshFormats& formats_;
};

std::vector<int> read_indices(const config::TomlTable& table, const std::string& key) {
  std::vector<int> indices;
  for (const double number : table.numbers(key, 0, false)) {
    table.expect(key, number >= 0.0 && number < 10000.0 && number == std::floor(number),
                 "a number of a " + key.substr(0, key.size() - 1) + " that is not whole, or below 0",
                 "columns, rows and layers count from 0");
    indices.push_back(static_cast<int>(number));
  }
  return indices;
}

OverrideSpec read_override(const config::TomlTable& table) {
  OverrideSpec change;
  change.where = table.where();
  const config::TomlTable select = table.table("select");
  change.select.columns = read_indices(select, "columns");
  change.select.rows = read_indices(select, "rows");
  change.select.layers = read_indices(select, "layers");
  change.select.border = select.boolean("border", false);
  change.select.checker = select.choice("checker", kCheckers, 0);
  change.remove = table.boolean("remove", false);
  change.medium = read_name(table, "medium", false);
  change.surface = read_name(table, "surface", false);
  change.faces = read_faces(table);
  return change;
}

/// Reports numbers of columns, rows and layers that do not exist.
void check_override(const config::TomlTable& table, const OverrideSpec& change,
                    const std::vector<LayerSpec>& layers) {
  int columns = 0, rows = 0;
  for (const LayerSpec& layer : layers) {
    columns = std::max(columns, layer.count[0]);
    rows = std::max(rows, layer.count[1]);
  }
  const config::TomlTable select = table.table("select");
  const auto check = [&](const std::string& key, const std::vector<int>& indices, int count) {
    select.expect(key, std::all_of(indices.begin(), indices.end(), [&](int i) { return i < count; }),
                  "there are only " + std::to_string(count) + " " + key, "they count from 0");
  };
  check("columns", change.select.columns, columns);
  check("rows", change.select.rows, rows);
  check("layers", change.select.layers, static_cast<int>(layers.size()));
}

WrapSpec read_wrap(const config::TomlTable& table, InlineTables& surfaces) {
  WrapSpec wrap;
  wrap.where = table.where();
  wrap.sheet = read_sheet(table, surfaces);
  wrap.thickness_mm = table.quantity("thickness", core::Dimension::length);
  table.expect("thickness", wrap.thickness_mm > 0.0, "a wrap of no thickness", "give a length above 0");
  wrap.gap_mm = table.quantity("gap", core::Dimension::length, 0.0);
  table.expect("gap", wrap.gap_mm >= 0.0, "a gap below 0 would make the parts overlap",
               "give a length of 0 or more");
  for (const std::string& side : table.strings("sides")) {
    const auto box_side = core::find_word(kBoxSides, side);
    table.expect("sides", box_side.has_value(), "\"" + side + "\" is not a side",
                 "the sides are \"-x\", \"+x\", \"-y\", \"+y\", \"-z\", \"+z\"");
    if (box_side) wrap.sides.push_back(*box_side);
  }
  return wrap;
}

std::size_t element_count(const std::vector<LayerSpec>& layers) {
  std::size_t sum = 0;
  for (const LayerSpec& layer : layers)
    sum += static_cast<std::size_t>(layer.count[0]) * static_cast<std::size_t>(layer.count[1]);
  return sum;
}

}  // namespace

ArraySpec read_array(const config::TomlTable& table, const std::vector<std::string>& earlier,
                     InlineTables& surfaces, const mesh::MeshFormats& formats) {
  ArraySpec array;
  array.where = table.where();
  array.name = read_name(table, "name", true);
  expect_plain_name(table, "name", array.name.name);
  array.placement = read_placement(table, earlier);
  const std::vector<config::TomlTable> layers = table.tables("layer");
  array.layered = !layers.empty();
  for (const config::TomlTable& own : layers)
    array.layers.push_back(LayerReader(table, own, surfaces, formats).read());
  if (!array.layered) array.layers.push_back(LayerReader(table, table, surfaces, formats).read());
  if (element_count(array.layers) > kMostParts) {
    table.report("layer", "more than " + std::to_string(kMostParts) + " elements", "give fewer");
    array.layers.resize(1);
  }
  for (const config::TomlTable& change : table.tables("override")) {
    array.overrides.push_back(read_override(change));
    check_override(change, array.overrides.back(), array.layers);
  }
  if (const auto wrap = table.optional_table("wrap")) array.wrap = read_wrap(*wrap, surfaces);
  return array;
}

}  // namespace scintray::scene_file
