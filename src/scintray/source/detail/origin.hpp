#pragma once
/// Initial positions and directions of photons, gammas and deposits.

#include <cstdint>
#include <variant>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::source {

/// A position in a scene, with its region.
struct Place {
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  core::RegionId region;                     ///< that contains the position
};

/// Origin of a source: uniform over a volume of a scene, or one point. Immutable.
class Origin {
 public:
  /// A pattern of parts is the union of those that overlap the region's box. Throws InputError when the
  /// region is empty or no part has that name.
  Origin(const std::variant<scene_file::RegionSpec, core::Vec3>& spec, const scene::Scene& scene);

  Place sample(const scene::Scene& scene, core::Rng& rng) const;

  /// Regions that contain places of the origin.
  std::vector<core::RegionId> regions() const;

 private:
  /// A region and the box in which positions are drawn and, if inside the region, accepted.
  struct Box {
    core::RegionId region;
    Eigen::AlignedBox3d box;
    bool inside = false;  ///< the whole box is: positions require no test
    double most = 1.0;    ///< cumulative share of the volume of the boxes, this one included
  };
  void add_parts(const scene_file::RegionSpec& spec, const scene::Scene& scene);
  void add_box(const scene_file::RegionSpec& spec, const scene::PartInfo& part);
  const Box& sample_box(core::Rng& rng) const;
  /// Sets Box::most and Box::inside.
  void weigh(const scene::Scene& scene);
  /// Share of the boxes' volume that lies in their regions, by a fixed number of points.
  double filled_share(const scene::Scene& scene) const;
  /// Divides boxes of which the region fills little, as of a thin part that is not along an axis, and leaves
  /// out the pieces without any of it.
  void refine(const scene::Scene& scene);

  core::FileLocation where_;  ///< of the region, for messages
  std::vector<Box> boxes_;
  bool point_ = false;
};

/// Direction (unit vector) drawn from the given distribution.
core::Vec3 sample_direction(const scene_file::DirectionSpec& spec, core::Rng& rng);

}  // namespace scintray::source
