/// Light in birefringent media, against closed forms.

#include "scintray/optics/birefringence.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "scintray/core/sampling.hpp"

using namespace scintray;
using namespace scintray::optics;
using core::Vec3;

namespace {

/// A medium of three constant indices, its axes turned at random with `rng`.
BirefringentOptics turned_crystal(const std::array<double, 3>& index, core::Rng* rng = nullptr,
                                  const std::array<double, 3>& absorption_per_mm = {}) {
  Birefringence medium;
  for (std::size_t i = 0; i < 3; ++i)
    medium.axes[i] = {core::Curve::constant(index[i]), std::nullopt,
                      core::Curve::constant(absorption_per_mm[i])};
  if (rng) {
    const Vec3 x = core::sample_isotropic(*rng), y = core::sample_polarisation(x, *rng);
    medium.directions.col(0) = x;
    medium.directions.col(1) = y;
    medium.directions.col(2) = x.cross(y);
  }
  return BirefringentOptics(medium, 500.0);
}

/// Calcite's indices at 589 nm, near enough for laws that hold for any.
constexpr double kOrdinary = 1.658, kExtraordinary = 1.486;
BirefringentOptics calcite(core::Rng* rng = nullptr) {
  return turned_crystal({kOrdinary, kOrdinary, kExtraordinary}, rng);
}
/// Uniaxial with the optic axis along a direction.
BirefringentOptics calcite_along(const Vec3& axis) {
  Birefringence medium;
  const core::Frame frame = core::Frame::about(axis);
  for (std::size_t i = 0; i < 3; ++i)
    medium.axes[i] = {core::Curve::constant(i < 2 ? kOrdinary : kExtraordinary), std::nullopt,
                      core::Curve::constant(0.0)};
  medium.directions << frame.x, frame.y, frame.z;
  return BirefringentOptics(medium, 589.0);
}

Ray ray_of(const Vec3& direction, const Vec3& polarisation) {
  Ray ray;
  ray.direction = direction;
  ray.polarisation = polarisation;
  return ray;
}
Ray random_ray(const Vec3& m, core::Rng& rng) {
  Vec3 direction = core::sample_isotropic(rng);
  if (direction.dot(m) > 0.0) direction = -direction;
  return ray_of(direction, core::sample_polarisation(direction, rng));
}
double sum(const std::array<double, 4>& shares) { return std::accumulate(shares.begin(), shares.end(), 0.0); }

constexpr double kRounding = 1e-11;

}  // namespace

TEST_CASE("Birefringent medium of equal indices: modes, and Fresnel's reflectances") {
  core::Rng rng(1, core::StreamKind::photon, 0);
  const Vec3 m = Vec3::UnitZ();
  for (int i = 0; i < 200; ++i) {
    const BirefringentOptics crystal = turned_crystal({1.8, 1.8, 1.8}, &rng);
    Ray ray = random_ray(m, rng);
    const ModeOptics mode = mode_of(crystal, ray);
    CHECK(mode.index == doctest::Approx(1.8).epsilon(1e-13));
    CHECK((mode.wave_normal - ray.direction.vec()).norm() < 1e-13);
    const double cosine = -ray.direction.dot(m);
    const FresnelCoefficients fresnel_in = fresnel(cosine, 1.0, 1.8), fresnel_out = fresnel(cosine, 1.8, 1.0);
    const Vec3 s = ray.direction.cross(m).normalized();
    const double s2 = std::pow(ray.polarisation.dot(s), 2);
    const auto in = power_shares(ray, m, {1.0, nullptr}, {1.0, &crystal});
    CHECK(in[0] == doctest::Approx(s2 * fresnel_in.reflectance_s).epsilon(1e-10));
    CHECK(in[1] == doctest::Approx((1.0 - s2) * fresnel_in.reflectance_p).epsilon(1e-10));
    CHECK(std::abs(sum(in) - 1.0) < kRounding);
    const auto out = power_shares(ray, m, {1.0, &crystal}, {1.0, nullptr});
    const double expected = s2 * fresnel_out.reflectance_s + (1.0 - s2) * fresnel_out.reflectance_p;
    // Rounding counts by the flux through the face.
    CHECK(std::abs(out[0] + out[1] - expected) * cosine < kRounding);
    CHECK(std::abs(sum(out) - 1.0) * cosine < kRounding);
  }
}

TEST_CASE("Faces of birefringent media keep the power of light, whatever the axes") {
  core::Rng rng(2, core::StreamKind::photon, 0);
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const auto any = [&] {
      return std::array<double, 3>{1.0 + rng.uniform(), 1.0 + rng.uniform(), 1.0 + rng.uniform()};
    };
    const BirefringentOptics a = turned_crystal(any(), &rng), b = turned_crystal(any(), &rng);
    const Vec3 m = core::sample_isotropic(rng);
    Ray ray = random_ray(m, rng);
    FaceMedium here{1.0 + rng.uniform(), nullptr}, behind{1.0, &b};
    if (i % 3 != 0) here.birefringent = &a;
    if (i % 3 == 1) behind.birefringent = nullptr;
    if (here.birefringent) take_mode(a, ray, rng);
    const double off = std::abs(sum(power_shares(ray, m, here, behind)) - 1.0);
    // Power is known to rounding over the cosine of the ray.
    worst = std::max(worst, off * std::abs(ray.direction.dot(m)));
    Ray after = ray;
    const bool crossed = interact_at_birefringent(after, m, here, behind, rng);
    CHECK((after.direction.dot(m) < 0.0) == crossed);
    CHECK(std::abs(after.direction.dot(after.polarisation)) < 1e-9);
    CHECK(after.polarisation.norm() == doctest::Approx(1.0));
    const FaceMedium& now = crossed ? behind : here;
    if (now.birefringent) CHECK(has_mode(*now.birefringent, after));
  }
  CHECK(worst < 1e-10);
}

TEST_CASE("Snell's law for wave normals, and the index of the mode that follows from ray and field") {
  core::Rng rng(3, core::StreamKind::photon, 0);
  for (int i = 0; i < 2000; ++i) {
    const BirefringentOptics crystal = turned_crystal({1.5, 1.65, 1.9}, &rng);
    const Vec3 m = core::sample_isotropic(rng);
    Ray ray = random_ray(m, rng);
    const Vec3 tangential = ray.direction - ray.direction.dot(m) * m;
    if (!interact_at_birefringent(ray, m, {1.0, nullptr}, {1.0, &crystal}, rng)) continue;
    const ModeOptics mode = mode_of(crystal, ray);
    const Vec3 wave = mode.index * mode.wave_normal;
    CHECK((wave - wave.dot(m) * m - tangential).norm() < 1e-9);
    // Fresnel's equation of wave normals: sum of k_i^2 / (1/n^2 - 1/n_i^2) = 0.
    const Vec3 k = crystal.directions.matrix().transpose() * mode.wave_normal;
    const double square = mode.index * mode.index;
    const double a = crystal.index[0] * crystal.index[0], b = crystal.index[1] * crystal.index[1],
                 c = crystal.index[2] * crystal.index[2];
    const double fresnel_equation = k.x() * k.x() * a * (square - b) * (square - c) +
                                    k.y() * k.y() * b * (square - a) * (square - c) +
                                    k.z() * k.z() * c * (square - a) * (square - b);
    CHECK(std::abs(fresnel_equation) < 1e-9);
  }
}

TEST_CASE(
    "Calcite plate: light at normal incidence splits by Malus's law, and the extraordinary ray walks off") {
  core::Rng rng(4, core::StreamKind::photon, 0);
  const double tilt = 45.0 * core::kDegree;  // of the optic axis to the normal, in the x-z plane
  const BirefringentOptics crystal = calcite_along({std::sin(tilt), 0.0, std::cos(tilt)});
  const Vec3 m(0.0, 0.0, -1.0), ahead = Vec3::UnitZ();
  // tan(walk-off) = (n_o^2 - n_e^2) tan / (n_e^2 + n_o^2 tan^2) with the tangent of the tilt.
  const double o2 = kOrdinary * kOrdinary, e2 = kExtraordinary * kExtraordinary;
  const double walk_off = std::atan((o2 - e2) * std::tan(tilt) / (e2 + o2 * std::pow(std::tan(tilt), 2)));
  const double n_e = 1.0 / std::sqrt(std::pow(std::cos(tilt), 2) / o2 + std::pow(std::sin(tilt), 2) / e2);
  const auto transmittance = [](double n) { return 4.0 * n / ((1.0 + n) * (1.0 + n)); };
  for (const double azimuth : {0.0, 0.3, 0.9, 1.5}) {
    const Vec3 field(std::cos(azimuth), std::sin(azimuth), 0.0);
    const auto shares = power_shares(ray_of(ahead, field), m, {1.0, nullptr}, {1.0, &crystal});
    const double extraordinary = transmittance(n_e) * std::pow(std::cos(azimuth), 2);
    const double ordinary = transmittance(kOrdinary) * std::pow(std::sin(azimuth), 2);
    CHECK(std::max(shares[2], shares[3]) ==
          doctest::Approx(std::max(extraordinary, ordinary)).epsilon(1e-10));
    CHECK(std::min(shares[2], shares[3]) ==
          doctest::Approx(std::min(extraordinary, ordinary)).epsilon(1e-10));
  }
  // In calcite the extraordinary ray leans away from the optic axis.
  int seen = 0;
  for (int i = 0; i < 200; ++i) {
    Ray ray = ray_of(ahead, Vec3(1.0, 1.0, 0.0).normalized());
    if (!interact_at_birefringent(ray, m, {1.0, nullptr}, {1.0, &crystal}, rng)) continue;
    const ModeOptics mode = mode_of(crystal, ray);
    CHECK((mode.wave_normal - ahead).norm() < 1e-12);
    if (std::abs(ray.polarisation.y()) > 0.5) {
      CHECK((ray.direction - ahead).norm() < 1e-12);
      CHECK(mode.index == doctest::Approx(kOrdinary));
    } else {
      ++seen;
      CHECK(ray.direction.x() == doctest::Approx(-std::sin(walk_off)).epsilon(1e-10));
      CHECK(mode.index == doctest::Approx(n_e).epsilon(1e-12));
      CHECK(mode.group_index == doctest::Approx(n_e * std::cos(walk_off)).epsilon(1e-12));
    }
  }
  CHECK(seen > 50);
}

TEST_CASE("Calcite: critical angles of the ordinary and the extraordinary ray") {
  // Optic axis across the plane of incidence: both rays are along their wave normals.
  const BirefringentOptics crystal = calcite_along(Vec3::UnitY());
  const Vec3 m = Vec3::UnitZ();
  const auto transmitted = [&](double angle_rad, bool extraordinary) {
    const Vec3 direction(std::sin(angle_rad), 0.0, -std::cos(angle_rad));
    const Vec3 field =
        extraordinary ? Vec3(Vec3::UnitY()) : Vec3(std::cos(angle_rad), 0.0, std::sin(angle_rad));
    const auto shares = power_shares(ray_of(direction, field), m, {1.0, &crystal}, {1.0, nullptr});
    return shares[2] + shares[3];
  };
  for (const bool extraordinary : {false, true}) {
    const double critical = std::asin(1.0 / (extraordinary ? kExtraordinary : kOrdinary));
    CHECK(transmitted(critical - 1e-4, extraordinary) > 0.01);
    CHECK(transmitted(critical + 1e-6, extraordinary) == 0.0);
  }
  CHECK(std::asin(1.0 / kOrdinary) / core::kDegree == doctest::Approx(37.09).epsilon(1e-3));
  CHECK(std::asin(1.0 / kExtraordinary) / core::kDegree == doctest::Approx(42.30).epsilon(1e-3));
  // The optic axis in the face and in the plane of incidence: the limit is where the tangential part of the
  // wave vector, not that of the ray, is that of light along the face.
  const BirefringentOptics along = calcite_along(Vec3::UnitX());
  core::Rng rng(5, core::StreamKind::photon, 0);
  for (int i = 0; i < 500; ++i) {
    const double angle = 0.5 * core::kPi * rng.uniform();
    const Vec3 direction(std::sin(angle), 0.0, -std::cos(angle));
    const Ray ray = ray_of(direction, Vec3(std::cos(angle), 0.0, std::sin(angle)));
    const ModeOptics mode = mode_of(along, ray);
    const double tangential = mode.index * mode.wave_normal.x();
    const auto shares = power_shares(ray, m, {1.0, &along}, {1.0, nullptr});
    CHECK((shares[2] + shares[3] > 0.0) == (tangential < 1.0));
  }
}

TEST_CASE("Reciprocity: a mode passes into another as that, reversed, into the first") {
  core::Rng rng(6, core::StreamKind::photon, 0);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const BirefringentOptics a = turned_crystal({1.5, 1.65, 1.9}, &rng),
                             b = turned_crystal({1.4, 1.7, 1.75}, &rng);
    const Vec3 m = core::sample_isotropic(rng);
    Ray ray = random_ray(m, rng);
    take_mode(a, ray, rng);
    const auto forward = power_shares(ray, m, {1.0, &a}, {1.0, &b});
    Ray after = ray;
    const bool crossed = interact_at_birefringent(after, m, {1.0, &a}, {1.0, &b}, rng);
    Ray back = after;
    back.direction = -after.direction;
    const FaceMedium here{1.0, crossed ? &b : &a}, behind{1.0, crossed ? &a : &b};
    const Vec3 against = crossed ? Vec3(-m) : m;
    const auto backward = power_shares(back, against, here, behind);
    // The share of the way that was taken is among those of the way back into the first ray.
    double best = 1.0;
    constexpr double kSeen = 1e-6;  // of less than this nothing is known
    for (const double there : forward)
      for (const double again : backward)
        if (there > kSeen && again > kSeen) best = std::min(best, std::abs(there - again) / there);
    CHECK(best < 1e-8);
    compared += best < 1.0;
  }
  CHECK(compared > 1900);
}

TEST_CASE("Absorption by direction of the field, and the speed of the energy, along principal axes") {
  const BirefringentOptics crystal = turned_crystal({1.5, 1.6, 1.8}, nullptr, {0.01, 0.1, 0.5});
  const Vec3 axes[3] = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (std::size_t i = 0; i < 3; ++i) {
    const ModeOptics mode = mode_of(crystal, ray_of(axes[(i + 1) % 3], axes[i]));
    CHECK(mode.absorption_per_mm == doctest::Approx(crystal.absorption_per_mm[i]));
    CHECK(mode.index == doctest::Approx(crystal.index[i]));
    CHECK(mode.group_index == doctest::Approx(crystal.index[i]));
  }
}

TEST_CASE("Group index of an extraordinary wave: from its index at two wavelengths") {
  Birefringence medium;
  const core::Curve ordinary({400.0, 500.0, 600.0}, {1.70, 1.66, 1.62}),
      other({400.0, 500.0, 600.0}, {1.50, 1.48, 1.46});
  medium.axes = {{{ordinary, std::nullopt, {}}, {ordinary, std::nullopt, {}}, {other, std::nullopt, {}}}};
  const double angle = 0.6;  // of the wave normal to the optic axis
  const auto index_at = [&](double nm) {
    return 1.0 /
           std::sqrt(std::pow(std::cos(angle) / ordinary(nm), 2) + std::pow(std::sin(angle) / other(nm), 2));
  };
  const double n = index_at(500.0), slope = (index_at(500.01) - index_at(499.99)) / 0.02;
  // Field of the wave: D across the normal, in the plane of the axis.
  const BirefringentOptics crystal(medium, 500.0);
  const Vec3 d(std::cos(angle), 0.0, -std::sin(angle)), normal(std::sin(angle), 0.0, std::cos(angle));
  const Vec3 e = Vec3(crystal.permittivity.matrix().inverse() * d).normalized();
  const Vec3 direction = (normal - normal.dot(e) * e).normalized();
  const ModeOptics mode = mode_of(crystal, ray_of(direction, e));
  CHECK((mode.wave_normal - normal).norm() < 1e-12);
  CHECK(mode.group_index == doctest::Approx((n - 500.0 * slope) * direction.dot(normal)).epsilon(1e-6));
}

TEST_CASE("Isotropic emission: modes with their density of states") {
  core::Rng rng(7, core::StreamKind::photon, 0);
  const BirefringentOptics crystal = calcite(&rng);
  const Vec3 axis = crystal.directions.matrix().col(2);
  // Per solid angle of wave normals n / cos^2: an ordinary wave has n_o; an extraordinary one n(angle) /
  // cos^2.
  const double o2 = kOrdinary * kOrdinary, e2 = kExtraordinary * kExtraordinary;
  const auto weight = [&](double u) {  // cosine of the wave normal to the axis
    const double square = 1.0 / (u * u / o2 + (1.0 - u * u) / e2), n = std::sqrt(square);
    // cos^2 = (d.e)^2 with E = D / epsilon
    const double ex = u / o2, ez = std::sqrt(1.0 - u * u) / e2;
    return n / (std::pow(u * ex + std::sqrt(1.0 - u * u) * ez, 2) / (ex * ex + ez * ez));
  };
  double all = 0.0, second = 0.0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps;
    all += weight(u) / kSteps;
    second += weight(u) * u * u / kSteps;
  }
  const double extraordinary_share = all / (all + kOrdinary), mean_square = second / all;
  constexpr int kPhotons = 200000;
  int extraordinary = 0;
  double u2 = 0.0, u4 = 0.0;
  for (int i = 0; i < kPhotons; ++i) {
    Ray ray;
    emit_isotropic(crystal, ray, rng);
    CHECK(has_mode(crystal, ray));
    const ModeOptics mode = mode_of(crystal, ray);
    if (std::abs(mode.index - kOrdinary) < 1e-9) continue;
    ++extraordinary;
    const double square = std::pow(mode.wave_normal.dot(axis), 2);
    u2 += square;
    u4 += square * square;
  }
  const double share = static_cast<double>(extraordinary) / kPhotons;
  CHECK(std::abs(share - extraordinary_share) < 4.0 * std::sqrt(share * (1.0 - share) / kPhotons));
  const double mean = u2 / extraordinary,
               spread = std::sqrt((u4 / extraordinary - mean * mean) / extraordinary);
  CHECK(std::abs(mean - mean_square) < 4.0 * spread);
}

TEST_CASE("Dipoles along the principal axes radiate as emission along their field") {
  // Of a uniaxial crystal: 4 n_o^2 / (n_e^2 + 3 n_o^2) along the axis, relative to across it. The axis is x.
  BirefringentOptics uniaxial = turned_crystal({kExtraordinary, kOrdinary, kOrdinary});
  uniaxial.find_dipole_emission();
  const double o2 = kOrdinary * kOrdinary, e2 = kExtraordinary * kExtraordinary;
  const std::array<double, 3>& power = uniaxial.dipole_emission;
  CHECK(power[0] / power[1] == doctest::Approx(4.0 * o2 / (e2 + 3.0 * o2)).epsilon(1e-5));
  CHECK(power[2] == doctest::Approx(power[1]).epsilon(1e-5));
  // Of a biaxial one: the mean square of the components of the field of isotropic emission.
  core::Rng rng(11, core::StreamKind::photon, 0);
  BirefringentOptics biaxial = turned_crystal({1.5, 1.9, 2.3}, &rng);
  biaxial.find_dipole_emission();
  constexpr int kPhotons = 200'000;
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  for (int i = 0; i < kPhotons; ++i) {
    Ray ray;
    emit_isotropic(biaxial, ray, rng);
    const Vec3 part = 3.0 * (biaxial.directions.matrix().transpose() * ray.polarisation.vec()).cwiseAbs2();
    sum += part;
    squares += part.cwiseAbs2();
    const ModeOptics mode = mode_of(biaxial, ray);
    const std::array<double, 3>& of_axis = biaxial.dipole_emission;
    CHECK(mode.rayleigh_rate / mode.dipole_rate ==
          doctest::Approx((of_axis[0] * part[0] + of_axis[1] * part[1] + of_axis[2] * part[2]) / 3.0));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double mean = sum[axis] / kPhotons;
    const double error = std::sqrt((squares[axis] / kPhotons - mean * mean) / kPhotons);
    CHECK(std::abs(mean - biaxial.dipole_emission[static_cast<std::size_t>(axis)]) < 4.0 * error);
  }
}

TEST_CASE("Rayleigh scattering keeps light in equilibrium: the path in each mode is that of emission") {
  core::Rng rng(12, core::StreamKind::photon, 0);
  BirefringentOptics crystal = turned_crystal({1.5, 1.9, 2.3}, &rng);
  crystal.find_dipole_emission();
  // Mean square of the fields' components over paths: of one ray that is scattered again and again, with the
  // mean path between scatterings in its mode, and of rays as emitted, whose occupation is the emission over
  // the rate at which dipoles of random orientation scatter. In batches, as scattering remembers the field.
  constexpr int kBatches = 200, kOfBatch = 2000;
  const auto mean_squares = [&](auto next) {
    Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
    for (int batch = 0; batch < kBatches; ++batch) {
      Vec3 fields = Vec3::Zero();
      double paths = 0.0;
      for (int i = 0; i < kOfBatch; ++i) {
        Ray ray;
        const double path = next(ray);
        fields += path * (crystal.directions.matrix().transpose() * ray.polarisation.vec()).cwiseAbs2();
        paths += path;
      }
      sum += fields / paths;
      squares += (fields / paths).cwiseAbs2();
    }
    const Vec3 mean = sum / kBatches;
    return std::pair(mean, Vec3(((squares / kBatches - mean.cwiseAbs2()) / (kBatches - 1.0)).cwiseSqrt()));
  };
  Ray last;
  emit_isotropic(crystal, last, rng);
  const auto [scattered, scattered_error] = mean_squares([&](Ray& ray) {
    scatter_rayleigh(crystal, last, rng);
    ray = last;
    return 1.0 / mode_of(crystal, ray).rayleigh_rate;
  });
  const auto [emitted, emitted_error] = mean_squares([&](Ray& ray) {
    emit_isotropic(crystal, ray, rng);
    return 1.0 / mode_of(crystal, ray).dipole_rate;
  });
  for (int axis = 0; axis < 3; ++axis)
    CHECK(std::abs(scattered[axis] - emitted[axis]) <
          4.0 * std::hypot(scattered_error[axis], emitted_error[axis]));
}

TEST_CASE("Isotropic emission does not depend on the group index") {
  Birefringence medium;
  const core::Curve flat = core::Curve::constant(1.5), steep({400.0, 600.0}, {1.7, 1.3});
  const core::Curve other = core::Curve::constant(1.9);
  for (PrincipalAxis& axis : medium.axes) axis = {flat, std::nullopt, {}};
  medium.axes[2].index = other;
  const BirefringentOptics without(medium, 500.0);
  medium.axes[0].index = medium.axes[1].index = steep;
  const BirefringentOptics with(medium, 500.0);
  CHECK(with.group_index[0] > without.group_index[0] + 0.5);
  core::Rng a(9, core::StreamKind::photon, 0), b(9, core::StreamKind::photon, 0);
  for (int i = 0; i < 100; ++i) {
    Ray one, same;
    emit_isotropic(without, one, a);
    emit_isotropic(with, same, b);
    CHECK((one.direction - same.direction).norm() < 1e-12);
  }
}

TEST_CASE(
    "Light along an optic axis, however the crystal is turned: Fresnel's reflectance, and no preferred "
    "field") {
  core::Rng rng(10, core::StreamKind::photon, 0);
  const double reflected = std::pow((kOrdinary - 1.0) / (kOrdinary + 1.0), 2);
  for (int i = 0; i < 50'000; ++i) {
    const Vec3 axis = core::sample_isotropic(rng);
    const BirefringentOptics crystal = calcite_along(axis);
    const Ray ray = ray_of(axis, core::sample_polarisation(axis, rng));
    for (const bool inwards : {true, false}) {
      const FaceMedium air{1.0, nullptr}, spar{1.0, &crystal};
      const auto shares = power_shares(ray, -axis, inwards ? air : spar, inwards ? spar : air);
      CHECK(std::abs(shares[0] + shares[1] - reflected) < 1e-9);
      CHECK(std::abs(sum(shares) - 1.0) < 1e-9);
    }
  }
}

TEST_CASE("Total reflection from calcite into glass keeps the shares of the two polarisations") {
  // The ordinary wave propagates in the calcite, the extraordinary one does not: what is reflected has a
  // phase between its polarisations.
  core::Rng rng(11, core::StreamKind::photon, 0);
  const BirefringentOptics crystal = calcite_along(Vec3::UnitY());
  const Vec3 m = Vec3::UnitZ();
  const double angle = std::asin(1.55 / 1.6);
  const Vec3 direction(std::sin(angle), 0.0, -std::cos(angle)), s = Vec3::UnitY();
  const Vec3 field = (0.6 * s + 0.8 * s.cross(direction)).normalized();
  const FaceMedium glass{1.6, nullptr}, spar{1.0, &crystal};
  const auto shares = power_shares(ray_of(direction, field), m, glass, spar);
  REQUIRE(shares[0] > 0.1);
  REQUIRE(shares[1] > 1e-4);
  double sum_s = 0.0;
  int reflections = 0;
  for (int i = 0; i < 2000; ++i) {
    Ray ray = ray_of(direction, field);
    if (interact_at_birefringent(ray, m, glass, spar, rng)) continue;
    ++reflections;
    sum_s += std::pow(ray.polarisation.dot(s), 2);
  }
  REQUIRE(reflections > 100);
  CHECK(sum_s / reflections == doctest::Approx(shares[0] / (shares[0] + shares[1])).epsilon(1e-9));
}

TEST_CASE("A ray without a mode takes one with the share of its field") {
  core::Rng rng(8, core::StreamKind::photon, 0);
  const BirefringentOptics crystal = turned_crystal({1.5, 1.65, 1.9});
  constexpr int kPhotons = 20000;
  const double azimuth = 0.4;
  int along_x = 0;
  for (int i = 0; i < kPhotons; ++i) {
    Ray ray = ray_of(Vec3::UnitZ(), Vec3(std::cos(azimuth), std::sin(azimuth), 0.0));
    CHECK(!has_mode(crystal, ray));
    take_mode(crystal, ray, rng);
    CHECK(has_mode(crystal, ray));
    along_x += std::abs(ray.polarisation.x()) > 0.5;
  }
  const double expected = std::pow(std::cos(azimuth), 2);
  CHECK(std::abs(static_cast<double>(along_x) / kPhotons - expected) <
        4.0 * std::sqrt(expected * (1.0 - expected) / kPhotons));
}
