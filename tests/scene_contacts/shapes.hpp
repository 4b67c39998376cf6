#pragma once
/// Parts to put together, and the laws that interfaces obey.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scintray/contact/contacts.hpp"

namespace scintray::test {

inline constexpr double kTolerance = 1e-4;  ///< mm, of the contacts of these tests

/// A box from `low` to `high`; each face is cut in `cuts` x `cuts` rectangles, each in two triangles along
/// one diagonal or, when `other_diagonal`, the other. Faces -x +x -y +y -z +z have ids first_face + 0..5.
contact::PlacedPart box(const std::string& name, const core::Vec3& low, const core::Vec3& high,
                        std::uint32_t first_face = 0, int cuts = 1, bool other_diagonal = false);

/// A prism along z over a counter-clockwise convex polygon: the sides have ids first_face + 0.., then come
/// the bottom and the top.
contact::PlacedPart prism(const std::string& name, const std::vector<Eigen::Vector2d>& outline, double z_low,
                          double z_high, std::uint32_t first_face = 0);

/// Every vertex through x -> rotation * x + shift.
void move(std::vector<contact::PlacedPart>& parts, const Eigen::Matrix3d& rotation, const core::Vec3& shift);

/// A rotation about no axis in particular.
Eigen::Matrix3d skew_rotation();

/// Rounds every coordinate to single precision, as a binary STL file does.
void round_to_float(std::vector<contact::PlacedPart>& parts);

double area(const contact::InterfaceTriangle& triangle);

/// Area (mm2) between two regions, whichever is back or front.
double area_between(const std::vector<contact::InterfaceTriangle>& interfaces, core::PartId a,
                    core::PartId b);

/// What the boundary of a region sums to: its outward area vectors (zero when closed) and its volume.
struct Boundary {
  core::Vec3 area_vector = core::Vec3::Zero();
  double area = 0.0;
  double volume = 0.0;
};
std::map<core::PartId, Boundary> boundaries(const std::vector<contact::InterfaceTriangle>& interfaces);

/// Checks the laws of every result: each region is closed, no triangle has one region on both sides, face
/// ids belong to the part on their side, and the volumes are those given (by part, nested ones taken off).
/// `slack_mm` is how far snapping may have moved a face; 0 leaves rounding only.
void check_laws(const std::vector<contact::PlacedPart>& parts,
                const std::vector<contact::InterfaceTriangle>& interfaces, const std::vector<double>& volumes,
                double slack_mm = 0.0);

}  // namespace scintray::test
