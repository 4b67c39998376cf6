#pragma once
/// Copies of a volume within another: replicas, divisions and parameterised volumes of a GDML file.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "scintray/exchange/gdml/detail/solids.hpp"

namespace scintray::exchange::gdml {

/// One copy.
struct VolumeCopy {
  Eigen::Affine3d in_mother = Eigen::Affine3d::Identity();  ///< mm
  std::string solid{};                                      ///< of this copy; empty: that of its volume
};

/// Copies of a volume, and notes where Geant4 reads them differently from their apparent meaning.
struct VolumeCopies {
  std::vector<VolumeCopy> copies;
  std::vector<std::string> notes{};
};

/// Reads copies; their solids are added to those of the file.
class CopyReader {
 public:
  CopyReader(const GdmlFile& file, const Definitions& definitions, Solids& solids)
      : file_(file), definitions_(definitions), solids_(solids) {}

  /// Copies of <replicavol>, as of G4PVReplica: side by side along x, y or z, centred in the mother,
  /// whose number * width is its extent; about z, the middle of copy n at offset + (n + 1/2) width; along
  /// rho, tubes of the mother's length between the radii offset + n width and offset + (n + 1) width.
  /// @param mother  the <volume> in which they are
  VolumeCopies replicas(Node replica, Node mother) const;

  /// Copies of <divisionvol>, as of G4PVDivision, from the offset on, by number, width or both, with the
  /// dimensions of the division whatever those of their own solid: boxes and parallelepipeds along x, y and
  /// z, trapezoids (trd) along x, y and z, tubes and cones along rho, phi and z, polycones along rho and phi,
  /// polyhedra along rho and by their sides along phi.
  VolumeCopies divisions(Node division, Node mother) const;

  /// Copies of <paramvol>, each with a position, a rotation and dimensions of its own.
  VolumeCopies parameterised(Node paramvol) const;

 private:
  Node child(Node node, const char* tag) const;
  std::string solid_of(Node volume) const;
  int count(Node element, double number) const;
  std::string solid_of_parameters(Node parameters, Node dimensions) const;

  const GdmlFile& file_;
  const Definitions& definitions_;
  Solids& solids_;
};

}  // namespace scintray::exchange::gdml
