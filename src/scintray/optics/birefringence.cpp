#include "scintray/optics/birefringence.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <complex>

#include "scintray/core/sampling.hpp"
#include "scintray/optics/elliptical.hpp"

namespace scintray::optics {

namespace {

using core::Vec3;
using Eigen::Matrix3d;

/// Part of |D| by which the polarisation of a ray with a mode may be off.
constexpr double kModeTolerance = 1e-9;

double of_axes(const std::array<double, 3>& values, const Vec3& squared) {
  return values[0] * squared.x() + values[1] * squared.y() + values[2] * squared.z();
}

/// Principal directions of a symmetric tensor in the plane of two perpendicular unit vectors.
struct PlaneAxes {
  Vec3 first, second;
  PlaneAxes(const Matrix3d& tensor, const Vec3& u, const Vec3& v) {
    const Vec3 tu = tensor * u;
    const double uu = u.dot(tu), uv = v.dot(tu), vv = v.dot(tensor * v);
    const double angle = 0.5 * std::atan2(2.0 * uv, uu - vv);
    first = std::cos(angle) * u + std::sin(angle) * v;
    second = std::cos(angle) * v - std::sin(angle) * u;
  }
};

/// n_g of a wave along its normal: n - wavelength dn/dwavelength at a fixed normal, where 1/n^2 is a
/// stationary value of the sum of d_i^2 / n_i^2 over the principal axes, d being the direction of D.
double group_index_of(const BirefringentOptics& medium, double n, const Vec3& d_squared) {
  std::array<double, 3> slopes;
  for (std::size_t i = 0; i < 3; ++i) {
    const double ni = medium.index[i];
    slopes[i] = (medium.group_index[i] - ni) / (ni * ni * ni);
  }
  return n + n * n * n * of_axes(slopes, d_squared);
}

/// A wave of a given normal, in the frame of the principal axes.
struct NormalWave {
  Vec3 field;  ///< unit vector
  /// Emission into it by dipoles, per solid angle of normals: density of states times the square of the field
  /// of a photon (emit_isotropic).
  double weight;

  /// @param impermeability  1 / n^2 by axis
  /// @param d  direction of its D
  NormalWave(const Vec3& impermeability, const Vec3& d) {
    const Vec3 along = impermeability.cwiseProduct(d);
    const double n = 1.0 / std::sqrt(d.dot(along));
    field = along.normalized();
    const double cosine = d.dot(field);
    weight = n / (cosine * cosine);
  }
};

Vec3 impermeability_of(const std::array<double, 3>& index) {
  return {1.0 / (index[0] * index[0]), 1.0 / (index[1] * index[1]), 1.0 / (index[2] * index[2])};
}

/// Directions of D of the two waves of a normal.
PlaneAxes waves_of_normal(const Vec3& impermeability, const Vec3& normal) {
  const core::Frame frame = core::Frame::about(normal);
  return {Matrix3d(impermeability.asDiagonal()), frame.x, frame.y};
}

}  // namespace

BirefringentOptics::BirefringentOptics(const Birefringence& medium, double wavelength_nm)
    : directions(medium.directions) {
  Vec3 squares;
  for (std::size_t i = 0; i < 3; ++i) {
    const PrincipalAxis& axis = medium.axes[i];
    index[i] = axis.index(wavelength_nm);
    group_index[i] = axis.group_index ? (*axis.group_index)(wavelength_nm)
                                      : index[i] - wavelength_nm * axis.index.derivative(wavelength_nm);
    absorption_per_mm[i] = axis.absorption_per_mm(wavelength_nm);
    squares[static_cast<int>(i)] = index[i] * index[i];
  }
  permittivity = Matrix3d(medium.directions * squares.asDiagonal() * medium.directions.transpose());
}

void BirefringentOptics::find_dipole_emission() {
  const Vec3 impermeability = impermeability_of(index);
  // By symmetry an octant suffices: Gauss's rule along z, equal steps around it.
  using Rule = boost::math::quadrature::gauss<double, 20>;  // nodes above 0, of an even function
  constexpr int kAround = 16;
  Vec3 power = Vec3::Zero();
  for (std::size_t node = 0; node < Rule::abscissa().size(); ++node) {
    const double z = Rule::abscissa()[node], across = std::sqrt(1.0 - z * z);
    for (int i = 0; i < kAround; ++i) {
      const double azimuth = 0.5 * core::kPi * (i + 0.5) / kAround;
      const PlaneAxes waves =
          waves_of_normal(impermeability, {across * std::cos(azimuth), across * std::sin(azimuth), z});
      for (const Vec3& d : {waves.first, waves.second}) {
        const NormalWave wave(impermeability, d);
        power += Rule::weights()[node] * wave.weight * wave.field.cwiseAbs2();
      }
    }
  }
  for (int i = 0; i < 3; ++i) dipole_emission[static_cast<std::size_t>(i)] = 3.0 * power[i] / power.sum();
}

bool alike(const PrincipalAxis& a, const PrincipalAxis& b) {
  const auto same = [](const core::Curve& one, const core::Curve& other) {
    return one.x() == other.x() && one.y() == other.y();
  };
  return same(a.index, b.index) && same(a.absorption_per_mm, b.absorption_per_mm) &&
         a.group_index.has_value() == b.group_index.has_value() &&
         (!a.group_index || same(*a.group_index, *b.group_index));
}

BirefringentOptics BirefringentOptics::in_frame(const core::Frame& frame) const {
  Matrix3d to_frame;
  to_frame << frame.x.transpose(), frame.y.transpose(), frame.z.transpose();
  BirefringentOptics turned = *this;
  turned.directions = Matrix3d(to_frame * directions.matrix());
  turned.permittivity = Matrix3d(to_frame * permittivity.matrix() * to_frame.transpose());
  return turned;
}

ModeOptics mode_of(const BirefringentOptics& medium, const Ray& ray) {
  const Vec3 e = ray.polarisation, d = medium.permittivity.matrix() * e;
  const double length = d.norm(), energy = e.dot(d);
  ModeOptics mode;
  mode.wave_normal = d.cross(ray.direction.cross(e)).normalized();
  mode.index = length / std::sqrt(energy);
  const double cosine = energy / length;  // of the angle between ray and wave normal
  const Matrix3d to_axes = medium.directions.matrix().transpose();
  const Vec3 e_axes = to_axes * e, d_axes = to_axes * d / length;
  mode.group_index = cosine * group_index_of(medium, mode.index, d_axes.cwiseAbs2());
  // Loss of power, sum of n_i alpha_i E_i^2, over the flux of energy along the ray, n cos for a unit field.
  std::array<double, 3> losses;
  for (std::size_t i = 0; i < 3; ++i) losses[i] = medium.index[i] * medium.absorption_per_mm[i];
  mode.dipole_rate = 1.0 / (mode.index * cosine);
  mode.rayleigh_rate = mode.dipole_rate * of_axes(medium.dipole_emission, e_axes.cwiseAbs2());
  mode.absorption_per_mm = of_axes(losses, e_axes.cwiseAbs2()) / (mode.index * cosine);
  return mode;
}

bool has_mode(const BirefringentOptics& medium, const Ray& ray) {
  if (ray.polarisation.isZero(0.0) || ray.ellipticity_rad != 0.0) return false;
  const Vec3 d = medium.permittivity.matrix() * ray.polarisation.vec();
  return std::abs(d.dot(ray.direction.cross(ray.polarisation))) < kModeTolerance * d.norm();
}

void take_mode(const BirefringentOptics& medium, Ray& ray, core::Rng& rng) {
  if (has_mode(medium, ray)) return;
  // Both fields are across the ray, D of one is across the field of the other.
  const core::Frame frame = core::Frame::about(ray.direction);
  const PlaneAxes modes(medium.permittivity.matrix(), frame.x, frame.y);
  double share = 0.5;
  if (!ray.polarisation.isZero(0.0)) {
    const FieldComponents field = field_of(ray, modes.first);
    share = std::norm(field.s) / (std::norm(field.s) + std::norm(field.p));
  }
  ray.polarisation = rng.uniform() < share ? modes.first : modes.second;
  ray.ellipticity_rad = 0.0;
}

void emit_isotropic(const BirefringentOptics& medium, Ray& ray, core::Rng& rng) {
  const Vec3 impermeability = impermeability_of(medium.index);
  // An upper bound of n / cos^2: cos is at least twice the geometric over the arithmetic mean of the extreme
  // permittivities (Kantorovich's inequality).
  const auto [low, high] = std::minmax_element(medium.index.begin(), medium.index.end());
  const double ratio = *high / *low, mean = 0.5 * (ratio + 1.0 / ratio);
  const double bound = *high * mean * mean;
  for (;;) {
    const Vec3 normal = core::sample_isotropic(rng);
    const PlaneAxes waves = waves_of_normal(impermeability, normal);
    const NormalWave wave(impermeability, rng.uniform() < 0.5 ? waves.first : waves.second);
    if (rng.uniform() * bound >= wave.weight) continue;
    const Vec3& e = wave.field;
    const Vec3 direction = (normal - e.dot(normal) * e).normalized();
    ray.direction = (medium.directions.matrix() * direction).normalized();
    ray.polarisation = (medium.directions.matrix() * e).normalized();
    ray.ellipticity_rad = 0.0;
    return;
  }
}

void scatter_rayleigh(const BirefringentOptics& medium, Ray& ray, core::Rng& rng) {
  const Vec3 before = ray.polarisation;
  do {
    emit_isotropic(medium, ray, rng);
  } while (rng.uniform() >= std::pow(before.dot(ray.polarisation.vec()), 2));
}

}  // namespace scintray::optics
