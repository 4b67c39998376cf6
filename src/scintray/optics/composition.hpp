#pragma once
/// What a medium is made of, as gamma rays see it.

#include <string>
#include <utility>
#include <vector>

namespace scintray::optics {

/// Share of one chemical element.
struct ElementShare {
  int atomic_number = 0;
  double mass_fraction = 0.0;  ///< of a medium's elements these sum to 1
};

/// Elements by rising atomic number, each once; empty: not known.
using Composition = std::vector<ElementShare>;

/// Elements up to here have cross sections.
inline constexpr int kGreatestAtomicNumber = 92;

/// Composition of a chemical formula, "Lu2SiO5" or "Lu1.8Y0.2SiO5", with the standard atomic weights.
/// Throws InputError (no place) for what is not a formula.
Composition composition_of_formula(const std::string& formula);

/// Composition of mass fractions by element symbol. Throws InputError (no place) with every unknown
/// symbol, share outside 0 to 1, and a sum further than 0.005 from 1 (published tables are rounded);
/// the shares are scaled to sum to 1.
Composition composition_of_mass_fractions(const std::vector<std::pair<std::string, double>>& shares);

/// "Lu".
std::string element_symbol(int atomic_number);

}  // namespace scintray::optics
