#pragma once
/// Where things start, and in which direction.

#include <cstdint>
#include <variant>
#include <vector>

#include "scintray/core/philox.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene/spec.hpp"

namespace scintray {

/// A place in a scene.
struct Place {
  Vec3 position = Vec3::Zero();  ///< world, mm
  std::uint32_t region = 0;      ///< that contains it
};

/// Places uniform over part of a scene, or one point. Immutable.
class Origin {
 public:
  /// A pattern of parts is the union of those that have some of the region's box. Throws InputError when
  /// the region is empty or no part has that name.
  Origin(const std::variant<RegionSpec, Vec3>& spec, const Scene& scene);

  Place sample(const Scene& scene, Rng& rng) const;

  /// Regions in which places lie.
  std::vector<std::uint32_t> regions() const;

 private:
  /// A region and the box in which positions are drawn and, if inside, kept.
  struct Box {
    std::uint32_t region = 0;
    Eigen::AlignedBox3d box;
    bool inside = false;  ///< all of it: no position needs asking
    double most = 1.0;    ///< share of the volume of the boxes up to this one
  };
  void add_parts(const RegionSpec& spec, const Scene& scene);
  void add_box(const RegionSpec& spec, const PartInfo& part);
  const Box& sample_box(Rng& rng) const;

  std::vector<Box> boxes_;
  bool point_ = false;
};

/// A direction of the given distribution, of unit length.
Vec3 sample_direction(const DirectionSpec& spec, Rng& rng);

}  // namespace scintray
