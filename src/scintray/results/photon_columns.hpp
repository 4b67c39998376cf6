#pragma once
/// Columns of the list of detected photons.

#include <limits>

#include "scintray/tally/result.hpp"

namespace scintray::results::format {

/// Calls visit(name, member) for every column of a kind of row, selected by the type of the null pointer;
/// `member(row)` is a reference to its value.
template <typename Visit>
void for_each_column(const tally::DetectedPhoton*, const Visit& visit) {
  visit(
      "point", [](auto& p) -> auto& { return p.point; });
  visit(
      "event", [](auto& p) -> auto& { return p.event; });
  visit(
      "photon", [](auto& p) -> auto& { return p.photon; });
  visit(
      "part", [](auto& p) -> auto& { return p.part; });
  visit(
      "face", [](auto& p) -> auto& { return p.face; });
  visit(
      "x_mm", [](auto& p) -> auto& { return p.position_mm[0]; });
  visit(
      "y_mm", [](auto& p) -> auto& { return p.position_mm[1]; });
  visit(
      "z_mm", [](auto& p) -> auto& { return p.position_mm[2]; });
  visit(
      "direction_x", [](auto& p) -> auto& { return p.direction[0]; });
  visit(
      "direction_y", [](auto& p) -> auto& { return p.direction[1]; });
  visit(
      "direction_z", [](auto& p) -> auto& { return p.direction[2]; });
  visit(
      "wavelength_nm", [](auto& p) -> auto& { return p.wavelength_nm; });
  visit(
      "time_ns", [](auto& p) -> auto& { return p.time_ns; });
  visit(
      "path_mm", [](auto& p) -> auto& { return p.path_mm; });
  visit(
      "interactions", [](auto& p) -> auto& { return p.interactions; });
}

/// A photon of which no column is known.
inline tally::DetectedPhoton unknown_photon() {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  tally::DetectedPhoton photon;
  photon.position_mm = photon.direction = {kNone, kNone, kNone};
  photon.wavelength_nm = photon.time_ns = photon.path_mm = kNone;
  return photon;
}

}  // namespace scintray::results::format
