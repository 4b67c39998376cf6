#include "scintray/exchange/gdml/detail/structure.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "scintray/core/error.hpp"
#include "scintray/core/words.hpp"
#include "scintray/exchange/gdml/detail/copies.hpp"
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
  StructureReader(const GdmlFile& file, const Definitions& definitions, Solids& solids)
      : file_(file), definitions_(definitions), copies_(file, definitions, solids) {}

  Structure read() {
    remember_document(0);
    const Node world = world_of(0, file_.section("structure"));
    structure_.world_volume = reference(world);
    const Node volume = structure_.world = find(structure_.world_volume, world).node;
    structure_.world_material = reference(child(volume, "materialref"));
    structure_.world_solid = reference(child(volume, "solidref"));
    place_daughters(volume, Eigen::Affine3d::Identity(), std::nullopt);
    for (const auto& [name, element] : volumes_) structure_.volumes.push_back(name);
    return std::move(structure_);
  }

 private:
  /// <world> of the setup of a file, by G4GDMLReadSetup::GetSetup: of several setups the one called
  /// "Default".
  Node world_of(std::size_t document, Node where) const {
    Node chosen;
    for (Node setup = file_.section("setup", document); setup; setup = setup.next_sibling("setup"))
      if (!chosen || std::string(setup.attribute("name").value()) == "Default") chosen = setup;
    const Node world = chosen.child("world");
    if (!world)
      file_.reject(where, "the file does not state which volume is the world",
                   "add <setup name=\"Default\" version=\"1.0\"><world ref=\"...\"/></setup>");
    return world;
  }

  void remember_document(std::size_t document) {
    if (!remembered_.insert(document).second) return;
    for (Node section = file_.section("structure", document); section;
         section = section.next_sibling("structure"))
      definitions_.for_each_child(section, [this](Node node) { remember(node); });
  }

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
      if (!second)
        file_.reject(node, "a border between fewer than two <physvolref>s",
                     "add <physvolref ref=\"...\"/> for the volumes that light leaves and enters");
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
    // Geant4 reads a module where a volume places it.
    for_each_module(node, [this](Node module) { remember_document(file_.module_of(module)); });
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
    if (!found)
      file_.reject(node, std::string("<") + node.name() + "> has no <" + tag + ">",
                   std::string("add <") + tag + " ref=\"...\"/>");
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
      if (element == Element::replica) add_copies(node, copies_.replicas(node, volume), to_world, mother);
      if (element == Element::division) add_copies(node, copies_.divisions(node, volume), to_world, mother);
      if (element == Element::parameterised) add_copies(node, copies_.parameterised(node), to_world, mother);
    });
  }

  void place(Node physvol, const Eigen::Affine3d& mother_to_world, std::optional<std::size_t> mother) {
    const Node module = physvol.child("file");
    const Node reference_node = module ? module : child(physvol, "volumeref");
    const std::string volume = module ? volume_of(module) : reference(reference_node);
    Eigen::Affine3d own = Eigen::Translation3d(definitions_.position(physvol)) *
                          Eigen::Affine3d(rotation_matrix(definitions_.rotation(physvol)).transpose());
    own.linear() *= definitions_.scale(physvol).asDiagonal();
    if (!own.matrix().allFinite() || own.linear().determinant() == 0.0)
      file_.reject(physvol, "a placement that leaves no volume: its scale is 0 or not finite",
                   "give <scale x=\"1\" y=\"1\" z=\"1\"/>, or -1 for a mirror image");
    const std::string name =
        physvol.attribute("name") ? definitions_.name(physvol.attribute("name").value(), physvol) : volume;
    add({name, placement_of(physvol), ""}, volume, reference_node, mother_to_world * own, mother);
  }

  /// Name of the volume that a <file> places: of the module's world without `volname`. As in Geant4 names are
  /// those of all files together.
  std::string volume_of(Node module) const {
    if (const pugi::xml_attribute name = module.attribute("volname"); name && *name.value() != '\0')
      return name.value();
    return reference(world_of(file_.module_of(module), module));
  }

  struct Physvol {
    std::string name;
    std::size_t placement;
    std::string solid;  ///< of this copy; empty: that of its volume
  };

  void add(const Physvol& physvol, const std::string& volume, Node where, const Eigen::Affine3d& to_world,
           std::optional<std::size_t> mother) {
    const auto& [element, variables] = find(volume, where);
    const LoopScope scope(definitions_, variables);
    if (!inside_.insert(volume).second)
      file_.reject(where, "volume \"" + volume + "\" is placed inside itself",
                   "place another volume here; a name stands for the first volume of this name in all files");
    if (inside_.size() > 500)
      file_.reject(where, "volumes are nested more than 500 deep", "place volumes beside each other");
    if (element_of(element) == Element::assembly) {
      place_daughters(element, to_world, mother);
    } else {
      if (structure_.placed.size() >= kMostPlaced)
        file_.reject(where, "more than " + std::to_string(kMostPlaced) + " volumes are placed",
                     "import a part of the detector, or give fewer copies");
      PlacedVolume placed{physvol.name,
                          volume,
                          reference(child(element, "materialref")),
                          physvol.solid.empty() ? reference(child(element, "solidref")) : physvol.solid,
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

  /// Copies of a volume in its mother, with the name of the element, or named by their numbers.
  void add_copies(Node element, const VolumeCopies& copies, const Eigen::Affine3d& mother_to_world,
                  std::optional<std::size_t> mother) {
    const Node reference_node = child(element, "volumeref");
    const std::string volume = reference(reference_node);
    for (std::size_t copy = 0; copy < copies.copies.size(); ++copy) {
      const std::string name = element.attribute("name")
                                   ? definitions_.name(element.attribute("name").value(), element)
                                   : volume + "_" + std::to_string(copy);
      add({name, placement_of(element), copies.copies[copy].solid}, volume, reference_node,
          mother_to_world * copies.copies[copy].in_mother, mother);
    }
    for (const std::string& note : copies.notes) structure_.notes.push_back(note);
  }

  const GdmlFile& file_;
  const Definitions& definitions_;
  CopyReader copies_;
  Structure structure_;
  std::map<std::string, LoopedNode> volumes_;
  std::map<std::pair<const void*, LoopVariables>, std::size_t> placements_;
  std::set<std::string> inside_;
  std::set<std::size_t> remembered_;  ///< files whose structure is known
};

}  // namespace

Structure read_structure(const GdmlFile& file, const Definitions& definitions, Solids& solids) {
  return StructureReader(file, definitions, solids).read();
}

std::vector<double> shares_left(const Structure& structure, Solids& solids) {
  std::vector<double> shares;
  for (const PlacedVolume& placed : structure.placed) {
    double volume_mm3 = 0.0;
    try {
      volume_mm3 = std::abs(placed.to_world.linear().determinant()) *
                   solids.mesh(placed.solid, placed.element).volume();
    } catch (const core::InputError&) {
      // Stated where its part is made.
    }
    shares.push_back(volume_mm3);
  }
  std::vector<double> taken(shares.size(), 0.0);
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (const auto& mother = structure.placed[i].mother) taken[*mother] += shares[i];
  for (std::size_t i = 0; i < shares.size(); ++i)
    shares[i] = shares[i] > 0.0 ? std::max(0.0, 1.0 - taken[i] / shares[i]) : 1.0;
  return shares;
}

Neighbours::Neighbours(const Structure& structure) : structure_(structure) {
  for (std::size_t i = 0; i < structure_.placed.size(); ++i) {
    const PlacedVolume& placed = structure_.placed[i];
    Copies& copies = copies_[placed.physvol];
    if (!copies.all.empty() && placed.placement != structure_.placed[copies.all.front()].placement) continue;
    copies.all.push_back(i);
    copies.by_mother[placed.mother].push_back(i);
  }
}

const Neighbours::Copies& Neighbours::copies_of(const std::string& physvol) const {
  static const Copies none;
  const auto found = copies_.find(physvol);
  return found == copies_.end() ? none : found->second;
}

void Neighbours::visit(const Copies& from, const Copies& to,
                       const std::function<void(std::size_t, std::size_t)>& visitor) const {
  if (from.all.size() > to.all.size())
    return visit(to, from, [&visitor](std::size_t b, std::size_t a) { visitor(a, b); });
  for (const std::size_t a : from.all) {
    const std::optional<std::size_t> mother = structure_.placed[a].mother;
    if (mother && std::binary_search(to.all.begin(), to.all.end(), *mother)) visitor(a, *mother);
    for (const std::optional<std::size_t>& of : {std::optional(a), mother})
      if (const auto found = to.by_mother.find(of); found != to.by_mother.end())
        for (const std::size_t b : found->second)
          if (a != b) visitor(a, b);
  }
}

}  // namespace scintray::exchange::gdml
