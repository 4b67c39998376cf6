#include "scintray/scene/contact_overlap.hpp"

namespace scintray::contact {

OverlapVolume overlap_volume(const PlacedPart& a, const PlacedPart& b) {
  constexpr int kPerSide = 32;
  const Body body_a(a, Eigen::Matrix3d::Identity()), body_b(b, Eigen::Matrix3d::Identity());
  const Vec3 low = body_a.box.low.cwiseMax(body_b.box.low);
  const Vec3 size = body_a.box.high.cwiseMin(body_b.box.high) - low;
  OverlapVolume result{0.0, low + 0.5 * size};
  int count = 0;
  for (int i = 0; i < kPerSide; ++i)
    for (int j = 0; j < kPerSide; ++j)
      for (int k = 0; k < kPerSide; ++k) {
        const Vec3 p = low + Vec3((i + 0.5) * size.x(), (j + 0.5) * size.y(), (k + 0.5) * size.z()) / kPerSide;
        if (body_a.side_of(p, 0.0) != Side::inside || body_b.side_of(p, 0.0) != Side::inside) continue;
        if (count++ == 0) result.inside = p;
      }
  result.volume_mm3 = size.prod() * count / (kPerSide * kPerSide * kPerSide);
  return result;
}

}  // namespace scintray::contact
