#pragma once
/// The faces around a shape of region, for the kernels of lane_kernel.hpp.

#include <cstdint>
#include <vector>

#include "scintray/scene/accelerator.hpp"
#include "scintray/transport/detail/lanes/lane_kernel.hpp"

namespace scintray::transport {

/// Planes, or the faces of one convex body, numbered as in LaneWork.
class LaneFaces {
 public:
  LaneFaces() = default;
  /// @param accelerator  bounded by planes, or one convex body; must outlive this
  explicit LaneFaces(const scene::Accelerator& accelerator);

  struct Face {
    std::uint32_t triangle;  ///< of the region's boundary, on it
    bool mixed;              ///< leads to several regions
  };
  const std::vector<Face>& list() const { return list_; }
  bool has_quadrics() const { return !numbers_.empty(); }
  LanePlanes planes() const;
  LaneBody body() const;
  /// The face that a triangle is on, as LaneWork::left: kNoFace for planes, and for no triangle.
  double left_at(std::uint32_t triangle) const;

 private:
  const scene::Boundary* boundary_ = nullptr;
  std::vector<Face> list_;
  std::vector<LaneBody::Face> numbers_;  ///< of a body
  std::uint32_t flat_ = 0;               ///< of these, the first: planes
  bool cylinders_ = false;               ///< all others are cylinders
};

}  // namespace scintray::transport
