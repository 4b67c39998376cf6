#include <fmt/format.h>

#include <string_view>

#include "scintray/exchange/gdml/detail/optical.hpp"

namespace scintray::exchange::gdml {

namespace {

double total(const std::map<std::string, double>& masses) {
  double sum = 0.0;
  for (const auto& [symbol, mass] : masses) sum += mass;
  return sum;
}

}  // namespace

Substances::Substances(const Definitions& definitions) : definitions_(definitions) {
  definitions_.for_each_of("materials", [&](Node node) {
    by_name_.emplace(definitions_.name(node.attribute("name").value(), node), node);
  });
}

Node Substances::find(Node reference) const {
  const auto found = by_name_.find(definitions_.name(reference.attribute("ref").value(), reference));
  return found == by_name_.end() ? Node() : found->second;
}

/// Molar mass of an element, that of its isotopes by their shares where it consists of such; 0 when not
/// stated.
double Substances::molar_mass(Node element) const {
  if (const Node atom = element.child("atom")) return definitions_.number(atom, "value");
  double sum = 0.0;
  for (const Node share : element.children("fraction"))
    if (const Node isotope = find(share); isotope && isotope.child("atom"))
      sum += definitions_.number(share, "n") * definitions_.number(isotope.child("atom"), "value");
  return sum;
}

/// Symbol of an element, of a material of one element, or of the isotopes of an element; empty when not
/// known.
std::string Substances::symbol_of(Node element) const {
  // By atomic number, up to that of the last element with tables of cross sections.
  static constexpr std::string_view kSymbols =
      "H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se Br Kr "
      "Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho Er Tm Yb "
      "Lu Hf Ta W Re Os Ir Pt Au Hg Tl Pb Bi Po At Rn Fr Ra Ac Th Pa U Np Pu ";
  Node with_number = element;
  if (!with_number.attribute("Z")) with_number = find(element.child("fraction"));
  if (!with_number || !with_number.attribute("Z")) return {};
  const double number = definitions_.number(with_number, "Z");
  std::string_view rest = kSymbols;
  for (double z = 1.0; z < number && !rest.empty(); ++z) rest.remove_prefix(rest.find(' ') + 1);
  return number >= 1.0 ? std::string(rest.substr(0, rest.find(' '))) : std::string();
}

/// Masses of the elements of a material or element; empty when something is not stated.
Substances::Masses Substances::masses_of(Node node, int depth) const {
  constexpr int kDeepest = 20;  // a material may refer to itself
  if (!node || depth > kDeepest) return {};
  const bool is_element = std::string_view(node.name()) == "element";
  if (is_element || node.attribute("Z")) {
    const std::string symbol = symbol_of(node);
    const double mass = molar_mass(node);
    return symbol.empty() || !(mass > 0.0) ? Masses() : Masses{{symbol, mass}};
  }
  Masses masses;
  for (const Node part : node.children()) {
    const std::string_view kind = part.name();
    if (kind != "fraction" && kind != "composite") continue;
    const Masses of_part = masses_of(find(part), depth + 1);
    const double sum = total(of_part);
    if (!(sum > 0.0)) return {};
    // A fraction is a share of the mass, a composite a number of atoms or molecules.
    const double factor = definitions_.number(part, "n") / (kind == "fraction" ? sum : 1.0);
    for (const auto& [symbol, mass] : of_part) masses[symbol] += factor * mass;
  }
  return masses;
}

std::string Substances::mass_fractions(Node material) const {
  const Masses masses = masses_of(material, 0);
  const double sum = total(masses);
  std::string list;
  if (sum > 0.0)
    for (const auto& [symbol, mass] : masses)
      list += fmt::format("{}{} = {:.9g}", list.empty() ? "" : ", ", symbol, mass / sum);
  return list;
}

}  // namespace scintray::exchange::gdml
