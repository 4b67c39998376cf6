#include "scintray/detector/sensor.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/optics/fresnel.hpp"

namespace scintray::detector {

double Sensor::conversion_probability(double wavelength_nm) const {
  if (cathode) return std::min(1.0, cathode->escape(wavelength_nm));
  const double published = efficiency(wavelength_nm);
  if (definition == EfficiencyDefinition::internal) return published;
  const double reflectance = optics::fresnel(1.0, reference_index, window_index).unpolarised();
  return std::min(1.0, published / (1.0 - reflectance));
}

double Sensor::conversion_probability(double wavelength_nm, double transverse_index) const {
  const double normal = conversion_probability(wavelength_nm);
  return angle ? std::min(1.0, normal * angle_factor(transverse_index)) : normal;
}

double Sensor::conversion_bound(double low_nm, double high_nm) const {
  double bound = std::max(conversion_probability(low_nm), conversion_probability(high_nm));
  for (const double nm : cathode ? cathode->escape.x() : efficiency.x())
    if (nm > low_nm && nm < high_nm) bound = std::max(bound, conversion_probability(nm));
  if (over_face) bound *= over_face->greatest();
  // The transmission of unpolarised light into a window falls with angle.
  if (angle) bound *= angle->factor.max_y() * entrance_correction(largest_angle_rad());
  return std::min(1.0, bound);
}

double Sensor::angle_factor(double transverse_index) const {
  const double index = angle->measured_in == AngleMedium::outside ? angle->reference_index : window_index;
  const double angle_rad = std::min(std::asin(std::min(1.0, transverse_index / index)), largest_angle_rad());
  return angle->factor(angle_rad) * entrance_correction(angle_rad);
}

double Sensor::largest_angle_rad() const { return std::min(core::kPi / 2.0, angle->factor.x().back()); }

double Sensor::entrance_correction(double angle_rad) const {
  if (angle->definition == EfficiencyDefinition::internal) return 1.0;
  const double index = angle->measured_in == AngleMedium::outside ? angle->reference_index : window_index;
  const auto entering = [this](double cosine) {
    return 1.0 - optics::fresnel(cosine, angle->reference_index, window_index).unpolarised();
  };
  const double sine = std::min(1.0, std::sin(angle_rad) * index / angle->reference_index);
  return entering(1.0) / entering(std::sqrt(1.0 - sine * sine));
}

}  // namespace scintray::detector
