#pragma once
/// The solids of a GDML file as closed meshes.

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scintray/exchange/gdml/detail/definitions.hpp"
#include "scintray/exchange/gdml/detail/gdml_file.hpp"
#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::exchange::gdml {

/// Solids by name. Each is built once, on request.
///
/// All solids that G4GDMLReadSolids of Geant4 11.4 reads are supported: box, tube, cutTube, cone, trd, trap,
/// para, arb8, tet, tessellated, xtru, polycone, genericPolycone, polyhedra, genericPolyhedra, sphere, orb,
/// torus, ellipsoid, eltube, elcone, paraboloid, hype, twistedbox, twistedtrd, twistedtrap, twistedtubs, and
/// union, subtraction, intersection, multiUnion, reflectedSolid and scaledSolid of these. Curved walls have
/// their corners on the true surface and the segments that the tessellation requires, in steps of factors of
/// two, so that bodies that touch along a cylinder mostly have the same.
class Solids {
 public:
  /// Of several solids, or optical surfaces, of one name the first is used, as in Geant4.
  Solids(const GdmlFile& file, const Definitions& definitions, const mesh::Tessellation& tessellation);

  /// The mesh of a solid. Throws InputError, with its name and place, for one that does not exist, is not
  /// supported, has impossible dimensions, or is a boolean of itself.
  const mesh::TriMesh& mesh(const std::string& name, Node where);

  /// Whether the mesh of a solid has spheres, cylinders, cones or tori that can be recognized in it. Solids
  /// whose flat sides are intended, polyhedra and the like, and booleans with one of these are not searched.
  bool is_round(const std::string& name, Node where);

  /// The line of a [[part]] with a shape of scene files that is a solid exactly, where its faces would not be
  /// recognized in its mesh; empty for other solids.
  std::optional<std::string> exact_shape(const std::string& name, Node where) const;

  /// The <opticalsurface> of this name, an element of <solids>; empty when there is none.
  Node optical_surface(const std::string& name) const;
  /// Lengths of the sides of a box; empty for other solids. Throws when there is no solid of this name.
  std::optional<core::Vec3> box_sides(const std::string& name, Node where) const;
  /// The element of a solid, with the loop variables at its place; throws when there is none of this name.
  const LoopedNode& find(const std::string& name, Node where) const;

  /// Adds a solid, a copy of an element whose place is `origin`, for a copy of a volume that has dimensions
  /// of its own. Its expressions are evaluated with the present loop variables. Returns its name.
  std::string add(Node element, Node origin);
  /// An element without attributes, to be filled and added: lengths in mm, angles in rad.
  Node new_element(const std::string& kind, Node origin);
  /// Entries that Geant4 reads differently from their apparent meaning.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  Node element(const std::string& name, Node where) const { return find(name, where).node; }
  mesh::TriMesh make(Node solid);
  mesh::TriMesh make_boolean(Node solid);
  mesh::TriMesh make_union(Node solid);
  /// Adds the bodies of a union: its operands, those of operands that are unions in their place.
  void add_bodies(Node solid, const Eigen::Affine3d& placement, std::vector<mesh::TriMesh>& bodies);
  /// A solid while it is made of others. Throws InputError where it contains itself, or is nested too deep.
  class Entered {
   public:
    Entered(Solids& solids, const std::string& name, Node solid);
    Entered(const Entered&) = delete;
    Entered& operator=(const Entered&) = delete;
    ~Entered() { making_.pop_back(); }

   private:
    std::vector<std::string>& making_;
  };
  mesh::TriMesh make_transformed(Node solid);
  /// The solid that an element refers to.
  mesh::TriMesh referred(Node reference);
  /// Names of the solids that one is made of; none of a simple one.
  std::vector<std::string> operands(Node solid) const;
  bool has_flat_sides(Node solid) const;
  core::FileLocation where(const std::string& name, Node solid) const;
  /// The element that holds added solids, in the document of `origin`, whose definitions they use.
  static Node added_beside(Node origin);

  const GdmlFile& file_;
  const Definitions& definitions_;
  mesh::Tessellation tessellation_;
  std::map<std::string, LoopedNode> solids_, surfaces_;
  std::map<std::string, Node> origins_;  ///< of added solids by name
  std::map<std::string, mesh::TriMesh> made_;
  std::map<std::string, bool> round_;
  std::vector<std::string> in_the_making_, notes_;
};

/// The rotation about x, then y, then z by the angles (rad) of a <rotation>.
Eigen::Matrix3d rotation_matrix(const core::Vec3& angles_rad);

}  // namespace scintray::exchange::gdml
