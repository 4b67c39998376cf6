#include "scintray/scene_file/detail/light_guide.hpp"

namespace scintray::scene_file {

namespace {

class LightGuideExpander {
 public:
  explicit LightGuideExpander(const LightGuideSpec& guide) : guide_(guide), name_(guide.name.name) {}

  BuiltBody expand() {
    const double height = guide_.height_mm, depth = guide_.slit_depth_mm;
    slits_low_ = guide_.slits_from_top ? height - depth : 0.0;
    slits_high_ = guide_.slits_from_top ? height : depth;
    if (depth < height) add_base();
    for (int j = 0; j < guide_.segments[1]; ++j)
      for (int i = 0; i < guide_.segments[0]; ++i) add_segment(i, j);
    if (guide_.slit_sheet) add_sheets(*guide_.slit_sheet);
    return std::move(body_);
  }

 private:
  double width(std::size_t axis, double z) const {
    const double low = guide_.bottom_mm[axis], high = guide_.top_mm[axis];
    return low + (high - low) * z / guide_.height_mm;
  }

  /// Position (mm) of the edge between cells i - 1 and i at a height; the first and the last are the guide's
  /// own sides.
  double edge(std::size_t axis, int i, double z) const {
    return (static_cast<double>(i) / guide_.segments[axis] - 0.5) * width(axis, z);
  }

  Interval cell(std::size_t axis, int i, double z) const {
    const double half = 0.5 * guide_.slit_width_mm;
    return {edge(axis, i, z) + (i > 0 ? half : 0.0),
            edge(axis, i + 1, z) - (i + 1 < guide_.segments[axis] ? half : 0.0)};
  }

  PartSpec frustum(const std::string& name, const mesh::Rectangle& bottom, const mesh::Rectangle& top,
                   double low, double high) const {
    PartSpec part;
    part.name = {name, guide_.where};
    part.where = guide_.where;
    part.shape = TaperedSpec{bottom, top, high - low, guide_.where};
    part.placement.translate = core::Vec3(0.0, 0.0, low);
    part.medium = guide_.medium;
    part.surface = guide_.surface;
    return part;
  }

  void add_face(PartSpec& part, const std::string& group, const config::NameRef& surface) const {
    if (surface.empty()) return;
    FaceRuleSpec rule;
    rule.name = group;
    rule.select.group = {group, guide_.where};
    rule.select.where = rule.where = guide_.where;
    rule.surface = surface;
    part.faces.push_back(std::move(rule));
  }

  void add_base() {
    const double low = guide_.slits_from_top ? 0.0 : slits_high_;
    const double high = guide_.slits_from_top ? slits_low_ : guide_.height_mm;
    const auto whole = [&](double z) { return rectangle_of(cell_of_all(0, z), cell_of_all(1, z)); };
    PartSpec base = frustum(name_ + "_base", whole(low), whole(high), low, high);
    add_face(base, guide_.slits_from_top ? "-z" : "+z", guide_.end_surface);
    add_face(base, guide_.slits_from_top ? "+z" : "-z", guide_.slit_surface);
    body_.parts.push_back(std::move(base));
    ContactSpec joint = builder_contact(name_ + "_base", name_ + "[*]", ContactKind::bonded, guide_.where);
    joint.joint = true;
    body_.contacts.push_back(std::move(joint));
  }

  Interval cell_of_all(std::size_t axis, double z) const {
    return {edge(axis, 0, z), edge(axis, guide_.segments[axis], z)};
  }

  void add_segment(int i, int j) {
    const auto at = [&](double z) { return rectangle_of(cell(0, i, z), cell(1, j, z)); };
    PartSpec segment = frustum(name_ + "[" + std::to_string(i) + "," + std::to_string(j) + "]",
                               at(slits_low_), at(slits_high_), slits_low_, slits_high_);
    if (i > 0) add_face(segment, "-x", guide_.slit_surface);
    if (i + 1 < guide_.segments[0]) add_face(segment, "+x", guide_.slit_surface);
    if (j > 0) add_face(segment, "-y", guide_.slit_surface);
    if (j + 1 < guide_.segments[1]) add_face(segment, "+y", guide_.slit_surface);
    const bool through = guide_.slit_depth_mm >= guide_.height_mm;
    if (through || !guide_.slits_from_top) add_face(segment, "-z", guide_.end_surface);
    if (through || guide_.slits_from_top) add_face(segment, "+z", guide_.end_surface);
    body_.parts.push_back(std::move(segment));
  }

  SheetGrid grid(double z) const {
    SheetGrid grid;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      grid.whole[axis] = cell_of_all(axis, z);
      for (int i = 1; i < guide_.segments[axis]; ++i)
        grid.sheets[axis].push_back({cell(axis, i - 1, z).high, cell(axis, i, z).low});
    }
    return grid;
  }

  void add_sheets(const SheetSpec& sheet) {
    const std::string sheets = name_ + "_slit*";
    for (const SheetPiece& piece : sheet_pieces(grid(slits_low_), grid(slits_high_)))
      body_.parts.push_back(
          sheet_part(sheet, name_ + "_slit_" + piece.index, piece, slits_low_, slits_high_ - slits_low_));
    for (const std::string& guide : {name_ + "[*]", name_ + "_base"})
      body_.contacts.push_back(builder_contact(guide, sheets, sheet.contact, sheet.where, sheet.surface));
    body_.contacts.push_back(builder_contact(sheets, "*", ContactKind::dry, sheet.where));
  }

  const LightGuideSpec& guide_;
  std::string name_;
  BuiltBody body_;
  double slits_low_ = 0.0, slits_high_ = 0.0;
};

}  // namespace

BuiltBody expand(const LightGuideSpec& guide) { return LightGuideExpander(guide).expand(); }

}  // namespace scintray::scene_file
