#pragma once
/// One contact of two parts: one keeps its shape, and the other adopts it.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "scintray/contact/detail/facing.hpp"
#include "scintray/contact/placed_mesh.hpp"
#include "scintray/mesh/boolean.hpp"

namespace scintray::contact {

/// Which triangles of a reference part and of the conforming part are in contact.
struct ContactRule {
  ContactReach reach;
  /// Per triangle, whether it is on a round wall that both parts have; empty in a contact with a tolerance of
  /// its own.
  std::vector<char> wall_of_reference, wall_of_conforming;

  bool is_wall() const { return !wall_of_reference.empty(); }
};

/// Where a triangle of a changed part is from.
struct TriangleSource {
  std::uint32_t own;  ///< the part's triangle of which it is a piece, or that it replaces
  bool adopted;       ///< it is the reference part's
  const mesh::SupportSurface* surface = nullptr;  ///< of an adopted one there; null: none
};

/// The support surface of a triangle; null: none.
const mesh::SupportSurface* surface_of(const mesh::TriMesh& mesh, std::uint32_t triangle);

/// Assigns to the triangles of a changed part the support surfaces of those that they replace, unless it
/// adopted one whose surface there is not the same within `tolerance_mm`: then it has none.
void keep_own_supports(const mesh::TriMesh& before, const std::vector<TriangleSource>& sources,
                       double tolerance_mm, mesh::TriMesh& after);

/// A contact in which `reference` keeps its shape and `conforming` adopts it.
class Conformer {
 public:
  Conformer(const PlacedMesh& reference, PlacedMesh& conforming, ContactRule rule);

  bool faces() const { return count(Facing::covered) > 0 || count(Facing::partly) > 0; }
  bool covered() const { return count(Facing::covered) > 0 && count(Facing::partly) == 0; }
  /// Middle of the first triangle that lies partly within the tolerance.
  core::Vec3 partly_at() const;

  /// Changes the conforming side. Returns the reason of a failure, empty on success.
  std::string conform(const Eigen::Matrix3d& axes);

 private:
  std::ptrdiff_t count(Facing what) const { return std::count(facing_.begin(), facing_.end(), what); }
  std::vector<char> flush_ends() const;
  Nearest replaced_by(const mesh::TriMesh& mesh, std::uint32_t t) const;
  std::string note(const mesh::BooleanResult& cut, double moved, const mesh::MeshDiagnosis& after) const;

  const PlacedMesh& reference_;
  PlacedMesh& conforming_;
  ContactRule rule_;
  Body reference_body_, conforming_body_;
  std::vector<Facing> facing_;  ///< of the conforming side's triangles
};

}  // namespace scintray::contact
