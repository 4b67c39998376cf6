#pragma once
/// Solids of the copies of a division.

#include <string>

#include "scintray/exchange/gdml/detail/copies.hpp"

namespace scintray::exchange::gdml {

enum class DivisionAxis { x, y, z, rho, phi };

/// A division as stated, in mm and rad: a number of 0 follows from the width, a width of 0 from the number.
struct Division {
  DivisionAxis axis = DivisionAxis::x;
  double number = 0.0, width = 0.0, offset = 0.0;
};

/// The solid that is divided.
class DividedSolid {
 public:
  /// @param solid  evaluated with its own loop variables
  DividedSolid(const LoopedNode& solid, const Definitions& definitions, Solids& solids);

  /// Kind of the solid: "box".
  std::string kind() const { return solid_.node.name(); }
  /// Extent along an axis; 0 for one along which this solid is not divided.
  double extent(DivisionAxis axis) const;
  /// The copy of a number of a division with a number and a width above 0.
  /// @param origin  of the division, for messages about the copy's solid
  VolumeCopy copy(const Division& division, int number, Node origin) const;

 private:
  double length(const char* attribute) const;
  double angle(const char* attribute, double fallback = 0.0) const;
  VolumeCopy box(const Division& division, int number, Node origin) const;
  VolumeCopy para(const Division& division, int number, Node origin) const;
  VolumeCopy trd(const Division& division, int number, Node origin) const;
  VolumeCopy cone(const Division& division, int number, Node origin) const;
  VolumeCopy planes(const Division& division, int number, Node origin) const;

  const LoopedNode& solid_;
  const Definitions& definitions_;
  Solids& solids_;
};

}  // namespace scintray::exchange::gdml
