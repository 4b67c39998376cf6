#include "scintray/exchange/gdml/detail/solids.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "scintray/core/words.hpp"
#include "scintray/exchange/gdml/detail/solid_reader.hpp"
#include "scintray/mesh/boolean.hpp"
#include "scintray/mesh/diagnosis.hpp"
#include "scintray/mesh/recognize.hpp"
#include "scintray/mesh/shapes/primitives.hpp"

namespace scintray::exchange::gdml {

namespace {

/// Kinds of solids that are made of others.
enum class Composition { boolean, unions, moved };
constexpr core::Word<Composition> kCompositions[] = {
    {"union", Composition::unions},         {"subtraction", Composition::boolean},
    {"intersection", Composition::boolean}, {"multiUnion", Composition::unions},
    {"reflectedSolid", Composition::moved}, {"scaledSolid", Composition::moved}};
constexpr core::Word<mesh::BooleanOperation> kBooleans[] = {
    {"subtraction", mesh::BooleanOperation::subtract}, {"intersection", mesh::BooleanOperation::intersect}};

/// Solids whose sides are flat however many they are.
constexpr core::Word<bool> kFlatSided[] = {
    {"polyhedra", true}, {"genericPolyhedra", true}, {"xtru", true}, {"tessellated", true}};
/// Largest coordinate of a solid: no detector is larger, and discs of any size would be cut in any number of
/// sectors.
constexpr double kLargest_mm = 1e9;

/// Distance within which corners are on a round face: the contact tolerance of a scene without its own.
constexpr double kCornersOnSurface_mm = 1e-4;

/// The mesh of a solid that is not a boolean; empty for an unsupported kind. Dimensions are defined in the
/// GDML User's Guide (CERN), chapter "Solids".
/// @throws InputError for impossible dimensions, without a place.
std::optional<mesh::TriMesh> make_simple_solid(Node solid, const Definitions& definitions,
                                               const mesh::Tessellation& tessellation) {
  std::optional<mesh::TriMesh> made = make_flat_solid(solid, definitions, tessellation);
  if (!made) made = make_round_solid(solid, definitions, tessellation);
  return made ? std::move(made) : make_twisted_solid(solid, definitions, tessellation);
}

/// True for solids of revolution whose walls cannot cross, by the dimensions that their makers accept: a
/// search for triangles that cross would take the square of their number where a disc is cut in thousands of
/// sectors.
bool is_sound_by_construction(Node solid, const Definitions& definitions) {
  const std::string_view kind = solid.name();
  if (kind != "cone")
    return kind == "tube" || kind == "cutTube" || kind == "sphere" || kind == "orb" || kind == "torus";
  const auto length = [&](const char* attribute) { return definitions.length(solid, attribute); };
  return length("rmin1") >= 0.0 && length("rmin1") < length("rmax1") && length("rmin2") >= 0.0 &&
         length("rmin2") < length("rmax2");
}

/// The placement of the second solid of a boolean in Geant4: rotated by the rotation itself, then moved.
Eigen::Affine3d placement(const core::Vec3& position, const core::Vec3& angles_rad) {
  return Eigen::Translation3d(position) * Eigen::Affine3d(rotation_matrix(angles_rad));
}

}  // namespace

Eigen::Matrix3d rotation_matrix(const core::Vec3& angles_rad) {
  return (Eigen::AngleAxisd(angles_rad.z(), core::Vec3::UnitZ()) *
          Eigen::AngleAxisd(angles_rad.y(), core::Vec3::UnitY()) *
          Eigen::AngleAxisd(angles_rad.x(), core::Vec3::UnitX()))
      .toRotationMatrix();
}

Solids::Solids(const GdmlFile& file, const Definitions& definitions, const mesh::Tessellation& tessellation)
    : file_(file), definitions_(definitions), tessellation_(tessellation) {
  definitions_.for_each_of("solids", [this](Node node) {
    const std::string name = definitions_.name(file_.required(node, "name"), node);
    const bool is_surface = std::string(node.name()) == "opticalsurface";
    if (!(is_surface ? surfaces_ : solids_)
             .emplace(name, LoopedNode{node, definitions_.loop_variables()})
             .second)
      notes_.push_back(std::string("a second ") + (is_surface ? "optical surface" : "solid") + " \"" + name +
                       "\": the first is used, as in Geant4");
  });
}

Node Solids::optical_surface(const std::string& name) const {
  const auto found = surfaces_.find(name);
  return found == surfaces_.end() ? Node() : found->second.node;
}

std::optional<core::Vec3> Solids::box_sides(const std::string& name, Node where) const {
  const auto& [solid, variables] = find(name, where);
  if (std::string_view(solid.name()) != "box") return std::nullopt;
  const LoopScope scope(definitions_, variables);
  return core::Vec3(definitions_.length(solid, "x"), definitions_.length(solid, "y"),
                    definitions_.length(solid, "z"));
}

std::optional<std::string> Solids::exact_shape(const std::string& name, Node where) const {
  const auto& [solid, variables] = find(name, where);
  const LoopScope scope(definitions_, variables);
  return gdml::exact_shape(solid, definitions_, tessellation_);
}

Node Solids::added_beside(Node origin) {
  constexpr const char* kAdded = "solids_of_copies";
  Node root = origin.root();
  Node added = root.child(kAdded);
  return added ? added : root.append_child(kAdded);
}

Node Solids::new_element(const std::string& kind, Node origin) {
  Node element = added_beside(origin).append_child(kind.c_str());
  element.append_attribute("lunit") = "mm";
  element.append_attribute("aunit") = "rad";
  return element;
}

std::string Solids::add(Node element, Node origin) {
  const std::string base = std::string(element.name()) + "_of_a_copy_";
  std::string name;
  do name = base + std::to_string(origins_.size());
  while (solids_.contains(name) || origins_.contains(name));
  Node added = added_beside(origin);
  Node own = element.parent() == added ? element : added.append_copy(element);
  own.remove_attribute("name");
  own.append_attribute("name") = name.c_str();
  solids_.emplace(name, LoopedNode{own, definitions_.loop_variables()});
  origins_.emplace(name, origin);
  return name;
}

core::FileLocation Solids::where(const std::string& name, Node solid) const {
  const auto added = origins_.find(name);
  return file_.where(added == origins_.end() ? solid : added->second);
}

const LoopedNode& Solids::find(const std::string& name, Node where) const {
  const auto found = solids_.find(name);
  if (found == solids_.end())
    file_.reject(where, "no solid is called \"" + name + "\"", "define it in <solids>");
  return found->second;
}

const mesh::TriMesh& Solids::mesh(const std::string& name, Node where) {
  if (const auto done = made_.find(name); done != made_.end()) return done->second;
  const auto& [solid, variables] = find(name, where);
  const LoopScope scope(definitions_, variables);
  const Entered entered(*this, name, solid);
  mesh::TriMesh mesh;
  try {
    mesh = make(solid);
    if (mesh.triangles.empty())
      throw core::InputError(
          {{},
           "it has no volume within rounding",
           "check its dimensions and their units: the largest may be millions of times the smallest, or "
           "nothing is left of it"});
  } catch (const core::InputError& error) {
    std::vector<core::Problem> problems = error.problems();
    for (core::Problem& problem : problems) {
      if (!problem.where.file.empty()) continue;
      if (problem.hint.empty())
        problem.hint =
            "check its dimensions and their units; --skip-unsupported leaves out the volumes of solids that "
            "cannot be made";
      problem.where = this->where(name, solid);
      problem.what = "solid \"" + name + "\" (" + solid.name() + "): " + problem.what;
    }
    throw core::InputError(std::move(problems));
  }
  return made_.emplace(name, std::move(mesh)).first->second;
}

Solids::Entered::Entered(Solids& solids, const std::string& name, Node solid)
    : making_(solids.in_the_making_) {
  if (std::find(making_.begin(), making_.end(), name) != making_.end())
    solids.file_.reject(solid, "solid \"" + name + "\" contains itself",
                        "refer to solids that are made without it");
  constexpr std::size_t kDeepest = 500;
  if (making_.size() >= kDeepest)
    solids.file_.reject(solid, "booleans are nested more than 500 deep",
                        "write them as a <multiUnion>, or as a tessellated solid");
  making_.push_back(name);
}

bool Solids::is_round(const std::string& name, Node where) {
  const auto [known, is_new] = round_.try_emplace(name, false);
  if (!is_new) return known->second;
  mesh::TriMesh copy = mesh(name, where);
  const auto& [solid, variables] = find(name, where);
  const LoopScope scope(definitions_, variables);
  known->second = !has_flat_sides(solid) && !mesh::recognize_round_faces(copy, kCornersOnSurface_mm).empty();
  return known->second;
}

bool Solids::has_flat_sides(Node solid) const {
  if (core::find_word(kFlatSided, solid.name())) return true;
  for (const std::string& operand : operands(solid))
    if (has_flat_sides(element(operand, solid))) return true;
  return false;
}

std::vector<std::string> Solids::operands(Node solid) const {
  std::vector<std::string> names;
  const auto add = [&](Node node, const char* attribute) {
    if (node) names.push_back(definitions_.name(file_.required(node, attribute), node));
  };
  const std::optional<Composition> kind = core::find_word(kCompositions, solid.name());
  for (const char* tag : {"first", "second"}) add(solid.child(tag), "ref");
  for (const Node node : solid.children("multiUnionNode")) add(node.child("solid"), "ref");
  if (kind == Composition::moved && solid.attribute("solid"))
    add(solid, "solid");
  else if (kind == Composition::moved)
    add(solid.child("solidref"), "ref");
  return names;
}

mesh::TriMesh Solids::make(Node solid) {
  if (const std::optional<Composition> kind = core::find_word(kCompositions, solid.name()))
    return kind == Composition::boolean  ? make_boolean(solid)
           : kind == Composition::unions ? make_union(solid)
                                         : make_transformed(solid);
  std::optional<mesh::TriMesh> mesh = make_simple_solid(solid, definitions_, tessellation_);
  if (!mesh)
    throw core::InputError(
        core::Problem{{},
                      "solids of this kind cannot be made",
                      "write it as a tessellated solid, or leave out the volumes that use it with "
                      "--skip-unsupported"});
  for (const core::Vec3& vertex : mesh->vertices)
    if (!(vertex.cwiseAbs().maxCoeff() <= kLargest_mm))
      throw core::InputError({{}, "it is larger than 1000 km", "check its dimensions and their units"});
  if (is_sound_by_construction(solid, definitions_)) return std::move(*mesh);
  if (const std::vector<core::Problem> problems =
          mesh::mesh_problems(mesh::diagnose(*mesh), solid.attribute("name").value());
      !problems.empty())
    throw core::InputError(problems);
  return std::move(*mesh);
}

mesh::TriMesh Solids::referred(Node reference) {
  return mesh(definitions_.name(file_.required(reference, "ref"), reference), reference);
}

void Solids::add_bodies(Node solid, const Eigen::Affine3d& to, std::vector<mesh::TriMesh>& bodies) {
  const auto add = [&](Node reference, const Eigen::Affine3d& own) {
    const std::string name = definitions_.name(file_.required(reference, "ref"), reference);
    const auto& [operand, variables] = find(name, reference);
    if (std::string_view(operand.name()) != "union" || made_.contains(name)) {
      bodies.push_back(mesh::transformed(mesh(name, reference), to * own));
      return;
    }
    const LoopScope scope(definitions_, variables);
    const Entered entered(*this, name, operand);
    add_bodies(operand, to * own, bodies);
  };
  for (const Node node : solid.children("multiUnionNode")) {
    const Node reference = node.child("solid");
    if (!reference) file_.reject(node, "<multiUnionNode> has no <solid>", "add <solid ref=\"...\"/>");
    add(reference, placement(definitions_.position(node), definitions_.rotation(node)));
  }
  if (std::string_view(solid.name()) != "union") return;
  const auto operand = [&](const char* tag) {
    const Node reference = solid.child(tag);
    if (!reference)
      file_.reject(solid, std::string("a boolean has no <") + tag + ">",
                   std::string("add <") + tag + " ref=\"...\"/>");
    return reference;
  };
  add(operand("first"), placement(definitions_.position(solid, "firstposition"),
                                  definitions_.rotation(solid, "firstrotation")));
  add(operand("second"), placement(definitions_.position(solid), definitions_.rotation(solid)));
}

/// The union of several bodies, always of the two with the fewest triangles, so that large ones are cut few
/// times. Programs write a union of many as a chain of unions of two, in which the first is cut by all.
mesh::TriMesh Solids::make_union(Node solid) {
  std::vector<mesh::TriMesh> bodies;
  add_bodies(solid, Eigen::Affine3d::Identity(), bodies);
  if (bodies.empty())
    file_.reject(solid, "<multiUnion> has no <multiUnionNode>",
                 "add <multiUnionNode name=\"...\"><solid ref=\"...\"/></multiUnionNode>");
  const auto larger = [](const mesh::TriMesh& a, const mesh::TriMesh& b) {
    return a.triangles.size() > b.triangles.size();
  };
  std::stable_sort(bodies.begin(), bodies.end(), larger);
  while (bodies.size() > 1) {
    const mesh::TriMesh last = std::move(bodies.back());
    bodies.pop_back();
    mesh::TriMesh both = mesh::combine(bodies.back(), last, mesh::BooleanOperation::unite);
    bodies.pop_back();
    bodies.insert(std::upper_bound(bodies.begin(), bodies.end(), both, larger), std::move(both));
  }
  return std::move(bodies.front());
}

/// reflectedSolid: scaled by sx, sy, sz, then rotated, then moved by dx, dy, dz. scaledSolid: scaled by
/// <scale>.
mesh::TriMesh Solids::make_transformed(Node solid) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  core::Vec3 scale;
  std::string name;
  if (solid.attribute("solid")) {
    const auto angle = [&](const char* attribute) { return definitions_.angle(solid, attribute); };
    const auto factor = [&](const char* attribute) { return definitions_.number(solid, attribute, 1.0); };
    transform = placement({definitions_.length(solid, "dx"), definitions_.length(solid, "dy"),
                           definitions_.length(solid, "dz")},
                          {angle("rx"), angle("ry"), angle("rz")});
    scale = {factor("sx"), factor("sy"), factor("sz")};
    name = definitions_.name(solid.attribute("solid").value(), solid);
  } else {
    const Node reference = solid.child("solidref");
    if (!reference)
      file_.reject(solid, std::string("<") + solid.name() + "> refers to no solid",
                   "add <solidref ref=\"...\"/>");
    scale = definitions_.scale(solid);
    name = definitions_.name(file_.required(reference, "ref"), reference);
  }
  transform.linear() *= scale.asDiagonal();
  if (!(transform.linear().determinant() != 0.0)) mesh::reject_shape("a scale is 0");
  return mesh::transformed(mesh(name, solid), transform);
}

mesh::TriMesh Solids::make_boolean(Node solid) {
  const auto operand = [&](const char* tag) {
    const Node reference = solid.child(tag);
    if (!reference)
      file_.reject(solid, std::string("a boolean has no <") + tag + ">",
                   std::string("add <") + tag + " ref=\"...\"/>");
    return referred(reference);
  };
  const mesh::TriMesh first =
      mesh::transformed(operand("first"), placement(definitions_.position(solid, "firstposition"),
                                                    definitions_.rotation(solid, "firstrotation")));
  const mesh::TriMesh second = mesh::transformed(
      operand("second"), placement(definitions_.position(solid), definitions_.rotation(solid)));
  mesh::TriMesh result = mesh::combine(first, second, *core::find_word(kBooleans, solid.name()));
  if (result.triangles.empty())
    throw core::InputError(
        core::Problem{{}, "nothing is left of the boolean", "check where its two solids lie"});
  return result;
}

}  // namespace scintray::exchange::gdml
