#pragma once
/// The numbers that describe a height map, as people read them.

#include <string>
#include <vector>

#include "scintray/topography/height_map.hpp"

namespace scintray::report {

struct MapNumber {
  std::string name;     ///< "Sq"
  std::string value;    ///< "0.4961 um", or "-" when the map does not state
  std::string meaning;  ///< "root mean square height"
};

/// Height, slope, length and direction parameters (ISO 25178-2:2012 where they have its names), and
/// how well the map resolves them. InputError when every point is missing.
std::vector<MapNumber> map_numbers(const topography::HeightMap& map);

}  // namespace scintray::report
