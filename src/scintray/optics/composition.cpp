#include "scintray/optics/composition.hpp"

#include <xraylib/xraylib.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "scintray/core/error.hpp"

namespace scintray::optics {

namespace {

constexpr double kSumTolerance = 0.005;

/// Message of an xraylib error, which is freed.
std::string take_message(xrl_error* error) {
  const std::string message = error ? error->message : "no reason given";
  xrl_error_free(error);
  return message;
}

/// Atomic number of an element symbol; 0 when there is no such element.
int atomic_number_of(const std::string& symbol) {
  xrl_error* error = nullptr;
  const int z = SymbolToAtomicNumber(symbol.c_str(), &error);
  xrl_error_free(error);
  return z;
}

Composition sorted(const std::map<int, double>& shares) {
  double sum = 0.0;
  for (const auto& [z, share] : shares) sum += share;
  Composition composition;
  for (const auto& [z, share] : shares) composition.push_back({z, share / sum});
  return composition;
}

}  // namespace

Composition composition_of_formula(const std::string& formula) {
  const char* hint = "write element symbols and numbers, as \"Lu2SiO5\" or \"Lu1.8Y0.2SiO5\"";
  xrl_error* error = nullptr;
  const std::unique_ptr<compoundData, void (*)(compoundData*)> parsed(CompoundParser(formula.c_str(), &error),
                                                                      FreeCompoundData);
  if (!parsed)
    throw core::InputError(
        core::Problem{{}, "\"" + formula + "\" is not a chemical formula: " + take_message(error), hint});
  std::map<int, double> shares;
  for (int i = 0; i < parsed->nElements; ++i) {
    if (parsed->Elements[i] > kGreatestAtomicNumber)
      throw core::InputError(core::Problem{{},
                                           "\"" + formula + "\" has the element " +
                                               element_symbol(parsed->Elements[i]) +
                                               ", but cross sections go up to uranium",
                                           hint});
    shares[parsed->Elements[i]] = parsed->massFractions[i];
  }
  return sorted(shares);
}

Composition composition_of_mass_fractions(const std::vector<std::pair<std::string, double>>& shares) {
  core::Problems problems;
  std::map<int, double> by_number;
  double sum = 0.0;
  for (const auto& [symbol, share] : shares) {
    const int z = atomic_number_of(symbol);
    if (z < 1 || z > kGreatestAtomicNumber)
      problems.add({}, "\"" + symbol + "\" is not the symbol of an element from hydrogen to uranium",
                   "write symbols as in { H = 0.112, O = 0.888 }");
    if (!(share > 0.0 && share <= 1.0))
      problems.add({}, "the mass fraction of " + symbol + " is " + std::to_string(share),
                   "a mass fraction lies above 0 and up to 1");
    by_number[z] = share;
    sum += share;
  }
  if (problems.empty() && std::abs(sum - 1.0) > kSumTolerance)
    problems.add({}, "the mass fractions sum to " + std::to_string(sum) + ", not to 1",
                 "give shares of the whole mass");
  problems.throw_if_any();
  return sorted(by_number);
}

std::string element_symbol(int atomic_number) {
  const std::unique_ptr<char, void (*)(void*)> symbol(AtomicNumberToSymbol(atomic_number, nullptr), xrlFree);
  return symbol ? symbol.get() : std::to_string(atomic_number);
}

}  // namespace scintray::optics
