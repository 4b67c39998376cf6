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

constexpr core::Word<mesh::BooleanOperation> kBooleans[] = {
    {"union", mesh::BooleanOperation::unite},
    {"subtraction", mesh::BooleanOperation::subtract},
    {"intersection", mesh::BooleanOperation::intersect}};

/// Solids whose sides are flat however many they are.
constexpr core::Word<bool> kFlatSided[] = {
    {"polyhedra", true}, {"genericPolyhedra", true}, {"xtru", true}, {"tessellated", true}};
/// Distance within which corners are on a round face: the contact tolerance of a scene without its own.
constexpr double kCornersOnSurface_mm = 1e-4;

/// The mesh of a solid that is not a boolean; empty for an unsupported kind. Dimensions are defined in the
/// GDML User's Guide (CERN), chapter "Solids".
/// @throws InputError for impossible dimensions, without a place.
std::optional<mesh::TriMesh> make_simple_solid(Node solid, const Definitions& definitions,
                                               const mesh::Tessellation& tessellation) {
  std::optional<mesh::TriMesh> made = make_flat_solid(solid, definitions, tessellation);
  return made ? std::move(made) : make_round_solid(solid, definitions, tessellation);
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
  definitions_.for_each_child(file_.section("solids"), [this](Node node) {
    const std::string name = definitions_.name(file_.required(node, "name"), node);
    auto& known = std::string(node.name()) == "opticalsurface" ? surfaces_ : solids_;
    if (!known.emplace(name, LoopedNode{node, definitions_.loop_variables()}).second)
      file_.reject(node, "the name \"" + name + "\" is already taken", "give every solid a name of its own");
  });
}

Node Solids::optical_surface(const std::string& name) const {
  const auto found = surfaces_.find(name);
  return found == surfaces_.end() ? Node() : found->second.node;
}

Node Solids::element(const std::string& name, Node where) const { return find(name, where).node; }

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
  if (std::find(in_the_making_.begin(), in_the_making_.end(), name) != in_the_making_.end())
    file_.reject(solid, "solid \"" + name + "\" contains itself");
  constexpr std::size_t kDeepest = 500;
  if (in_the_making_.size() >= kDeepest) file_.reject(solid, "booleans are nested more than 500 deep");
  in_the_making_.push_back(name);
  mesh::TriMesh mesh;
  try {
    mesh = make(solid);
  } catch (const core::InputError& error) {
    std::vector<core::Problem> problems = error.problems();
    for (core::Problem& problem : problems) {
      if (!problem.where.file.empty()) continue;
      problem.where = file_.where(solid);
      problem.what = "solid \"" + name + "\" (" + solid.name() + "): " + problem.what;
    }
    throw core::InputError(std::move(problems));
  }
  in_the_making_.pop_back();
  return made_.emplace(name, std::move(mesh)).first->second;
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
  for (const char* tag : {"first", "second"})
    if (const Node operand = solid.child(tag))
      if (has_flat_sides(element(definitions_.name(file_.required(operand, "ref"), operand), operand)))
        return true;
  return false;
}

mesh::TriMesh Solids::make(Node solid) {
  if (core::find_word(kBooleans, solid.name())) return make_boolean(solid);
  std::optional<mesh::TriMesh> mesh = make_simple_solid(solid, definitions_, tessellation_);
  if (!mesh)
    throw core::InputError(
        core::Problem{{},
                      "solids of this kind cannot be made",
                      "write it as a tessellated solid, or leave out the volumes that use it with "
                      "--skip-unsupported"});
  if (const std::vector<core::Problem> problems =
          mesh::mesh_problems(mesh::diagnose(*mesh), solid.attribute("name").value());
      !problems.empty())
    throw core::InputError(problems);
  return std::move(*mesh);
}

mesh::TriMesh Solids::make_boolean(Node solid) {
  const auto operand = [&](const char* tag) {
    const Node reference = solid.child(tag);
    if (!reference) file_.reject(solid, std::string("a boolean has no <") + tag + ">");
    return mesh(definitions_.name(file_.required(reference, "ref"), reference), reference);
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
