#include <algorithm>

#include "scintray/scene_file/detail/array.hpp"

namespace scintray::scene_file {

namespace {

bool contains(const std::vector<int>& list, int value) {
  return list.empty() || std::find(list.begin(), list.end(), value) != list.end();
}

bool selects(const ElementSelector& select, const LayerSpec& layer, int k, int i, int j) {
  const bool on_border = i == 0 || j == 0 || i == layer.count[0] - 1 || j == layer.count[1] - 1;
  return contains(select.columns, i) && contains(select.rows, j) && contains(select.layers, k) &&
         (!select.border || on_border) && (select.checker == 0 || (i + j) % 2 == select.checker - 1);
}

void apply(const OverrideSpec& change, PartSpec& element) {
  if (!change.medium.empty()) element.medium = change.medium;
  if (!change.surface.empty()) element.surface = change.surface;
  for (const FaceRuleSpec& rule : change.faces) {
    const auto same = std::find_if(element.faces.begin(), element.faces.end(),
                                   [&](const FaceRuleSpec& other) { return other.name == rule.name; });
    if (same == element.faces.end())
      element.faces.push_back(rule);
    else
      *same = rule;
  }
}

PartSpec box_part(const std::string& name, const Eigen::AlignedBox3d& box, const config::NameRef& medium,
                  const core::FileLocation& where) {
  PartSpec part;
  part.name = {name, where};
  part.where = where;
  part.shape = BoxSpec{box.min(), box.max(), 0.0, where};
  part.medium = medium;
  return part;
}

/// Part of glue or of a filler.
PartSpec liquid_part(const std::string& name, const Eigen::AlignedBox3d& box, const config::NameRef& medium) {
  PartSpec part = box_part(name, box, medium, medium.where);
  part.liquid = true;
  return part;
}

class ArrayExpander {
 public:
  explicit ArrayExpander(const ArraySpec& array) : array_(array), name_(array.name.name) {}

  BuiltBody expand() {
    for (std::size_t k = 0; k < array_.layers.size(); ++k) {
      if (k > 0) add_glue(k - 1);
      add_layer(k);
    }
    if (array_.wrap) add_wrap(*array_.wrap);
    add_contacts();
    return std::move(body_);
  }

 private:
  /// "" or "3," before other indices, "" or "[3]" on its own.
  std::string index_before(std::size_t k) const { return array_.layered ? std::to_string(k) + "," : ""; }
  std::string index_alone(std::size_t k) const { return array_.layered ? "[" + std::to_string(k) + "]" : ""; }

  void add_layer(std::size_t k) {
    const LayerSpec& layer = array_.layers[k];
    Eigen::AlignedBox3d bounds;
    for (int j = 0; j < layer.count[1]; ++j)
      for (int i = 0; i < layer.count[0]; ++i) bounds.extend(add_element(layer, static_cast<int>(k), i, j));
    if (layer.septa) add_septa(layer, *layer.septa, k);
    if (!layer.filler.empty())
      body_.parts.push_back(liquid_part(name_ + "_filler" + index_alone(k), bounds, layer.filler));
    bounds_.push_back(bounds);
    height_ = bounds.max().z();
  }

  /// Bounding box of an element, which is added unless omitted by an override.
  Eigen::AlignedBox3d add_element(const LayerSpec& layer, int k, int i, int j) {
    const std::array<int, 2> index{i, j};
    core::Vec3 shift = -layer.element_bounds.center();
    shift.z() = height_ - layer.element_bounds.min().z();
    for (int axis = 0; axis < 2; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      shift[axis] += (index[a] - 0.5 * (layer.count[a] - 1)) * layer.pitch_mm[a] + layer.offset_mm[a];
    }
    // Half the shift in each direction keeps the layer centred.
    if (layer.count[1] > 1) shift.x() += (j % 2 == 0 ? -0.5 : 0.5) * layer.row_shift_mm;
    Eigen::AlignedBox3d place = layer.element_bounds;
    place.translate(shift);

    PartSpec element = layer.element;
    element.name = {name_ + "[" + index_before(static_cast<std::size_t>(k)) + std::to_string(i) + "," +
                        std::to_string(j) + "]",
                    array_.where};
    element.placement.translate = shift;
    for (const OverrideSpec& change : array_.overrides) {
      if (!selects(change.select, layer, k, i, j)) continue;
      if (change.remove) return place;
      apply(change, element);
    }
    body_.parts.push_back(std::move(element));
    return place;
  }

  void add_septa(const LayerSpec& layer, const SeptaSpec& septa, std::size_t k) {
    SheetGrid grid;
    const core::Vec3 element = layer.element_bounds.sizes();
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double pitch = layer.pitch_mm[axis], middle = layer.offset_mm[axis];
      const int count = layer.count[axis];
      const double half = 0.5 * ((count - 1) * pitch + element[static_cast<int>(axis)]);
      grid.whole[axis] = {middle - half, middle + half};
      if (!(axis == 0 ? septa.x : septa.y)) continue;
      for (int i = 1; i < count; ++i) {
        const double at = middle + (i - 0.5 * count) * pitch;
        grid.sheets[axis].push_back({at - 0.5 * septa.thickness_mm, at + 0.5 * septa.thickness_mm});
      }
    }
    const auto [low, high] = septa.height_mm.value_or(std::array<double, 2>{0.0, element.z()});
    for (SheetPiece piece : sheet_pieces(grid, grid)) {
      piece.index.insert(piece.index.find('[') + 1, index_before(k));
      body_.parts.push_back(
          sheet_part(septa.sheet, name_ + "_septum_" + piece.index, piece, height_ + low, high - low));
    }
  }

  /// Adds glue over the lateral intersection of both layers; the layer below is already placed.
  void add_glue(std::size_t below) {
    const LayerSpec& layer = array_.layers[below];
    if (!layer.glue) return;
    const LayerSpec& next = array_.layers[below + 1];
    Eigen::AlignedBox3d plate = bounds_[below];
    for (int axis = 0; axis < 2; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double half = 0.5 * ((next.count[a] - 1) * next.pitch_mm[a] + next.element_bounds.sizes()[axis]);
      plate.min()[axis] = std::max(plate.min()[axis], next.offset_mm[a] - half);
      plate.max()[axis] = std::min(plate.max()[axis], next.offset_mm[a] + half);
    }
    plate.min().z() = height_;
    plate.max().z() = height_ + layer.glue->thickness_mm;
    body_.parts.push_back(
        liquid_part(name_ + "_glue[" + std::to_string(below) + "]", plate, layer.glue->medium));
    height_ = plate.max().z();
  }

  /// Adds sheets across x, then y, then z; each covers the edges of those before it.
  void add_wrap(const WrapSpec& wrap) {
    Eigen::AlignedBox3d inner;
    for (const Eigen::AlignedBox3d& layer : bounds_) inner.extend(layer);
    const auto has = [&](int axis, int sign) {
      return std::any_of(wrap.sides.begin(), wrap.sides.end(),
                         [&](const BoxSide& s) { return s.axis == axis && s.sign == sign; });
    };
    for (int axis = 0; axis < 3; ++axis) {
      if (has(axis, -1)) inner.min()[axis] -= wrap.gap_mm;
      if (has(axis, +1)) inner.max()[axis] += wrap.gap_mm;
    }
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::AlignedBox3d outer = inner;
      for (const int sign : {-1, +1}) {
        if (!has(axis, sign)) continue;
        Eigen::AlignedBox3d sheet = inner;
        core::Vec3 &low = sheet.min(), &high = sheet.max();
        (sign < 0 ? high : low)[axis] = sign < 0 ? inner.min()[axis] : inner.max()[axis];
        (sign < 0 ? low : high)[axis] = (sign < 0 ? high : low)[axis] + sign * wrap.thickness_mm;
        outer.extend(sheet);
        body_.parts.push_back(box_part(name_ + "_wrap[" + core::word_of(kBoxSides, BoxSide{axis, sign}) + "]",
                                       sheet, wrap.sheet.medium, wrap.where));
        body_.parts.back().surface = wrap.sheet.surface;
      }
      inner = outer;
    }
  }

  /// Glue and fillers are in bonded contact with all that they touch; sheets keep the requested contact.
  void add_contacts() {
    const auto add = [&](const std::string& a, const std::string& b, ContactKind kind,
                         const config::NameRef& surface = {}) {
      body_.contacts.push_back(builder_contact(a, b, kind, array_.where, surface));
    };
    const std::string elements = name_ + "[*]", septa = name_ + "_septum*", wraps = name_ + "_wrap*";
    for (const std::string& wet : {name_ + "_filler*", name_ + "_glue*"})
      for (const std::string& other : {elements, septa, name_ + "_filler*"})
        add(wet, other, ContactKind::bonded);
    for (const LayerSpec& layer : array_.layers)
      if (layer.septa) {
        add(elements, septa, layer.septa->sheet.contact, layer.septa->sheet.surface);
        add(septa, "*", ContactKind::dry);
        break;
      }
    if (!array_.wrap) return;
    add(elements, wraps, array_.wrap->sheet.contact, array_.wrap->sheet.surface);
    add(wraps, "*", ContactKind::dry);
  }

  const ArraySpec& array_;
  std::string name_;
  BuiltBody body_;
  double height_ = 0.0;                      ///< of the bottom of the next layer
  std::vector<Eigen::AlignedBox3d> bounds_;  ///< of the elements of each layer
};

}  // namespace

BuiltBody expand(const ArraySpec& array) { return ArrayExpander(array).expand(); }

}  // namespace scintray::scene_file
