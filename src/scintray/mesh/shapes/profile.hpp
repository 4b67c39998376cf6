#pragma once
/// Bodies of revolution whose walls have support surfaces.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"

namespace scintray::mesh {

/// The wall from a corner of a profile to the next.
struct ProfileSide {
  std::string group;
  std::optional<SupportSurface> surface;  ///< nothing: flat
};

/// A closed profile of corners (r, z), about the z axis; side i is from corner i to the next.
struct Profile {
  std::vector<Eigen::Vector2d> corners;
  std::vector<ProfileSide> sides;

  void add(const Eigen::Vector2d& corner, const std::string& group,
           const std::optional<SupportSurface>& surface = std::nullopt) {
    corners.push_back(corner);
    sides.push_back({group, surface});
  }
};

/// The cylinder or cone of a straight wall about the z axis; nothing for a wall perpendicular to the axis.
/// @param near  length (mm) within which the wall is parallel or perpendicular to the axis
std::optional<SupportSurface> straight_wall(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                            double near);

/// A point of a smooth profile: its squared radius, and the rate at which that grows along z.
struct SmoothPoint {
  double z = 0.0;        ///< mm
  double radius2 = 0.0;  ///< mm2
  double rate = 0.0;     ///< mm
};

/// Adds the wall between two points of a smooth profile, without its last corner: two quadrics of revolution
/// that join halfway with a common tangent, and have the radii and tangents of the points. Over a step of h
/// their radius is off by the order of h^3, their angle by that of h^2.
void add_smooth(Profile& profile, const SmoothPoint& from, const SmoothPoint& to, const std::string& group);

/// The body, with the groups of the sides in order of first appearance; flat sides of a full circle as given.
/// @throws InputError as revolved(), and for a profile that crosses itself or encloses no volume.
TriMesh revolve(const Profile& profile, int segments);

}  // namespace scintray::mesh
