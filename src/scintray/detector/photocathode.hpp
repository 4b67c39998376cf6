#pragma once
/// Photocathodes: a coherent absorbing film between a window and the vacuum of a tube.

#include "scintray/core/curve.hpp"
#include "scintray/optics/coherent_layers.hpp"

namespace scintray::detector {

/// Absorptance of a film for unpolarised light: what a stack n1 | film | n3 neither reflects nor transmits
/// (optics::film_response). D. Motta and S. Schoenert 2005, Nucl. Instrum. Meth. A 539, 217, abstract: index,
/// extinction and thickness determine the fractions reflected, absorbed and transmitted.
/// @param cos_i  of the angle of incidence in the window, in [0, 1]
double film_absorptance(const optics::CoatingLayer& film, double window_index, double index_behind,
                        double cos_i, double wavelength_nm);

/// A photocathode. Light that is absorbed in the film is converted with the probability that the
/// photoelectron leaves it, which depends on the wavelength alone: reflection, transmission, and the
/// dependence of the efficiency on angle and polarisation follow from the film (as D. Motta's photocathode of
/// RAT-PAC, GLG4PMTOpticalModel.cc, has it).
struct Photocathode {
  optics::CoatingLayer film;
  core::Curve escape;  ///< probability that absorbed light is converted, against wavelength (nm)
};

/// The escape probability by which a film of a window converts `efficiency` of the light that is incident on
/// it within the window, at normal incidence: efficiency over absorptance, at every wavelength (nm) of the
/// three tables that lies within all of them, linear between these. A value may exceed 1 where the film
/// absorbs less than the efficiency.
/// @param efficiency  against wavelength (nm), per photon in the window
core::Curve escape_probability(const optics::CoatingLayer& film, double window_index,
                               const core::Curve& efficiency);

}  // namespace scintray::detector
