#include "scintray/source/detail/gamma/scattering.hpp"

#include <cmath>

namespace scintray::source {

ComptonScattering sample_klein_nishina(double energy_keV, core::Rng& rng) {
  const double k = energy_keV / core::kElectronMass_keV;
  const double least = 1.0 / (1.0 + 2.0 * k);  // of the ratio of energies after and before
  const double weight_inverse = -std::log(least);
  const double weight_linear = 0.5 * (1.0 - least * least);
  for (;;) {
    const bool inverse = rng.uniform() * (weight_inverse + weight_linear) < weight_inverse;
    const double u = rng.uniform();
    const double ratio =
        inverse ? std::exp(-weight_inverse * u) : std::sqrt(least * least + (1.0 - least * least) * u);
    const double one_less_cosine = (1.0 - ratio) / (k * ratio);
    const double sine2 = one_less_cosine * (2.0 - one_less_cosine);
    if (rng.uniform() < 1.0 - ratio * sine2 / (1.0 + ratio * ratio))
      return {1.0 - one_less_cosine, ratio * energy_keV};
  }
}

ComptonScattering sample_compton(const ElementData& element, double energy_keV, core::Rng& rng) {
  for (;;) {
    const ComptonScattering scattering = sample_klein_nishina(energy_keV, rng);
    const double half_sine = std::sqrt(std::max(0.0, 0.5 * (1.0 - scattering.cosine)));
    if (rng.uniform() < element.incoherent(energy_keV * kPerAngstromPerkeV * half_sine)) return scattering;
  }
}

}  // namespace scintray::source
