#pragma once
/// Elemental composition of a medium, for the interactions of gamma rays.

#include <string>
#include <utility>
#include <vector>

namespace scintray::optics {

/// Mass fraction of one chemical element.
struct ElementShare {
  int atomic_number = 0;
  double mass_fraction = 0.0;  ///< the sum over a medium's elements is 1
};

/// Elements in order of atomic number, each once; empty: not available.
using Composition = std::vector<ElementShare>;

/// Largest atomic number of an element with cross sections.
inline constexpr int kGreatestAtomicNumber = 92;

/// Composition of a chemical formula, "Lu2SiO5" or "Lu1.8Y0.2SiO5", with the standard atomic weights. Throws
/// InputError (without a place) for a string that is not a formula.
Composition composition_of_formula(const std::string& formula);

/// Composition from mass fractions by element symbol. Throws InputError (without a place) with every unknown
/// symbol, every share outside 0 to 1, and a sum further than 0.005 from 1 (published tables are rounded);
/// the shares are scaled to a sum of 1.
Composition composition_of_mass_fractions(const std::vector<std::pair<std::string, double>>& shares);

/// Symbol of an element, such as "Lu".
std::string element_symbol(int atomic_number);

}  // namespace scintray::optics
