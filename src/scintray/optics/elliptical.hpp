#pragma once
/// Elliptically polarised light: rays that keep the phase between the two polarisations.
///
/// The field of a ray, up to a common phase, is a cos(chi) + i b sin(chi), with the unit polarisation a, b =
/// k x a for the direction k, and the ellipticity angle chi; fields vary as exp(-i omega t). chi = 0 is
/// linear, +-45 deg circular light. Reflection and refraction multiply the components across (s) and in (p)
/// the plane of incidence by complex amplitudes (M. Born and E. Wolf, Principles of Optics, 7th ed., sections
/// 1.4.2, 1.5.2 and 1.5.4; cited from memory, not opened).

#include <complex>

#include "scintray/core/rng.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/optics/fresnel.hpp"

namespace scintray::optics {

/// Components of a ray's field along s, a unit vector across the plane of incidence, and p = s x k.
struct FieldComponents {
  std::complex<double> s, p;
};
FieldComponents field_of(const Ray& ray, const core::Vec3& s);

/// Sets the polarisation and the ellipticity of a ray of its new direction to those of a field of any power
/// above 0.
/// @param s  of unit length, across the direction
void set_field(Ray& ray, const core::Vec3& s, const FieldComponents& field);

/// The field of a ray without its component along `direction`, which becomes its direction: what a dipole
/// radiates, or a scatterer keeps. @return false, with the ray unchanged, when less than 1e-9 is left of it
bool project_field(Ray& ray, const core::Vec3& direction);

/// Sign between two components of a field for light that has one linear polarisation, 1 or -1: drawn so that
/// its mean is the cosine of their phase, which makes the mean of the first three Stokes parameters exact.
double draw_sign(const std::complex<double>& s, const std::complex<double>& p, core::Rng& rng);

/// Share of the power whose field is not along a unit vector: the pattern of a dipole that the ray drives.
double power_across(const Ray& ray, const core::Vec3& direction);

/// Stokes parameters of a ray of unit intensity, with s and p as axes: s1 is the excess of s over p, s2 that
/// of the polarisation at 45 deg between s and p, and s3 = sin(2 chi) with the sign of chi.
struct StokesParameters {
  double s1 = 0.0, s2 = 0.0, s3 = 0.0;
};
StokesParameters stokes_of(const Ray& ray, const core::Vec3& s);

/// As interact_at_facet, for a polarised ray that keeps phases: those of total reflection included.
[[gnu::noinline, gnu::cold]] bool interact_with_phase(Ray& ray, const core::Vec3& m, double n1, double n2,
                                                      core::Rng& rng);

/// Total reflection amplitudes at an incidence-angle cosine beyond the critical angle, of unit magnitude.
FieldComponents total_reflection_amplitudes(double cos_i, double n1, double n2);

}  // namespace scintray::optics
