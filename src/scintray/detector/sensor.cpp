#include "scintray/detector/sensor.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/optics/fresnel.hpp"

namespace scintray::detector {

double Sensor::conversion_probability(double wavelength_nm) const {
  const double published = efficiency(wavelength_nm);
  if (definition == EfficiencyDefinition::internal) return published;
  const double reflectance = optics::fresnel(1.0, reference_index, window_index).unpolarised();
  return std::min(1.0, published / (1.0 - reflectance));
}

double Sensor::conversion_probability(double wavelength_nm, double transverse_index) const {
  const double normal = conversion_probability(wavelength_nm);
  return angle ? std::min(1.0, normal * angle_factor(transverse_index)) : normal;
}

double Sensor::angle_factor(double transverse_index) const {
  const double index = angle->measured_in == AngleMedium::outside ? angle->reference_index : window_index;
  const double angle_rad =
      std::min(std::asin(std::min(1.0, transverse_index / index)), angle->factor.x().back());
  const double published = angle->factor(angle_rad);
  if (angle->definition == EfficiencyDefinition::internal) return published;
  // The transmission into the window at this angle, relative to normal incidence, is included in the
  // published number.
  const auto entering = [this](double cosine) {
    return 1.0 - optics::fresnel(cosine, angle->reference_index, window_index).unpolarised();
  };
  const double sine = std::min(1.0, std::sin(angle_rad) * index / angle->reference_index);
  return published * entering(1.0) / entering(std::sqrt(1.0 - sine * sine));
}

}  // namespace scintray::detector
