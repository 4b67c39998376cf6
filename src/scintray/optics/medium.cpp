#include "scintray/optics/medium.hpp"

namespace scintray::optics {

MediumOptics Medium::at(double wavelength_nm) const {
  const double n = index(wavelength_nm);
  const double shifting_per_mm = shifter ? shifter->absorption_per_mm()(wavelength_nm) : 0.0;
  const double by_particles = particles ? particles->per_mm(wavelength_nm) : 0.0;
  return {
      n, group_index ? (*group_index)(wavelength_nm) : n - wavelength_nm * index.derivative(wavelength_nm),
      absorption_per_mm(wavelength_nm) + shifting_per_mm, scattering_per_mm(wavelength_nm) + by_particles};
}

}  // namespace scintray::optics
