#include "scintray/medium/medium.hpp"

namespace scintray {

MediumOptics Medium::at(double wavelength_nm) const {
  const double n = index(wavelength_nm);
  return {n, n - wavelength_nm * index.derivative(wavelength_nm), absorption_per_mm(wavelength_nm),
          scattering_per_mm(wavelength_nm)};
}

}  // namespace scintray
