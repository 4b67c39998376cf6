#include "scintray/exchange/gdml/detail/structure.hpp"

#include <cmath>
#include <map>
#include <set>

#include "scintray/core/words.hpp"
#include "scintray/exchange/gdml/detail/solids.hpp"

namespace scintray::exchange::gdml {

namespace {

/// Kinds of the elements of <structure> and of a volume.
enum class Element { volume, assembly, skin, border, placement, replica, division, parameterised };
constexpr core::Word<Element> kElements[] = {
    {"volume", Element::volume},        {"assembly", Element::assembly},     {"skinsurface", Element::skin},
    {"bordersurface", Element::border}, {"physvol", Element::placement},     {"replicavol", Element::replica},
    {"divisionvol", Element::division}, {"paramvol", Element::parameterised}};

std::optional<Element> element_of(Node node) { return core::find_word(kElements, node.name()); }

class StructureReader {
 public:
  StructureReader(const GdmlFile& file, const Definitions& definitions)
      : file_(file), definitions_(definitions) {}

  Structure read() {
    definitions_.for_each_child(file_.section("structure"), [this](Node node) { remember(node); });
    const Node world = file_.section("setup").child("world");
    if (!world)
      file_.reject(file_.section("structure"), "the file does not state which volume is the world",
                   "add <setup name=\"Default\" version=\"1.0\"><world ref=\"...\"/></setup>");
    structure_.world_volume = reference(world);
    const Node volume = find(structure_.world_volume, world).node;
    structure_.world_material = reference(child(volume, "materialref"));
    structure_.world_solid = reference(child(volume, "solidref"));
    place_daughters(volume, Eigen::Affine3d::Identity(), std::nullopt);
    return std::move(structure_);
  }

 private:
  void remember(Node node) {
    const std::optional<Element> element = element_of(node);
    if (element == Element::volume || element == Element::assembly) {
      remember_volume(node);
    } else if (element == Element::skin) {
      structure_.surfaces.push_back(
          {file_.required(node, "surfaceproperty"), reference(child(node, "volumeref")), "", "", node});
    } else if (element == Element::border) {
      const Node first = child(node, "physvolref");
      const Node second = first.next_sibling("physvolref");
      if (!second) file_.reject(node, "a border between fewer than two <physvolref>s");
      structure_.surfaces.push_back(
          {file_.required(node, "surfaceproperty"), "", reference(first), reference(second), node});
    } else {
      structure_.notes.push_back(std::string("<") + node.name() + "> in <structure>");
    }
  }

  /// Of several volumes of one name the first is used, as G4LogicalVolumeStore returns it.
  void remember_volume(Node node) {
    const std::string name = definitions_.name(file_.required(node, "name"), node);
    if (!volumes_.try_emplace(name, LoopedNode{node, definitions_.loop_variables()}).second)
      structure_.notes.push_back("a second volume \"" + name + "\": the first is used, as in Geant4");
    for (const Node inner : node.children()) {
      const std::optional<Element> element = element_of(inner);
      if (element != Element::border && element != Element::skin) continue;
      remember(inner);
      structure_.notes.push_back(std::string("<") + inner.name() + "> \"" + inner.attribute("name").value() +
                                 "\" stands within <volume name=\"" + name +
                                 "\">, where Geant4 passes over it: it is taken over");
    }
  }

  /// Number of a physical volume: those of one element and the same steps of its loops are one.
  std::size_t placement_of(Node physvol) {
    return placements_
        .try_emplace({physvol.internal_object(), definitions_.loop_variables()}, placements_.size())
        .first->second;
  }

  Node child(Node node, const char* tag) const {
    const Node found = node.child(tag);
    if (!found) file_.reject(node, std::string("<") + node.name() + "> has no <" + tag + ">");
    return found;
  }

  std::string reference(Node node) const { return definitions_.name(file_.required(node, "ref"), node); }

  const LoopedNode& find(const std::string& name, Node where) const {
    const auto found = volumes_.find(name);
    if (found == volumes_.end())
      file_.reject(where, "no volume is called \"" + name + "\"", "define it in <structure>");
    return found->second;
  }

  void place_daughters(Node volume, const Eigen::Affine3d& to_world, std::optional<std::size_t> mother) {
    definitions_.for_each_child(volume, [&](Node node) {
      const std::optional<Element> element = element_of(node);
      if (element == Element::placement) place(node, to_world, mother);
      if (element == Element::replica) replicate(node, to_world, mother);
      if (element == Element::division) divide(node, volume, to_world, mother);
      if (element == Element::parameterised)
        file_.reject(node, std::string("<") + node.name() + "> is not read",
                     "write its copies as <physvol>s");
    });
  }

  void place(Node physvol, const Eigen::Affine3d& mother_to_world, std::optional<std::size_t> mother) {
    if (const Node other = physvol.child("file"))
      file_.reject(other,
                   std::string("the volume is in another file, \"") + other.attribute("name").value() + "\"",
                   "merge both files, or import each by itself");
    const Node reference_node = child(physvol, "volumeref");
    const std::string volume = reference(reference_node);
    Eigen::Affine3d own = Eigen::Translation3d(definitions_.position(physvol)) *
                          Eigen::Affine3d(rotation_matrix(definitions_.rotation(physvol)).transpose());
    own.linear() *= definitions_.scale(physvol).asDiagonal();
    if (!own.matrix().allFinite() || own.linear().determinant() == 0.0)
      file_.reject(physvol, "a placement that leaves no volume: its scale is 0 or not finite");
    const std::string name =
        physvol.attribute("name") ? definitions_.name(physvol.attribute("name").value(), physvol) : volume;
    add({name, placement_of(physvol)}, volume, reference_node, mother_to_world * own, mother);
  }

  struct Physvol {
    std::string name;
    std::size_t placement;
  };

  void add(const Physvol& physvol, const std::string& volume, Node where, const Eigen::Affine3d& to_world,
           std::optional<std::size_t> mother) {
    const auto& [element, variables] = find(volume, where);
    const LoopScope scope(definitions_, variables);
    if (!inside_.insert(volume).second)
      file_.reject(where, "volume \"" + volume + "\" is placed inside itself");
    if (inside_.size() > 500) file_.reject(where, "volumes are nested more than 500 deep");
    if (element_of(element) == Element::assembly) {
      place_daughters(element, to_world, mother);
    } else {
      if (structure_.placed.size() >= kMostPlaced)
        file_.reject(where, "more than " + std::to_string(kMostPlaced) + " volumes are placed");
      PlacedVolume placed{physvol.name,
                          volume,
                          reference(child(element, "materialref")),
                          reference(child(element, "solidref")),
                          element,
                          to_world,
                          mother,
                          "",
                          physvol.placement};
      for (const Node auxiliary : element.children("auxiliary"))
        if (std::string(auxiliary.attribute("auxtype").value()) == "SensDet")
          placed.sensitive = auxiliary.attribute("auxvalue").value();
      structure_.placed.push_back(std::move(placed));
      place_daughters(element, to_world, structure_.placed.size() - 1);
    }
    inside_.erase(volume);
  }

  /// Copies of a volume in its mother, named by their numbers.
  template <typename Shift>
  void add_copies(Node element, int count, const Eigen::Affine3d& mother_to_world,
                  std::optional<std::size_t> mother, const Shift& shift) {
    const Node reference_node = child(element, "volumeref");
    const std::string volume = reference(reference_node);
    for (int copy = 0; copy < count; ++copy)
      add({volume + "_" + std::to_string(copy), placement_of(element)}, volume, reference_node,
          mother_to_world * shift(copy), mother);
  }

  int copy_count(Node element, double count) const {
    if (!(count >= 1.0 && count <= static_cast<double>(kMostPlaced)))
      file_.reject(element, std::string("<") + element.name() + "> has no number of copies from 1 on",
                   "give number=\"...\"");
    return static_cast<int>(count);
  }

  /// Copies side by side along an axis of the mother, centred in it, whose number * width is its extent; or,
  /// about its z axis, side by side from the offset on (G4PVReplica: the middle of copy n is at offset + (n +
  /// 1/2) width).
  void replicate(Node replica, const Eigen::Affine3d& mother_to_world, std::optional<std::size_t> mother) {
    const int count = copy_count(replica, definitions_.number(replica, "number"));
    const Node along = child(replica, "replicate_along_axis"), direction = child(along, "direction");
    const Node width_node = child(along, "width"), offset_node = along.child("offset");
    const core::Vec3 axis(definitions_.number(direction, "x", 0.0), definitions_.number(direction, "y", 0.0),
                          definitions_.number(direction, "z", 0.0));
    const bool about_z = definitions_.number(direction, "phi", 0.0) == 1.0;
    if (direction.attribute("rho") || (about_z ? axis.norm() != 0.0 : axis.norm() != 1.0))
      file_.reject(replica, "replicas other than along x, y, z or phi are not read",
                   "write them as <physvol>s");
    const double width =
        definitions_.number(width_node, "value") * definitions_.number(width_node, "unit", 1.0);
    const double offset = offset_node ? definitions_.number(offset_node, "value", 0.0) *
                                            definitions_.number(offset_node, "unit", 1.0)
                                      : 0.0;
    add_copies(replica, count, mother_to_world, mother, [&](int copy) {
      if (about_z)
        return Eigen::Affine3d(Eigen::AngleAxisd(offset + (copy + 0.5) * width, core::Vec3::UnitZ()));
      return Eigen::Affine3d(Eigen::Translation3d(axis * (width * (copy - 0.5 * (count - 1)))));
    });
  }

  /// The length of a box along an axis; rejects other solids.
  double box_length(Node division, Node volume, const char* axis) const {
    const std::string name = reference(child(volume, "solidref"));
    const Node box = file_.section("solids").find_child_by_attribute("box", "name", name.c_str());
    if (!box)
      file_.reject(division, "divisions of other solids than boxes are not read: \"" + name + "\" is none",
                   "write the copies as <physvol>s");
    return definitions_.length(box, axis);
  }

  /// Divisions of a box along x, y or z (G4PVDivision): from the offset on, by number, width or both.
  void divide(Node division, Node volume, const Eigen::Affine3d& mother_to_world,
              std::optional<std::size_t> mother) {
    static constexpr core::Word<int> kAxes[] = {{"kXAxis", 0}, {"kYAxis", 1}, {"kZAxis", 2}};
    static constexpr const char* kLengths[] = {"x", "y", "z"};
    const std::optional<int> axis = core::find_word(kAxes, division.attribute("axis").value());
    if (!axis)
      file_.reject(division, "divisions other than along kXAxis, kYAxis or kZAxis are not read",
                   "write the copies as <physvol>s");
    const double extent = box_length(division, volume, kLengths[*axis]);
    const double unit = definitions_.number(division, "unit", 1.0);
    const double offset = definitions_.number(division, "offset", 0.0) * unit;
    double width = definitions_.number(division, "width", 0.0) * unit;
    double number = definitions_.number(division, "number", 0.0);
    constexpr double kRounding = 1e-9;
    if (width > 0.0 && number == 0.0) number = std::floor((extent - offset) / width * (1.0 + kRounding));
    const int count = copy_count(division, number);
    if (width == 0.0) width = (extent - offset) / count;
    const Node divided_node = child(division, "volumeref");
    const double own =
        box_length(division, find(reference(divided_node), divided_node).node, kLengths[*axis]);
    if (!(std::abs(own - width) <= 1e-6 * extent))
      file_.reject(division,
                   "the copies of a division are " + std::to_string(width) + " mm wide, and their solid is " +
                       std::to_string(own) + " mm: Geant4 gives it another length",
                   "give the solid that length");
    add_copies(division, count, mother_to_world, mother, [&](int copy) {
      const double middle = -0.5 * extent + offset + (copy + 0.5) * width;
      return Eigen::Affine3d(Eigen::Translation3d(core::Vec3::Unit(*axis) * middle));
    });
  }

  const GdmlFile& file_;
  const Definitions& definitions_;
  Structure structure_;
  std::map<std::string, LoopedNode> volumes_;
  std::map<std::pair<const void*, LoopVariables>, std::size_t> placements_;
  std::set<std::string> inside_;
};

}  // namespace

Structure read_structure(const GdmlFile& file, const Definitions& definitions) {
  return StructureReader(file, definitions).read();
}

}  // namespace scintray::exchange::gdml
