#include "scintray/optics/wave_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scintray/core/sampling.hpp"
#include "scintray/optics/coherent_layers.hpp"
#include "scintray/optics/elliptical.hpp"

namespace scintray::optics {

namespace {

using Complex = std::complex<double>;

/// Steps of the integral over spatial frequencies, at equal shares of the squared height, and over azimuth.
constexpr int kFrequencySteps = 64, kTurnSteps = 48;
/// Distance of the first and the last angles of the table from those where a wave runs along the face.
constexpr double kOffGrazing = 1e-9;
/// Bound of rejection over what was found at the steps: the fields are smooth between them (chosen).
constexpr double kMargin = 1.05;
constexpr int kMostTries = 1'000'000;

double squares_p(const FaceFields& fields) { return std::norm(fields.along) + std::norm(fields.normal); }

/// Sets the polarisation of a ray of its new direction: a field along s and s x k, of which a ray that does
/// not keep phases has the linear part.
void polarise(Ray& ray, const core::Vec3& s, const FieldComponents& field, core::Rng& rng) {
  if (ray.keeps_phases) return set_field(ray, s, field);
  const double sign = draw_sign(field.s, field.p, rng);
  ray.polarisation =
      (std::abs(field.s) * s + sign * std::abs(field.p) * s.cross(ray.direction.vec())).normalized();
}

/// Squares of the fields of both polarisations over the normal component of the index.
double squares_over_normal(double transverse, double n1, double n2) {
  const FaceFields fields = face_fields(transverse, n1, n2);
  return (std::norm(fields.s) + squares_p(fields)) / normal_index(n1, transverse).real();
}

/// Amplitude reflected of the electric field, s and p, below the critical angle.
std::array<double, 2> reflected_amplitudes(double transverse, double n1, double n2) {
  const double cos_i = normal_index(n1, transverse).real() / n1,
               cos_t = normal_index(n2, transverse).real() / n2;
  const FresnelAmplitudes r(cos_i, cos_t, n1, n2);
  return {r.s, -r.p};
}

/// Transverse index of scattered light, and its azimuth from that of the incident light.
struct Transverse {
  double length;
  core::SineCosine turn{0.0, 1.0};

  /// The incident light's, with a lateral wave of an index `added` at an azimuth.
  Transverse(double incident, double added, const core::SineCosine& about) {
    const double x = incident + added * about.cosine, y = added * about.sine;
    length = std::sqrt(x * x + y * y);
    if (length > 0.0) turn = {y / length, x / length};
  }
};

/// Power scattered into one direction, per squared height and unit of its distribution over transverse index:
/// by s and p light, and of that the tangential part less the normal part.
struct Scattered {
  std::array<double, 2> power{}, difference{};
  void add(const Scattered& other, double weight) {
    for (std::size_t k = 0; k < 2; ++k) {
      power[k] += weight * other.power[k];
      difference[k] += weight * other.difference[k];
    }
  }
};

Scattered scattered_by(const ScatterAmplitudes& amplitude) {
  Scattered scattered;
  scattered.power = {std::norm(amplitude.s_s) + std::norm(amplitude.p_s),
                     std::norm(amplitude.s_p) + std::norm(amplitude.p_p())};
  scattered.difference = {scattered.power[0], std::norm(amplitude.s_p) + std::norm(amplitude.p_p_along) -
                                                  std::norm(amplitude.p_p_normal)};
  return scattered;
}

/// Light scattered by one medium's face into directions of a transverse index, to both sides, without the
/// factor k^2 (n2^2 - n1^2)^2 / (4 q1) of the incident light.
Scattered scattered_into(const FaceFields& in, double transverse, const core::SineCosine& turn,
                         const std::array<double, 2>& n) {
  Scattered sum;
  for (const bool crosses : {false, true}) {
    const double from = n[crosses ? 1 : 0], onto = n[crosses ? 0 : 1];
    if (transverse >= from) continue;
    const FaceFields out = face_fields(transverse, from, onto);
    sum.add(scattered_by(scatter_amplitudes(in, out, turn, crosses)),
            1.0 / normal_index(from, transverse).real());
  }
  return sum;
}

double incident_factor(double transverse, double n1, double n2, double wave_number) {
  return std::pow(wave_number * (n2 * n2 - n1 * n1), 2) / (4.0 * normal_index(n1, transverse).real());
}

/// Transverse indices of the table: below the lower index, dense towards it, or between the two, dense
/// towards both.
double transverse_at(double place, double low, double high) {
  const double sine = std::sin(0.5 * core::kPi * place);
  return high > 0.0 ? std::sqrt(low * low + (high * high - low * low) * sine * sine) : low * sine;
}
double place_of(double transverse, double low, double high) {
  const double sine2 = high > 0.0 ? (transverse * transverse - low * low) / (high * high - low * low)
                                  : transverse * transverse / (low * low);
  return std::asin(std::sqrt(std::clamp(sine2, 0.0, 1.0))) / (0.5 * core::kPi);
}

}  // namespace

FaceFields face_fields(double transverse, double n1, double n2) {
  const Complex q1 = normal_index(n1, transverse), q2 = normal_index(n2, transverse);
  const Complex sum = n2 * n2 * q1 + n1 * n1 * q2;
  return {2.0 * q1 / (q1 + q2), 2.0 * n1 * q1 * q2 / sum, 2.0 * transverse * n2 * q1 / sum};
}

ScatterAmplitudes scatter_amplitudes(const FaceFields& in, const FaceFields& out,
                                     const core::SineCosine& turn, bool crosses) {
  return {-turn.cosine * in.s * out.s, -turn.sine * in.along * out.s, turn.sine * in.s * out.along,
          -turn.cosine * in.along * out.along, (crosses ? -1.0 : 1.0) * in.normal * out.normal};
}

std::array<SpecularShares, 2> specular_shares(double transverse, double n1, double n2, double wavelength_nm,
                                              const HeightSpectrum& spectrum) {
  if (n1 == n2) return {};
  const double wave_number = core::kTwoPi / wavelength_nm;
  const FaceFields in = face_fields(transverse, n1, n2);
  const double factor = incident_factor(transverse, n1, n2, wave_number);
  const double limit = (transverse + std::max(n1, n2)) / wavelength_nm;
  const double variance = spectrum.variance_nm2(limit);
  Scattered sum;
  for (int i = 0; i < kFrequencySteps; ++i) {
    const double added =
        wavelength_nm * spectrum.frequency_per_nm((i + 0.5) / static_cast<double>(kFrequencySteps), limit);
    for (int k = 0; k < kTurnSteps; ++k) {
      const core::SineCosine about = core::sincos(core::kPi * (k + 0.5) / kTurnSteps);
      const Transverse out(transverse, added, about);
      sum.add(scattered_into(in, out.length, out.turn, {n1, n2}),
              factor * variance / (kFrequencySteps * kTurnSteps));
    }
  }
  std::array<SpecularShares, 2> shares;
  for (std::size_t k = 0; k < 2; ++k) shares[k].scattered = sum.power[k];
  if (transverse >= n2) return shares;
  const double all = spectrum.variance_nm2(std::numeric_limits<double>::infinity());
  Scattered displaced;
  displaced.add(scattered_into(in, transverse, {0.0, 1.0}, {n1, n2}), factor * all);
  const std::array<double, 2> r = reflected_amplitudes(transverse, n1, n2);
  const double phase2 = 4.0 * std::pow(normal_index(n1, transverse).real() * wave_number, 2) * all;
  for (std::size_t k = 0; k < 2; ++k) {
    const double lost_reflectance =
        r[k] * (sum.difference[k] - displaced.difference[k]) + phase2 * r[k] * r[k];
    shares[k].lost_transmittance = shares[k].scattered - lost_reflectance;
  }
  return shares;
}

WaveScatterSurface::WaveScatterSurface(std::shared_ptr<const HeightSpectrum> spectrum,
                                       const std::vector<Node>& nodes)
    : spectrum_(std::move(spectrum)) {
  for (const Node& node : nodes) tables_.push_back(make_table(node));
}

WaveScatterSurface::Table WaveScatterSurface::make_table(const Node& node) {
  Table table;
  table.wavelength_nm = node.wavelength_nm;
  const std::array<double, 2> n{node.inside, node.outside};
  const double low = std::min(n[0], n[1]), high = std::max(n[0], n[1]);
  const auto most = [&](double share) { most_scattered_ = std::max(most_scattered_, share); };
  for (std::size_t i = 0; i < kAngles; ++i) {
    const double place = std::clamp(static_cast<double>(i) / (kAngles - 1), kOffGrazing, 1.0 - kOffGrazing);
    const double below = transverse_at(place, low, 0.0) * (1.0 - kOffGrazing);
    for (std::size_t side = 0; side < 2; ++side) {
      const auto shares = specular_shares(below, n[side], n[1 - side], node.wavelength_nm, *spectrum_);
      for (std::size_t k = 0; k < 2; ++k) {
        table.scattered[side][k][i] = shares[k].scattered;
        most(shares[k].scattered);
        if (n[side] == low) table.lost_transmittance[k][i] = shares[k].lost_transmittance;
      }
    }
    const double above = transverse_at(place, low, high) * (1.0 - kOffGrazing);
    const auto shares = specular_shares(std::max(above, low), high, low, node.wavelength_nm, *spectrum_);
    for (std::size_t k = 0; k < 2; ++k) {
      table.beyond[k][i] = shares[k].scattered;
      most(shares[k].scattered);
    }
    for (const double transverse : {below, above}) {
      double outgoing = 0.0;
      for (std::size_t side = 0; side < 2; ++side)
        if (transverse < n[side]) outgoing += squares_over_normal(transverse, n[side], n[1 - side]);
      table.most_outgoing = std::max(table.most_outgoing, kMargin * outgoing);
    }
  }
  return table;
}

WaveScatterSurface::Neighbours WaveScatterSurface::around(double wavelength_nm) const {
  if (tables_.size() == 1) return {tables_[0], tables_[0], 0.0};
  const auto above = std::upper_bound(tables_.begin() + 1, tables_.end() - 1, wavelength_nm,
                                      [](double nm, const Table& table) { return nm < table.wavelength_nm; });
  const Table &low = *(above - 1), &high = *above;
  return {
      low, high,
      std::clamp((wavelength_nm - low.wavelength_nm) / (high.wavelength_nm - low.wavelength_nm), 0.0, 1.0)};
}

WaveScatterSurface::Shares WaveScatterSurface::shares(const IndexPair& index, Side side, double transverse,
                                                      double wavelength_nm) const {
  const double n1 = index.on(side), n2 = index.on(other(side));
  const double low = std::min(n1, n2), high = std::max(n1, n2);
  const Neighbours tables = around(wavelength_nm);
  const bool beyond = transverse >= low;
  const double at = place_of(transverse, low, beyond ? high : 0.0) * (kAngles - 1);
  const auto cell = std::min(static_cast<std::size_t>(at), kAngles - 2);
  // Shares in units of the squared wave number, which most of their change over wavelength is.
  const auto interpolate = [&](const auto& column_of) {
    const auto in = [&](const Table& table) {
      const Column& column = column_of(table);
      return std::lerp(column[cell], column[cell + 1], at - static_cast<double>(cell)) *
             std::pow(table.wavelength_nm / wavelength_nm, 2);
    };
    return std::lerp(in(tables.low), in(tables.high), tables.weight);
  };
  Shares result{};
  const std::array<double, 2> r =
      beyond ? std::array<double, 2>{1.0, 1.0} : reflected_amplitudes(transverse, n1, n2);
  for (std::size_t k = 0; k < 2; ++k) {
    if (beyond) {
      result.scattered[k] = interpolate([&](const Table& t) -> const Column& { return t.beyond[k]; });
      continue;
    }
    const auto scattered_on = [&](Side of) {
      return interpolate(
          [&](const Table& t) -> const Column& { return t.scattered[static_cast<std::size_t>(of)][k]; });
    };
    result.scattered[k] = scattered_on(side);
    const double lost = interpolate([&](const Table& t) -> const Column& { return t.lost_transmittance[k]; });
    // What is left is reflected; near Brewster's angle the second order would leave less than nothing. The
    // same transmittance in both directions of the light.
    const double most = 1.0 - std::max(result.scattered[k], scattered_on(other(side)));
    result.transmitted[k] = std::clamp(1.0 - r[k] * r[k] - lost, 0.0, most);
  }
  return result;
}

bool WaveScatterSurface::scatter_light(Ray& ray, Side& side, const core::Vec3& against,
                                       const IndexPair& index, SurfaceInteraction& interaction) const {
  core::Rng& rng = interaction.rng;
  const double n1 = index.on(side), n2 = index.on(other(side)), nm = interaction.wavelength_nm;
  const core::Vec3 lateral = ray.direction - ray.direction.dot(against) * against;
  const double sine = lateral.norm();
  constexpr double kNoPlane = 1e-9;
  const core::Vec3 forward =
      sine > kNoPlane ? core::Vec3(lateral / sine) : core::sample_polarisation(against, rng);
  const core::Vec3 sideways = against.cross(forward);
  const double transverse = n1 * std::min(sine, 1.0);
  const FaceFields in = face_fields(std::min(transverse, n1 * (1.0 - kOffGrazing)), n1, n2);
  // The incident field along s = -sideways, and p = s x k; of unpolarised light either one.
  const bool polarised = !ray.polarisation.isZero(0.0);
  FieldComponents field{0.0, 0.0};
  if (!polarised)
    (rng.uniform() < 0.5 ? field.s : field.p) = 1.0;
  else if (ray.keeps_phases)
    field = field_of(ray, -sideways);
  else
    field = {ray.polarisation.dot(-sideways), ray.polarisation.dot((-sideways).cross(ray.direction.vec()))};
  const Neighbours tables = around(nm);
  const double limit = (transverse + std::max(n1, n2)) / nm;
  const double bound = std::max(std::norm(in.s), squares_p(in)) *
                       std::max(tables.low.most_outgoing, tables.high.most_outgoing);
  for (int k = 0; k < kMostTries; ++k) {
    const double added = nm * spectrum_->frequency_per_nm(rng.uniform(), limit);
    const core::SineCosine about = core::sincos_of_turn(rng.uniform());
    const auto [length, turn] = Transverse(transverse, added, about);
    const double wanted = rng.uniform() * bound;
    double sum = 0.0;
    for (const bool crosses : {false, true}) {
      const double from = crosses ? n2 : n1;
      if (length >= from) continue;
      const double normal = normal_index(from, length).real();
      const ScatterAmplitudes amplitude =
          scatter_amplitudes(in, face_fields(length, from, crosses ? n1 : n2), turn, crosses);
      const FieldComponents out{amplitude.s_s * field.s + amplitude.s_p * field.p,
                                amplitude.p_s * field.s + amplitude.p_p() * field.p};
      sum += (std::norm(out.s) + std::norm(out.p)) / normal;
      if (wanted >= sum) continue;
      const double cosine = std::max(normal / from, kOffGrazing);
      const core::Vec3 radial = turn.cosine * forward + turn.sine * sideways;
      const core::Vec3 away = crosses ? core::Vec3(-against) : against;
      ray.direction = (length / from * radial + cosine * away).normalized();
      if (crosses) side = other(side);
      // Polarisations of the reversed wave: s across, and p of either sign of s x k.
      const core::Vec3 s = turn.cosine * sideways - turn.sine * forward;
      if (polarised) polarise(ray, s, {out.s, crosses ? out.p : -out.p}, rng);
      return true;
    }
  }
  return false;
}

SurfaceOutcome WaveScatterSurface::scatter(Ray& ray, Side side, const IndexPair& index,
                                           SurfaceInteraction& interaction) const {
  const core::Vec3 against = side == Side::inside ? core::Vec3(-interaction.normal) : interaction.normal;
  const double n1 = index.on(side), n2 = index.on(other(side));
  const double cos_i = std::clamp(-ray.direction.dot(against), 0.0, 1.0);
  FilmResponse response = film_response(cos_i, n1, {}, n2, interaction.wavelength_nm);
  if (n1 != n2) {
    const double transverse = n1 * std::sqrt(1.0 - cos_i * cos_i);
    const Shares share = shares(index, side, transverse, interaction.wavelength_nm);
    response.transmittance_s = share.transmitted[0];
    response.transmittance_p = share.transmitted[1];
    response.reflectance_s = std::max(0.0, 1.0 - share.scattered[0] - share.transmitted[0]);
    response.reflectance_p = std::max(0.0, 1.0 - share.scattered[1] - share.transmitted[1]);
  }
  switch (interact_at_films(ray, against, response, n1, n2, interaction.rng)) {
    case FilmOutcome::reflected:
      return outcome_on(side);
    case FilmOutcome::transmitted:
      return outcome_on(other(side));
    case FilmOutcome::absorbed:
      break;
  }
  if (!scatter_light(ray, side, against, index, interaction)) reflect(ray, against);
  return outcome_on(side);
}

}  // namespace scintray::optics
