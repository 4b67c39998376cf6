#pragma once
/// What a surface table of another program leaves open, and who imports it has to say.

#include <string>
#include <vector>

#include "scintray/core/words.hpp"
#include "scintray/optics/table.hpp"

namespace scintray::exchange {

/// What becomes of light that meets an imported surface from outside, of which the files say nothing.
enum class FromOutside {
  smooth,  ///< a flat face between the two media: Fresnel's equations
  mirror,  ///< all of it is mirrored: the back of an opaque sheet
  absorb,  ///< all of it is absorbed
};

/// What becomes of light that a Davis pair does not reflect.
enum class Unreflected {
  transmitted,  ///< as Geant4 has it while the surface's EFFICIENCY is 0
  absorbed,     ///< as Geant4 has it with an EFFICIENCY above 0 (absorbed or detected)
};

struct ImportSettings {
  optics::IndexPair index;  ///< of the media the table was made for: no file states them
  FromOutside from_outside = FromOutside::smooth;
  Unreflected unreflected = Unreflected::transmitted;  ///< Davis
  double reflectance = 1.0;                            ///< LBNL: Geant4's REFLECTIVITY, in [0, 1]
};

/// The words of the two choices.
inline constexpr core::Word<FromOutside> kFromOutsideWords[] = {
    {"smooth", FromOutside::smooth}, {"mirror", FromOutside::mirror}, {"absorb", FromOutside::absorb}};
inline constexpr core::Word<Unreflected> kUnreflectedWords[] = {{"transmitted", Unreflected::transmitted},
                                                                {"absorbed", Unreflected::absorbed}};

/// InputError unless both indices are finite and at least 1.
void check_indices(const optics::IndexPair& index);

/// All edges at one direction: light that leaves in no other.
optics::DirectionQuantiles single_direction(double polar_rad, double azimuth_rad);

/// Nodes for light from outside, every 0.5 deg and at the critical angle, if there is one.
std::vector<optics::TableNode> outside_nodes(const optics::IndexPair& index, FromOutside choice);

/// A table that is the same within each step: nodes at both ends of every step, 1e-6 rad apart where two
/// meet. `edges_rad` has one value more than `steps` and runs from 0 to pi/2; the incidence of the steps is
/// set here.
std::vector<optics::TableNode> stepped_nodes(const std::vector<double>& edges_rad,
                                             const std::vector<optics::TableNode>& steps);

}  // namespace scintray::exchange
