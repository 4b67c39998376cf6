#pragma once
/// The placed volumes of a GDML file.

#include <Eigen/Geometry>
#include <functional>
#include <map>
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
/// without a target, a volume inside itself, divisions that are not read, and more than kMostPlaced volumes.
/// @param solids  receives those of copies with dimensions of their own
Structure read_structure(const GdmlFile& file, const Definitions& definitions, Solids& solids);

/// Share of each placed volume that is outside of its daughters, which are taken to be inside their mother
/// and not in each other, as Geant4 requires; 1 where a solid cannot be made.
std::vector<double> shares_left(const Structure& structure, Solids& solids);

/// Shares up to this are rounding.
inline constexpr double kNothingLeft = 1e-9;

/// The placed volumes by the names of their physical volumes, and which of them may touch.
class Neighbours {
 public:
  /// @param structure  must outlive this
  explicit Neighbours(const Structure& structure);

  /// The copies of a physical volume, in rising order.
  struct Copies {
    std::vector<std::size_t> all;
    std::map<std::optional<std::size_t>, std::vector<std::size_t>> by_mother;
  };
  /// The copies of the physical volume of a name: of several of one name the first, as G4PhysicalVolumeStore
  /// returns it.
  const Copies& copies_of(const std::string& physvol) const;
  /// Calls visitor(a, b) for all copies a of a physical volume and b of another that may touch: a mother and
  /// her daughter, or two daughters of one mother.
  void visit(const Copies& from, const Copies& to,
             const std::function<void(std::size_t, std::size_t)>& visitor) const;

 private:
  const Structure& structure_;
  std::map<std::string, Copies> copies_;
};

}  // namespace scintray::exchange::gdml
