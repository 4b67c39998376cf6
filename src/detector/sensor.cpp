#include "scintray/detector/sensor.hpp"

#include <algorithm>

namespace scintray {

double Sensor::conversion_probability(double wavelength_nm) const {
  const double published = efficiency(wavelength_nm);
  if (definition == EfficiencyDefinition::internal) return published;
  // Normal-incidence Fresnel reflectance, Born & Wolf section 1.5.2 eq. (23).
  const double r = (window_index - reference_index) / (window_index + reference_index);
  return std::min(1.0, published / (1.0 - r * r));
}

}  // namespace scintray
