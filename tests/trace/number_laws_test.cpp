// Laws over a number type against those for one photon.
#include <cmath>

#include "physics/lane_widths.hpp"
#include "scintray/core/sampling.hpp"
#include "scintray/core/sampling_laws.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;

TEST_CASE("Laws over a number type have the bits of those for one photon") {
  Rng rng(1, StreamKind::other, 0);
  const auto triple = [](const Vec3& v) { return Triple<double>{v.x(), v.y(), v.z()}; };
  const auto same = [](const Triple<double>& a, const Vec3& b) {
    return same_bits(a.x, b.x()) && same_bits(a.y, b.y()) && same_bits(a.z, b.z());
  };
  const auto same_angle = [](const SineCosineOf<double>& a, const SineCosine& b) {
    return same_bits(a.sine, b.sine) && same_bits(a.cosine, b.cosine);
  };
  int different = 0;
  const auto require = [&](bool holds) { different += holds ? 0 : 1; };
  for (int i = 0; i < 2'000; ++i) {
    const Vec3 a = sample_isotropic(rng), b = sample_isotropic(rng);
    const Vec3 sum = a + 2.0 * b;
    require(same_bits(dot(triple(a), triple(b)), a.dot(b)));
    require(same(cross(triple(a), triple(b)), a.cross(b)));
    const Vec3 unit = (1.0 / sum.norm()) * sum;
    require(same(normalised(triple(sum)), unit));
    require((unit - sum.normalized()).norm() < 4e-16);
    const double off = 1e-7 * (a.x());
    require(std::abs(vec(rounded_to_unit(triple((1.0 + off) * a))).norm() - 1.0) < 4e-16 + 1.5 * off * off);
    const Frame frame = Frame::about(a);
    const Across<double> across(triple(a));
    require(same(across.x, frame.x) && same(across.y, frame.y));
    const double u = rng.uniform_positive();
    require(same_bits(laws::log(u), core::log(u)));
    require(same_angle(laws::sincos(7.0 * u), core::sincos(7.0 * u)));
    require(same_angle(laws::sincos_of_turn(u), core::sincos_of_turn(u)));
  }
  CHECK(different == 0);
}
