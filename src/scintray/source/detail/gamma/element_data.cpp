#include "scintray/source/detail/gamma/element_data.hpp"

#include <xraylib/xraylib.h>

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/optics/composition.hpp"
#include "scintray/scene_file/gamma_source.hpp"

namespace scintray::source {

namespace {

constexpr double kAvogadro_per_barn_cm2 = 0.602214076;      // 1/mol times 1e-24 cm2
constexpr double kElectronRadiusSquared_barn = 0.07940787;  // CODATA 2018
constexpr double kPhotoelectricJoin_keV = 790.0;            // xraylib's tables end at 800 keV
constexpr double kLowest_x = 1e-3, kHighest_x = 300.0;      // 3 MeV backwards is 242 / angstrom
constexpr std::size_t kPoints_x = 1201;
constexpr double kPairFit_keV = 1500.0;

/// A value of xraylib, or 0 where it has none.
template <class Call>
double number_or_zero(const Call& call) {
  xrl_error* error = nullptr;
  const double value = call(&error);
  xrl_error_free(error);
  return std::isfinite(value) && value > 0.0 ? value : 0.0;
}

/// Energy dependence of the K shell's photoelectric cross section (source: ElementData).
double sauter(double energy_keV) {
  const double k = energy_keV / core::kElectronMass_keV;
  const double gamma = 1.0 + k;
  const double momentum = std::sqrt(gamma * gamma - 1.0);
  const double log = std::log((gamma + momentum) / (gamma - momentum));
  return std::pow(momentum, 3) / std::pow(k, 5) *
         (4.0 / 3.0 + gamma * (gamma - 2.0) / (gamma + 1.0) * (1.0 - log / (2.0 * gamma * momentum)));
}

double polynomial(const std::array<double, 6>& coefficients, double x) {
  double value = 0.0;
  for (std::size_t i = coefficients.size(); i-- > 0;) value = value * x + coefficients[i];
  return value;
}

}  // namespace

ElementData::ElementData(int atomic_number) : z_(atomic_number) {
  const double weight = number_or_zero([&](xrl_error** e) { return AtomicWeight(z_, e); });
  if (z_ < 1 || z_ > optics::kGreatestAtomicNumber || weight <= 0.0)
    throw core::InternalError("no cross sections for atomic number " + std::to_string(z_));
  atoms_per_g_barn_ = kAvogadro_per_barn_cm2 / weight;
  tabulate_scattering();
  read_k_shell();
  for (const int shell : {K_SHELL, L1_SHELL, L2_SHELL, L3_SHELL}) {
    const double edge = number_or_zero([&](xrl_error** e) { return EdgeEnergy(z_, shell, e); });
    if (edge >= scene_file::kLowestGamma_keV) edges_.push_back(edge);
  }
}

void ElementData::tabulate_scattering() {
  const double step = std::log(kHighest_x / kLowest_x) / (kPoints_x - 1);
  for (std::size_t i = 0; i < kPoints_x; ++i) {
    x_.push_back(kLowest_x * std::exp(step * static_cast<double>(i)));
    const double x = x_.back();
    incoherent_.push_back(
        std::min(1.0, number_or_zero([&](xrl_error** e) { return SF_Compt(z_, x, e); }) / z_));
    // Splines of the form factor oscillate about zero where it is 1e-7 of the atomic number.
    form_factor_squared_.push_back(
        std::pow(number_or_zero([&](xrl_error** e) { return FF_Rayl(z_, x, e); }), 2));
  }
  form_integral_.push_back(form_factor_squared_.front() * x_.front() * x_.front());
  for (std::size_t i = 1; i < kPoints_x; ++i)
    form_integral_.push_back(form_integral_.back() +
                             0.5 * (form_factor_squared_[i] + form_factor_squared_[i - 1]) *
                                 (x_[i] * x_[i] - x_[i - 1] * x_[i - 1]));
}

void ElementData::read_k_shell() {
  k_.edge_keV = number_or_zero([&](xrl_error** e) { return EdgeEnergy(z_, K_SHELL, e); });
  const double jump = number_or_zero([&](xrl_error** e) { return JumpFactor(z_, K_SHELL, e); });
  k_.share = jump > 1.0 ? 1.0 - 1.0 / jump : 0.0;
  k_.yield = number_or_zero([&](xrl_error** e) { return FluorYield(z_, K_SHELL, e); });
  double sum = 0.0;
  for (int line = KL1_LINE; line >= KP5_LINE; --line) {
    const double energy = number_or_zero([&](xrl_error** e) { return LineEnergy(z_, line, e); });
    const double rate = number_or_zero([&](xrl_error** e) { return RadRate(z_, line, e); });
    if (energy <= 0.0 || rate <= 0.0 || energy >= k_.edge_keV) continue;
    sum += rate;
    k_.lines.push_back({energy, sum});
  }
  for (XrayLine& line : k_.lines) line.most /= sum;
}

double ElementData::cross_section_cm2_per_g(GammaProcess process, double energy_keV) const {
  switch (process) {
    case GammaProcess::photoelectric:
      return photoelectric(energy_keV);
    case GammaProcess::compton:
      return compton_barn(energy_keV) * atoms_per_g_barn_;
    case GammaProcess::rayleigh:
      return rayleigh_barn(energy_keV) * atoms_per_g_barn_;
    case GammaProcess::pair:
      return pair_barn(energy_keV) * atoms_per_g_barn_;
  }
  throw core::InternalError("a process without a cross section");
}

double ElementData::photoelectric(double energy_keV) const {
  const double known_keV = std::min(energy_keV, kPhotoelectricJoin_keV);
  const double known = number_or_zero([&](xrl_error** e) { return CS_Photo(z_, known_keV, e); });
  return energy_keV > known_keV ? known * sauter(energy_keV) / sauter(known_keV) : known;
}

double ElementData::pair_barn(double energy_keV) const {
  if (energy_keV <= 2.0 * core::kElectronMass_keV) return 0.0;
  const double log = std::log(std::max(energy_keV, kPairFit_keV) / core::kElectronMass_keV);
  const double f1 = polynomial({8.7842e2, -1.9625e3, 1.2949e3, -2.0028e2, 1.2575e1, -2.8333e-1}, log);
  const double f2 = polynomial({-1.0342e1, 1.7692e1, -8.2381, 1.3063, -9.0815e-2, 2.3586e-3}, log);
  const double f3 = polynomial({-4.5263e2, 1.1161e3, -8.6749e2, 2.1773e2, -2.0467e1, 6.5372e-1}, log);
  const double z = z_;
  const double barn = 1e-6 * z * (z + 1.0) * std::max(0.0, f1 + f2 * z + f3 / z);
  if (energy_keV >= kPairFit_keV) return barn;
  const double rise =
      (energy_keV - 2.0 * core::kElectronMass_keV) / (kPairFit_keV - 2.0 * core::kElectronMass_keV);
  return barn * rise * rise;
}

template <class Weight>
double ElementData::integrate(double energy_keV, const Weight& weight) const {
  const double scale = 1.0 / (energy_keV * kPerAngstromPerkeV);  // t = sin(angle / 2) = x scale
  // Solid angle is 8 pi t dt; t dt = t^2 dln t, and the grid is equidistant in ln t.
  const double step = std::log(x_[1] / x_[0]);
  const auto integrand = [&](std::size_t i, double t) { return weight(t, i) * t * t; };
  double sum = 0.5 * weight(0.0, 0) * std::pow(x_.front() * scale, 2);  // from 0 to the first point
  double before = integrand(0, x_.front() * scale);
  for (std::size_t i = 1; i < x_.size(); ++i) {
    const double t = x_[i] * scale;
    if (t >= 1.0) {
      sum += 0.5 * (before + integrand(i, 1.0)) * std::log(1.0 / (x_[i - 1] * scale));
      break;
    }
    const double here = integrand(i, t);
    sum += 0.5 * (before + here) * step;
    before = here;
  }
  return 8.0 * core::kPi * sum;
}

double ElementData::rayleigh_barn(double energy_keV) const {
  return integrate(energy_keV, [&](double t, std::size_t i) {
    const double cosine = 1.0 - 2.0 * t * t;
    return 0.5 * kElectronRadiusSquared_barn * (1.0 + cosine * cosine) * form_factor_squared_[i];
  });
}

double ElementData::compton_barn(double energy_keV) const {
  const double k = energy_keV / core::kElectronMass_keV;
  return integrate(energy_keV, [&](double t, std::size_t i) {
    const double ratio = 1.0 / (1.0 + 2.0 * k * t * t);  // of the energies after and before
    const double sine2 = 4.0 * t * t * (1.0 - t * t);
    return 0.5 * kElectronRadiusSquared_barn * ratio * ratio * (ratio + 1.0 / ratio - sine2) * z_ *
           incoherent_[i];
  });
}

double ElementData::incoherent(double x) const {
  if (x <= x_.front()) return incoherent_.front() * std::pow(x / x_.front(), 2);
  if (x >= x_.back()) return incoherent_.back();
  const double position = std::log(x / x_.front()) / std::log(x_[1] / x_[0]);
  const auto i = std::min(static_cast<std::size_t>(position), x_.size() - 2);
  return std::lerp(incoherent_[i], incoherent_[i + 1], position - static_cast<double>(i));
}

double ElementData::sample_rayleigh_cosine(double energy_keV, core::Rng& rng) const {
  const double greatest_x = energy_keV * kPerAngstromPerkeV;
  for (;;) {
    const double wanted = rng.uniform() * form_integral_.back();
    const auto after = std::upper_bound(form_integral_.begin(), form_integral_.end(), wanted);
    const auto i = static_cast<std::size_t>(after - form_integral_.begin());
    if (i >= x_.size()) continue;
    const double below = i > 0 ? form_integral_[i - 1] : 0.0;
    const double x2_below = i > 0 ? x_[i - 1] * x_[i - 1] : 0.0;
    const double x2 = std::lerp(x2_below, x_[i] * x_[i], (wanted - below) / (form_integral_[i] - below));
    if (x2 > greatest_x * greatest_x) continue;
    const double cosine = 1.0 - 2.0 * x2 / (greatest_x * greatest_x);
    if (rng.uniform() < 0.5 * (1.0 + cosine * cosine)) return cosine;
  }
}

}  // namespace scintray::source
