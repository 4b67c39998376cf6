#pragma once
/// Faces whose reflector scatters by a law of its own and transmits nothing.

#include "scintray/optics/microsurface.hpp"

namespace scintray::optics {

/// A reflector on a face, or behind a smooth face with a thin gap between, that scatters light by the law of
/// a derived class. What is not reflected is absorbed. From outside light is incident on the reflector
/// itself.
class OpaqueFace : public MicrosurfaceModel {
 public:
  SurfaceOutcome scatter(Ray& ray, Side side, const IndexPair& index, SurfaceInteraction& at) const override {
    if (side == Side::outside)
      return reflect_light(ray, at.normal, index.outside, at) ? SurfaceOutcome::outside
                                                              : SurfaceOutcome::absorbed;
    const core::Vec3 inward = -at.normal;
    if (gap_index_ <= 0.0)
      return reflect_light(ray, inward, index.inside, at) ? SurfaceOutcome::inside : SurfaceOutcome::absorbed;
    if (!interact_at_facet(ray, inward, index.inside, gap_index_, at.rng)) return SurfaceOutcome::inside;
    for (;;) {
      if (!reflect_light(ray, inward, gap_index_, at)) return SurfaceOutcome::absorbed;
      if (interact_at_facet(ray, at.normal, gap_index_, index.inside, at.rng)) return SurfaceOutcome::inside;
    }
  }

  bool opaque() const override { return true; }
  /// Index of the gap before the reflector; 0: none, the reflector is in contact with the face.
  double gap_index() const { return gap_index_; }

 protected:
  explicit OpaqueFace(double gap_index) : gap_index_(gap_index) {}

  /// Reflects light that arrives in a medium of index `index`; false: it is absorbed.
  /// @param normal  unit normal of the reflector, opposed to the ray; on return the ray heads along it
  virtual bool reflect_light(Ray& ray, const core::Vec3& normal, double index,
                             SurfaceInteraction& at) const = 0;

 private:
  double gap_index_;
};

/// Direction cosines of light across the normal of a face, least of the cosine to the normal: a direction
/// exactly in the face would be on neither side.
inline constexpr double kLeastOpaqueCosine = 1e-6;

}  // namespace scintray::optics
