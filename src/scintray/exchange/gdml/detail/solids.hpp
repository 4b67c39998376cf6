#pragma once
/// The solids of a GDML file as closed meshes.

#include <map>
#include <string>
#include <vector>

#include "scintray/exchange/gdml/detail/definitions.hpp"
#include "scintray/exchange/gdml/detail/gdml_file.hpp"
#include "scintray/mesh/tessellation.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::exchange::gdml {

/// Solids by name. Each is built once, on request.
///
/// Supported are: box, tube, cone, trd, trap, para, arb8, tet, tessellated, xtru, polycone, genericPolycone,
/// polyhedra, genericPolyhedra, sphere, orb, torus, ellipsoid, eltube, elcone, paraboloid, hype, and union,
/// subtraction, intersection of these. Curved walls have their corners on the true surface and the segments
/// that the tessellation requires, in steps of factors of two, so that bodies that touch along a cylinder
/// mostly get the same.
class Solids {
 public:
  /// Throws InputError when two solids have one name.
  Solids(const GdmlFile& file, const Definitions& definitions, const mesh::Tessellation& tessellation);

  /// The mesh of a solid. Throws InputError, with its name and place, for one that does not exist, is not
  /// supported, has impossible dimensions, or is a boolean of itself.
  const mesh::TriMesh& mesh(const std::string& name, Node where);

  /// Whether the mesh of a solid has spheres, cylinders or cones that can be recognized in it. Solids whose
  /// flat sides are meant, polyhedra and the like, and booleans with one of these are not searched.
  bool is_round(const std::string& name, Node where);

  /// The <opticalsurface> of this name, an element of <solids>; empty when there is none.
  Node optical_surface(const std::string& name) const;
  /// The element of a solid; throws when there is none of this name.
  Node element(const std::string& name, Node where) const;

 private:
  const LoopedNode& find(const std::string& name, Node where) const;
  mesh::TriMesh make(Node solid);
  mesh::TriMesh make_boolean(Node solid);
  bool has_flat_sides(Node solid) const;

  const GdmlFile& file_;
  const Definitions& definitions_;
  mesh::Tessellation tessellation_;
  std::map<std::string, LoopedNode> solids_, surfaces_;
  std::map<std::string, mesh::TriMesh> made_;
  std::map<std::string, bool> round_;
  std::vector<std::string> in_the_making_;
};

/// The rotation about x, then y, then z by the angles (rad) of a <rotation>.
Eigen::Matrix3d rotation_matrix(const core::Vec3& angles_rad);

}  // namespace scintray::exchange::gdml
