#pragma once
/// The placed volumes of a GDML file.

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "scintray/exchange/gdml/detail/definitions.hpp"
#include "scintray/exchange/gdml/detail/gdml_file.hpp"

namespace scintray::exchange::gdml {

/// Limit of the volumes that a file places, replicas counted one by one.
inline constexpr std::size_t kMostPlaced = 200'000;

/// One placed volume.
struct PlacedVolume {
  std::string physvol;   ///< name of its <physvol>; that of its volume when it has none
  std::string volume;    ///< its <volume>
  std::string material;  ///< <materialref>
  std::string solid;     ///< <solidref>
  Node element;          ///< the <volume>, for messages
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();  ///< mm; may mirror
  std::optional<std::size_t> mother;                       ///< empty: the world
  std::string sensitive;                                   ///< auxiliary "SensDet"
  std::size_t placement = 0;  ///< number of its physical volume: one <physvol> of one step of its loops
};

/// A <skinsurface> or <bordersurface>.
struct SurfacePlacement {
  std::string property;  ///< name of the <opticalsurface>
  std::string volume;    ///< of a skin; empty for a border
  std::string from, to;  ///< names of the <physvol>s of a border: light from the first to the second
  Node element;
};

class Solids;

struct Structure {
  std::string world_volume, world_material, world_solid;
  Node world;                        ///< its <volume>
  std::vector<std::string> volumes;  ///< names of all <volume>s, by name
  std::vector<PlacedVolume> placed;  ///< mothers before their daughters, without the world
  std::vector<SurfacePlacement> surfaces;
  std::vector<std::string> notes;
};

/// Structure of the file from the world of <setup> on. A <physvol> is placed as in Geant4: rotated by the
/// inverse of its rotation, moved by its position, after its scale. Assemblies are expanded; replicas,
/// divisions and parameterised volumes (CopyReader) are placed one by one. Throws InputError for references
/// without a target, a volume inside itself, volumes of other files, divisions that are not read, and more
/// than kMostPlaced volumes.
/// @param solids  receives those of copies with dimensions of their own
Structure read_structure(const GdmlFile& file, const Definitions& definitions, Solids& solids);

}  // namespace scintray::exchange::gdml
