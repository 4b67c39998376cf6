/// Light at faces of birefringent media: reflection and refraction into the modes of both sides.
///
/// Equations: Maxwell's, for plane waves (P. Yeh 1979, J. Opt. Soc. Am. 69, 742, and D. W. Berreman 1972, J.
/// Opt. Soc. Am. 62, 502, have them in this form; both cited from memory, not opened).
/// tests/surface/birefringence_test.cpp checks them against closed forms.

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <utility>

#include "scintray/optics/birefringence.hpp"
#include "scintray/optics/elliptical.hpp"
#include "scintray/optics/fresnel.hpp"

namespace scintray::optics {

namespace {

using Complex = std::complex<double>;
using core::Vec3;
using Eigen::Matrix3d;

/// Tangential fields of a plane wave in the frame of a face: Ex, Ey, Hx, Hy, with H times the impedance of
/// vacuum.
using Tangential = Eigen::Vector4cd;

double flux_of(const Tangential& f) { return (f[0] * std::conj(f[3]) - f[1] * std::conj(f[2])).real(); }

/// A wave that leaves a face.
struct LeavingWave {
  Tangential field;
  bool carries_power = true;
  Vec3 electric;  ///< in the face's frame; of a mode of a birefringent medium that propagates
  Vec3 ray;
};

/// Frame of a face: x along the tangential wave vector, z from the medium of incidence into the other.
class FaceFrame {
 public:
  FaceFrame(const Vec3& wave_vector, const Vec3& m) {
    const Vec3 tangential = wave_vector - wave_vector.dot(m) * m;
    q_ = tangential.norm();
    constexpr double kHeadOn = 1e-12;
    if (q_ < kHeadOn) q_ = 0.0;
    const Vec3 x = q_ > 0.0 ? Vec3(tangential / q_) : core::Frame::about(m).x;
    to_face_.row(0) = x;
    to_face_.row(1) = -m.cross(x);
    to_face_.row(2) = -m;
  }
  double q() const { return q_; }
  Vec3 to_face(const Vec3& v) const { return to_face_ * v; }
  Vec3 to_world(const Vec3& v) const { return to_face_.transpose() * v; }
  Matrix3d to_face(const Matrix3d& tensor) const { return to_face_ * tensor * to_face_.transpose(); }
  Vec3 y() const { return to_face_.row(1); }

 private:
  double q_;
  Matrix3d to_face_;
};

/// The two waves that leave a face into a medium of one index, polarised across and in the plane of
/// incidence.
std::array<LeavingWave, 2> waves_in(double n, double q, double sign) {
  const double square = n * n - q * q;
  const Complex along =
      square >= 0.0 ? Complex(sign * std::sqrt(square)) : Complex(0.0, sign * std::sqrt(-square));
  std::array<LeavingWave, 2> waves;
  waves[0].field << 0.0, 1.0, -along, 0.0;
  waves[1].field << along / n, 0.0, 0.0, n;
  return waves;
}

/// Rates of change along z of the tangential fields of waves with tangential wave vector q: d/dz of (Ex, Ey,
/// Hx, Hy) is i 2 pi / wavelength times this matrix times them.
Eigen::Matrix4d rates(const Matrix3d& e, double q) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  const double zz = e(2, 2);
  // Ez = -(q Hy + e_zx Ex + e_zy Ey) / e_zz
  m(0, 0) = -q * e(2, 0) / zz;
  m(0, 1) = -q * e(2, 1) / zz;
  m(0, 3) = 1.0 - q * q / zz;
  m(1, 2) = -1.0;
  m(2, 0) = -e(1, 0) + e(1, 2) * e(2, 0) / zz;
  m(2, 1) = q * q - e(1, 1) + e(1, 2) * e(2, 1) / zz;
  m(2, 3) = q * e(1, 2) / zz;
  m(3, 0) = e(0, 0) - e(0, 2) * e(2, 0) / zz;
  m(3, 1) = e(0, 1) - e(0, 2) * e(2, 1) / zz;
  m(3, 3) = -q * e(0, 2) / zz;
  return m;
}

/// Flux of two real waves into each other: 0 for waves of different wave vectors.
double mutual_flux(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  return 0.5 * (a[0] * b[3] + b[0] * a[3] - a[1] * b[2] - b[1] * a[2]);
}

/// A wave in a birefringent medium.
struct Wave {
  Complex along;  ///< z component of its wave vector
  Tangential field;
  bool real = false;  ///< propagates
};

/// z components of the four wave vectors where all are real and no two nearly the same: the roots of Booker's
/// quartic, the determinant of epsilon + N N^T - N^2 for N = (q, 0, root), by Aberth's iteration (both cited
/// from memory, not opened).
std::optional<std::array<double, 4>> distinct_roots(const Matrix3d& e, double q) {
  const double a = e(0, 0), b = e(1, 1) - q * q, c = e(0, 1), d = e(0, 2), f = e(1, 2), g = e(2, 2) - q * q;
  const double first = 1.0 / e(2, 2);
  const double c3 = 2.0 * d * q * first;
  const double c2 = (f * f + d * d - b * q * q - g * (a + b)) * first;
  const double c1 = 2.0 * q * (c * f - b * d) * first;
  const double c0 = (a * (b * g - f * f) - c * c * g + 2.0 * c * d * f - b * d * d) * first;
  // From the roots without the odd terms, which are small where the medium is nearly isotropic.
  const double discriminant = c2 * c2 - 4.0 * c0;
  if (!(discriminant > 0.0)) return std::nullopt;
  const double larger = 0.5 * (-c2 + std::sqrt(discriminant));
  if (!(larger > 0.0) || !(c0 > 0.0)) return std::nullopt;
  const double high = std::sqrt(larger), low = std::sqrt(c0 / larger);
  std::array<double, 4> z{high, low, -low, -high};
  constexpr int kMostRounds = 12;
  constexpr double kConverged = 1e-10, kDistinct = 1e-3;  // a step triples the digits
  for (int round = 0; round < kMostRounds; ++round) {
    double largest = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = z[i];
      const double value = (((x + c3) * x + c2) * x + c1) * x + c0;
      const double slope = ((4.0 * x + 3.0 * c3) * x + 2.0 * c2) * x + c1;
      double repulsion = 0.0;
      for (std::size_t j = 0; j < 4; ++j)
        if (j != i) repulsion += 1.0 / (x - z[j]);
      const double step = value / (slope - value * repulsion);
      z[i] -= step;
      largest = std::max(largest, std::abs(step));
    }
    if (!std::isfinite(largest)) return std::nullopt;
    if (largest > kConverged * high) continue;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (std::abs(z[i] - z[j]) < kDistinct) return std::nullopt;
    return z;
  }
  return std::nullopt;
}

/// The propagating wave of a root: its field is across every row of epsilon + N N^T - N^2.
Wave wave_of_root(const Matrix3d& e, double q, double along) {
  Matrix3d m = e;
  m(0, 0) -= along * along;
  m(1, 1) -= q * q + along * along;
  m(2, 2) -= q * q;
  m(0, 2) += q * along;
  m(2, 0) += q * along;
  const Vec3 crosses[3] = {m.row(0).cross(m.row(1)), m.row(1).cross(m.row(2)), m.row(2).cross(m.row(0))};
  const Vec3* best = &crosses[0];
  for (const Vec3& candidate : crosses)
    if (candidate.squaredNorm() > best->squaredNorm()) best = &candidate;
  const Vec3 field = best->normalized();
  Wave wave;
  wave.along = along;
  wave.real = true;
  wave.field << field.x(), field.y(), -along * field.y(), along * field.x() - q * field.z();
  return wave;
}

/// The four waves of a birefringent medium with tangential wave vector q.
std::array<Wave, 4> waves_of(const Matrix3d& e, double q) {
  std::array<Wave, 4> all;
  if (const auto roots = distinct_roots(e, q)) {
    for (std::size_t i = 0; i < 4; ++i) all[i] = wave_of_root(e, q, (*roots)[i]);
    return all;
  }
  const Eigen::EigenSolver<Eigen::Matrix4d> solver(rates(e, q));
  constexpr double kReal = 1e-12;
  for (int i = 0; i < 4; ++i) {
    Wave& wave = all[static_cast<std::size_t>(i)];
    wave.along = solver.eigenvalues()[i];
    wave.field = solver.eigenvectors().col(i);
    wave.real = std::abs(wave.along.imag()) < kReal;
    if (!wave.real) continue;
    // Of two equal waves, on an optic axis, rounding may make a conjugate pair: its parts are the two.
    const Eigen::Vector4d part =
        wave.along.imag() < 0.0 ? Eigen::Vector4d(wave.field.imag()) : Eigen::Vector4d(wave.field.real());
    wave.field = part.normalized().cast<Complex>();
  }
  return all;
}

/// The two waves that leave a face into a birefringent medium, towards +z or -z by the sign.
std::array<LeavingWave, 2> waves_in(const Matrix3d& e, double q, double sign) {
  std::array<Wave, 4> all = waves_of(e, q);
  // Those that propagate or decay away from the face come first.
  std::array<std::pair<double, std::size_t>, 4> order;
  for (std::size_t i = 0; i < 4; ++i)
    order[i] = {-sign * (all[i].real ? flux_of(all[i].field) : all[i].along.imag()), i};
  std::sort(order.begin(), order.end());
  std::array<Wave*, 2> leaving{&all[order[0].second], &all[order[1].second]};
  // Waves of one wave vector, on an optic axis, are made independent in their flux.
  constexpr double kSameWave = 1e-9;
  if (leaving[0]->real && leaving[1]->real && std::abs(leaving[0]->along - leaving[1]->along) < kSameWave) {
    const Eigen::Vector4d first = leaving[0]->field.real(), second = leaving[1]->field.real();
    leaving[1]->field = (second - mutual_flux(first, second) / mutual_flux(first, first) * first)
                            .normalized()
                            .cast<Complex>();
  }
  std::array<LeavingWave, 2> waves;
  for (std::size_t i = 0; i < 2; ++i) {
    waves[i].field = leaving[i]->field;
    waves[i].carries_power = leaving[i]->real;
    if (!leaving[i]->real) continue;
    const Eigen::Vector4d f = leaving[i]->field.real();
    const Vec3 electric(f[0], f[1], -(q * f[3] + e(2, 0) * f[0] + e(2, 1) * f[1]) / e(2, 2));
    const Vec3 magnetic(f[2], f[3], q * f[1]);
    waves[i].ray = electric.cross(magnetic).normalized();
    waves[i].electric = (electric - electric.dot(waves[i].ray) * waves[i].ray).normalized();
  }
  return waves;
}

/// Light at a face: the waves that leave it, and their amplitudes.
class FaceWaves {
 public:
  FaceWaves(const Ray& ray, const Vec3& m, const FaceMedium& here, const FaceMedium& behind)
      : media_{here, behind}, wave_vector_(wave_vector(ray, here)), frame_(wave_vector_, m) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double sign = side == 0 ? -1.0 : 1.0;
      const BirefringentOptics* crystal = media_[side].birefringent;
      waves_[side] = crystal ? waves_in(frame_.to_face(crystal->permittivity.matrix()), frame_.q(), sign)
                             : waves_in(media_[side].index, frame_.q(), sign);
    }
    const Tangential incident = incident_field(ray, here);
    Eigen::Matrix4cd leaving;
    for (std::size_t i = 0; i < 2; ++i) {
      leaving.col(static_cast<int>(i)) = waves_[0][i].field;
      leaving.col(static_cast<int>(i) + 2) = -waves_[1][i].field;
    }
    const Eigen::Vector4cd solved = Eigen::PartialPivLU<Eigen::Matrix4cd>(leaving).solve(-incident);
    const double incident_flux = flux_of(incident);
    for (std::size_t i = 0; i < 4; ++i) {
      amplitude_[i] = solved[static_cast<int>(i)];
      // In a medium of one index what does not propagate has a flux of exactly 0.
      const double flux = (i < 2 ? -1.0 : 1.0) * flux_of(wave(i).field) / incident_flux;
      share_[i] = wave(i).carries_power ? std::max(0.0, std::norm(amplitude_[i]) * flux) : 0.0;
    }
  }
  const std::array<double, 4>& shares() const { return share_; }

  /// Sets the ray to one of the waves. @return true when it is transmitted
  bool leave_by(std::size_t chosen, Ray& ray, core::Rng& rng) const {
    const std::size_t side = chosen / 2;
    if (media_[side].birefringent) {
      ray.direction = frame_.to_world(wave(chosen).ray).normalized();
      ray.polarisation = frame_.to_world(wave(chosen).electric).normalized();
      ray.ellipticity_rad = 0.0;
      return side == 1;
    }
    const double n = media_[side].index, q = frame_.q();
    const double along = std::sqrt(std::max(0.0, n * n - q * q));
    ray.direction = frame_.to_world(Vec3(q, 0.0, side == 0 ? -along : along)).normalized();
    const Vec3 s = frame_.y();
    const Complex of_s = amplitude_[2 * side], of_p = amplitude_[2 * side + 1];
    if (ray.keeps_phases) {
      set_field(ray, s, {of_s, of_p});
      return side == 1;
    }
    // Without phases: the shares of the power, with a sign that is drawn so that its mean is the cosine of
    // the phase.
    const double size = std::abs(of_s) * std::abs(of_p);
    const double in_phase = size > 0.0 ? (of_p * std::conj(of_s)).real() / size : 1.0;
    const double sign = rng.uniform() < 0.5 * (1.0 + in_phase) ? 1.0 : -1.0;
    ray.polarisation =
        (std::abs(of_s) * s + sign * std::abs(of_p) * s.cross(ray.direction.vec())).normalized();
    ray.ellipticity_rad = 0.0;
    return side == 1;
  }

 private:
  const LeavingWave& wave(std::size_t i) const { return waves_[i / 2][i % 2]; }

  static Vec3 wave_vector(const Ray& ray, const FaceMedium& here) {
    if (!here.birefringent) return here.index * ray.direction;
    const ModeOptics mode = mode_of(*here.birefringent, ray);
    return mode.index * mode.wave_normal;
  }

  Tangential incident_field(const Ray& ray, const FaceMedium& here) const {
    Tangential field;
    if (!here.birefringent) {
      const FieldComponents components = field_of(ray, frame_.y());
      const std::array<LeavingWave, 2> towards = waves_in(here.index, frame_.q(), 1.0);
      return components.s * towards[0].field + components.p * towards[1].field;
    }
    const Vec3 electric = frame_.to_face(ray.polarisation.vec());
    const Vec3 magnetic = frame_.to_face(wave_vector_).cross(electric);
    field << electric.x(), electric.y(), magnetic.x(), magnetic.y();
    return field;
  }

  std::array<FaceMedium, 2> media_;  ///< of incidence, and behind the face
  Vec3 wave_vector_;                 ///< of the incident wave
  FaceFrame frame_;
  std::array<std::array<LeavingWave, 2>, 2> waves_;
  std::array<Complex, 4> amplitude_;
  std::array<double, 4> share_;
};

}  // namespace

bool interact_at_birefringent(Ray& ray, const Vec3& m, const FaceMedium& here, const FaceMedium& behind,
                              core::Rng& rng) {
  if (here.birefringent)
    take_mode(*here.birefringent, ray, rng);
  else if (ray.polarisation.isZero(0.0))
    repolarise(ray, rng);
  const FaceWaves face(ray, m, here, behind);
  const std::array<double, 4>& share = face.shares();
  double u = rng.uniform() * (share[0] + share[1] + share[2] + share[3]);
  // Light in a medium of one index leaves as one wave of both polarisations.
  for (const std::size_t side : {std::size_t{1}, std::size_t{0}}) {
    for (std::size_t i = 2 * side; i < 2 * side + 2; ++i) {
      if (u < share[i]) return face.leave_by(i, ray, rng);
      u -= share[i];
    }
  }
  // Rounding: the strongest.
  return face.leave_by(static_cast<std::size_t>(std::max_element(share.begin(), share.end()) - share.begin()),
                       ray, rng);
}

std::array<double, 4> power_shares(const Ray& ray, const Vec3& m, const FaceMedium& here,
                                   const FaceMedium& behind) {
  return FaceWaves(ray, m, here, behind).shares();
}

}  // namespace scintray::optics
