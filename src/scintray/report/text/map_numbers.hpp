#pragma once
/// The statistics of a height map, formatted.

#include <string>
#include <vector>

#include "scintray/topography/height_map.hpp"

namespace scintray::report {

struct MapNumber {
  std::string name;     ///< "Sq"
  std::string value;    ///< "0.4961 um", or "-" when the map does not determine it
  std::string meaning;  ///< "root mean square height"
};

/// Height, slope, length and direction parameters (ISO 25178-2:2012 where they have its names), and the
/// resolution of the map. InputError when every point is missing.
std::vector<MapNumber> map_numbers(const topography::HeightMap& map);

}  // namespace scintray::report
