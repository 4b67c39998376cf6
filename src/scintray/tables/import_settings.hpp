#pragma once
/// Settings for the import of another program's surface table: quantities that its files do not contain.

#include <string>
#include <vector>

#include "scintray/core/words.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::tables {

/// Treatment of light incident on an imported surface from outside, which the files do not describe.
enum class FromOutside {
  smooth,  ///< smooth interface of the two media: Fresnel's equations
  mirror,  ///< specular reflection of all light: the back of an opaque sheet
  absorb,  ///< absorption of all light
};

/// Treatment of light that a Davis pair does not reflect.
enum class Unreflected {
  transmitted,  ///< as in Geant4 with an EFFICIENCY of 0
  absorbed,     ///< as in Geant4 with an EFFICIENCY above 0 (absorbed or detected)
};

struct ImportSettings {
  optics::IndexPair index;  ///< of the media of the table: no file states them
  FromOutside from_outside = FromOutside::smooth;
  Unreflected unreflected = Unreflected::transmitted;  ///< Davis
  double reflectance = 1.0;                            ///< LBNL: Geant4's REFLECTIVITY, in [0, 1]
};

/// The words of the two choices.
inline constexpr core::Word<FromOutside> kFromOutsideWords[] = {
    {"smooth", FromOutside::smooth}, {"mirror", FromOutside::mirror}, {"absorb", FromOutside::absorb}};
inline constexpr core::Word<Unreflected> kUnreflectedWords[] = {{"transmitted", Unreflected::transmitted},
                                                                {"absorbed", Unreflected::absorbed}};

/// Throws InputError unless both indices are finite and at least 1.
void check_indices(const optics::IndexPair& index);

/// A distribution with all edges at one direction: all light leaves in it.
optics::DirectionQuantiles single_direction(double polar_rad, double azimuth_rad);

/// Incidence nodes for light from outside, every 0.5 deg and at the critical angle, if there is one.
std::vector<optics::TableNode> outside_nodes(const optics::IndexPair& index, FromOutside choice);

/// A table that is constant within each step: nodes at both ends of every step, 1e-6 rad apart where two
/// steps join. `edges_rad` has one value more than `steps` and runs from 0 to pi/2; the incidence of the
/// steps is set here.
std::vector<optics::TableNode> stepped_nodes(const std::vector<double>& edges_rad,
                                             const std::vector<optics::TableNode>& steps);

}  // namespace scintray::tables
