#pragma once
/// Light at faces of birefringent media: reflection and refraction into the modes of both sides.
///
/// Equations: Maxwell's, for plane waves (P. Yeh 1979, J. Opt. Soc. Am. 69, 742, and D. W. Berreman 1972, J.
/// Opt. Soc. Am. 62, 502, have them in this form; both cited from memory, not opened).
/// tests/surface/birefringence_test.cpp checks them against closed forms.

#include <array>

#include "scintray/optics/birefringence.hpp"
#include "scintray/optics/fresnel.hpp"

namespace scintray::optics {

/// A medium at a face: of one index, or birefringent, where `index` is not used.
struct FaceMedium {
  double index = 1.0;
  const BirefringentOptics* birefringent = nullptr;
};

/// As interact_at_facet(ray, m, n1, n2, rng), where at least one of the two media is birefringent: the ray
/// leaves in one of the modes of the reflected or the transmitted light, with the share of each in the power.
/// The fields are matched without approximation, evanescent ones included.
///
/// @param m  unit normal opposed to the ray
/// @return true when the ray was refracted into `behind`
[[gnu::noinline, gnu::cold]] bool interact_at_birefringent(Ray& ray, const core::Vec3& m,
                                                           const FaceMedium& here, const FaceMedium& behind,
                                                           core::Rng& rng);

/// Shares of the power of what leaves a face, of light of the power 1: two reflected modes, then two
/// transmitted ones (in a medium of one index: polarised across and in the plane of incidence).
std::array<double, 4> power_shares(const Ray& ray, const core::Vec3& m, const FaceMedium& here,
                                   const FaceMedium& behind);

}  // namespace scintray::optics
