#include "scintray/exchange/gdml/detail/divided_solids.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace scintray::exchange::gdml {

namespace {

void set(Node element, const char* attribute, double value) {
  element.append_attribute(attribute) = fmt::format("{:.17g}", value).c_str();
}

/// Adds an element with these numbers.
Node filled(Node element, std::initializer_list<std::pair<const char*, double>> values) {
  for (const auto& [attribute, value] : values) set(element, attribute, value);
  return element;
}

/// The middle of copy n, from the low end.
double middle_of_copy(const Division& division, int number) {
  return division.offset + (number + 0.5) * division.width;
}

Eigen::Affine3d moved(const core::Vec3& by) { return Eigen::Affine3d(Eigen::Translation3d(by)); }

Eigen::Affine3d turned(const Division& division, int number) {
  return Eigen::Affine3d(Eigen::AngleAxisd(division.offset + number * division.width, core::Vec3::UnitZ()));
}

}  // namespace

DividedSolid::DividedSolid(const LoopedNode& solid, const Definitions& definitions, Solids& solids)
    : solid_(solid), definitions_(definitions), solids_(solids) {}

double DividedSolid::length(const char* attribute) const {
  return definitions_.length(solid_.node, attribute);
}

double DividedSolid::angle(const char* attribute, double fallback) const {
  return definitions_.angle(solid_.node, attribute, fallback);
}

double DividedSolid::extent(DivisionAxis axis) const {
  const LoopScope scope(definitions_, solid_.variables);
  const std::string kind = this->kind();
  const bool flat = kind == "box" || kind == "para", tube = kind == "tube", cone = kind == "cone";
  const bool planes = kind == "polycone" || kind == "polyhedra";
  switch (axis) {
    case DivisionAxis::x:
      return flat ? length("x") : kind == "trd" ? 0.5 * (length("x1") + length("x2")) : 0.0;
    case DivisionAxis::y:
      return flat ? length("y") : kind == "trd" ? 0.5 * (length("y1") + length("y2")) : 0.0;
    case DivisionAxis::z:
      return flat || tube || cone || kind == "trd" ? length("z") : 0.0;
    case DivisionAxis::rho:
      if (planes) {
        const Node first = solid_.node.child("zplane");
        const double unit = definitions_.number(solid_.node, "lunit", 1.0);
        return first ? unit * (definitions_.number(first, "rmax") - definitions_.number(first, "rmin", 0.0))
                     : 0.0;
      }
      return tube ? length("rmax") - length("rmin") : cone ? length("rmax1") - length("rmin1") : 0.0;
    case DivisionAxis::phi:
      break;
  }
  return tube || cone || planes ? angle("deltaphi", core::kTwoPi) : 0.0;
}

VolumeCopy DividedSolid::copy(const Division& division, int number, Node origin) const {
  const LoopScope scope(definitions_, solid_.variables);
  const std::string kind = this->kind();
  if (kind == "box") return box(division, number, origin);
  if (kind == "para") return para(division, number, origin);
  if (kind == "trd") return trd(division, number, origin);
  return kind == "tube" || kind == "cone" ? cone(division, number, origin) : planes(division, number, origin);
}

VolumeCopy DividedSolid::box(const Division& division, int number, Node origin) const {
  core::Vec3 sides(length("x"), length("y"), length("z"));
  const auto axis = static_cast<Eigen::Index>(division.axis);
  const double at = -0.5 * sides[axis] + middle_of_copy(division, number);
  sides[axis] = division.width;
  const Node solid =
      filled(solids_.new_element("box", origin), {{"x", sides.x()}, {"y", sides.y()}, {"z", sides.z()}});
  return {moved(core::Vec3::Unit(axis) * at), solids_.add(solid, origin)};
}

VolumeCopy DividedSolid::para(const Division& division, int number, Node origin) const {
  core::Vec3 sides(length("x"), length("y"), length("z"));
  const auto axis = static_cast<Eigen::Index>(division.axis);
  const double at = -0.5 * sides[axis] + middle_of_copy(division, number);
  sides[axis] = division.width;
  const double alpha = angle("alpha"), theta = angle("theta"), phi = angle("phi");
  const core::Vec3 along[] = {core::Vec3::UnitX(),
                              {std::tan(alpha), 1.0, 0.0},
                              {std::tan(theta) * std::cos(phi), std::tan(theta) * std::sin(phi), 1.0}};
  const Node solid = filled(solids_.new_element("para", origin), {{"x", sides.x()},
                                                                  {"y", sides.y()},
                                                                  {"z", sides.z()},
                                                                  {"alpha", alpha},
                                                                  {"theta", theta},
                                                                  {"phi", phi}});
  return {moved(at * along[axis]), solids_.add(solid, origin)};
}

/// Along x and y the copies of a trapezoid narrow as it does (G4ParameterisationTrdX::ComputeDimensions).
VolumeCopy DividedSolid::trd(const Division& division, int number, Node origin) const {
  const double x1 = length("x1"), x2 = length("x2"), y1 = length("y1"), y2 = length("y2"), z = length("z");
  if (division.axis == DivisionAxis::z) {
    const double low = division.offset + number * division.width, high = low + division.width;
    const auto between = [&](double a, double b, double at) { return a + (b - a) * at / z; };
    const Node solid = filled(solids_.new_element("trd", origin), {{"x1", between(x1, x2, low)},
                                                                   {"x2", between(x1, x2, high)},
                                                                   {"y1", between(y1, y2, low)},
                                                                   {"y2", between(y1, y2, high)},
                                                                   {"z", division.width}});
    return {moved(core::Vec3::UnitZ() * (0.5 * (low + high) - 0.5 * z)), solids_.add(solid, origin)};
  }
  const bool along_x = division.axis == DivisionAxis::x;
  const double low = along_x ? x1 : y1, high = along_x ? x2 : y2, mean = 0.5 * (low + high);
  const double share = middle_of_copy(division, number) / mean - 0.5;  // of the width, from the middle
  const double shift = share * (high - low);
  const double width_low = division.width * low / mean, width_high = division.width * high / mean;
  const Node solid = filled(solids_.new_element("trap", origin), {{"z", z},
                                                                  {"theta", std::atan(shift / z)},
                                                                  {"phi", along_x ? 0.0 : 0.5 * core::kPi},
                                                                  {"y1", along_x ? y1 : width_low},
                                                                  {"x1", along_x ? width_low : x1},
                                                                  {"x2", along_x ? width_low : x1},
                                                                  {"y2", along_x ? y2 : width_high},
                                                                  {"x3", along_x ? width_high : x2},
                                                                  {"x4", along_x ? width_high : x2}});
  return {moved((along_x ? core::Vec3::UnitX() : core::Vec3::UnitY()) * (share * mean)),
          solids_.add(solid, origin)};
}

VolumeCopy DividedSolid::cone(const Division& division, int number, Node origin) const {
  const bool tube = kind() == "tube";
  double inner[] = {length(tube ? "rmin" : "rmin1"), length(tube ? "rmin" : "rmin2")};
  double outer[] = {length(tube ? "rmax" : "rmax1"), length(tube ? "rmax" : "rmax2")};
  double z = length("z"), extent = angle("deltaphi", core::kTwoPi);
  VolumeCopy copy;
  if (division.axis == DivisionAxis::rho) {
    for (int end = 0; end < 2; ++end) {
      // The widths at the upper end of a cone follow from the number.
      const double width =
          tube || end == 0 ? division.width : (outer[end] - inner[end] - division.offset) / division.number;
      const double low = inner[end] + division.offset + number * width;
      inner[end] = low;
      outer[end] = low + width;
    }
  } else if (division.axis == DivisionAxis::phi) {
    copy.in_mother = turned(division, number);
    extent = division.width;
  } else {
    const double low = division.offset + number * division.width;
    for (double* radii : {inner, outer}) {
      const double slope = (radii[1] - radii[0]) / z, start = radii[0];
      radii[0] = start + slope * low;
      radii[1] = start + slope * (low + division.width);
    }
    copy.in_mother = moved(core::Vec3::UnitZ() * (middle_of_copy(division, number) - 0.5 * z));
    z = division.width;
  }
  const Node solid = filled(solids_.new_element(kind(), origin),
                            {{"z", z}, {"startphi", angle("startphi")}, {"deltaphi", extent}});
  if (tube)
    filled(solid, {{"rmin", inner[0]}, {"rmax", outer[0]}});
  else
    filled(solid, {{"rmin1", inner[0]}, {"rmax1", outer[0]}, {"rmin2", inner[1]}, {"rmax2", outer[1]}});
  copy.solid = solids_.add(solid, origin);
  return copy;
}

VolumeCopy DividedSolid::planes(const Division& division, int number, Node origin) const {
  const bool rings = division.axis == DivisionAxis::rho;
  VolumeCopy copy;
  if (!rings) copy.in_mother = turned(division, number);
  const Node solid = filled(solids_.new_element(kind(), origin),
                            {{"startphi", angle("startphi")},
                             {"deltaphi", rings ? angle("deltaphi", core::kTwoPi) : division.width}});
  if (kind() == "polyhedra")
    set(solid, "numsides", rings ? definitions_.number(solid_.node, "numsides") : 1.0);
  const double unit = definitions_.number(solid_.node, "lunit", 1.0);
  definitions_.for_each_child(solid_.node, [&](Node plane) {
    double inner = unit * definitions_.number(plane, "rmin", 0.0),
           outer = unit * definitions_.number(plane, "rmax");
    if (rings) {
      const double width = (outer - inner - division.offset) / division.number;
      inner += division.offset + number * width;
      outer = inner + width;
    }
    Node own = solid;
    filled(own.append_child("zplane"),
           {{"z", unit * definitions_.number(plane, "z")}, {"rmin", inner}, {"rmax", outer}});
  });
  copy.solid = solids_.add(solid, origin);
  return copy;
}

}  // namespace scintray::exchange::gdml
