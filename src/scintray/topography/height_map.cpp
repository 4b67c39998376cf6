#include "scintray/topography/height_map.hpp"

#include <algorithm>
#include <cmath>

#include "scintray/core/error.hpp"
#include "scintray/core/text.hpp"

namespace scintray::topography {

namespace {

bool mirrored(const HeightMap& map, Tiling tiling) {
  return tiling == Tiling::mirror || (tiling == Tiling::automatic && !map.periodic);
}

/// Index of a mirrored sequence 0 1 ... n-1 n-2 ... 1.
std::uint32_t fold(std::uint32_t k, std::uint32_t n) { return k < n ? k : 2 * (n - 1) - k; }

}  // namespace

std::string HeightMap::history() const { return core::list_of(steps, "; "); }

std::string tiling_name(const HeightMap& map, Tiling tiling) {
  return mirrored(map, tiling) ? "mirror" : "periodic";
}

optics::HeightField make_height_field(const HeightMap& map, Tiling tiling) {
  if (map.columns < 2 || map.rows < 2)
    throw core::InputError({{},
                            "height map of " + std::to_string(map.columns) + " x " +
                                std::to_string(map.rows) + " points; expected at least 2 x 2",
                            ""});
  const auto missing =
      std::count_if(map.heights_um.begin(), map.heights_um.end(), [](double h) { return std::isnan(h); });
  if (missing > 0)
    throw core::InputError({{},
                            std::to_string(missing) + " of " + std::to_string(map.heights_um.size()) +
                                " points of the height map have no height; a surface needs all of them",
                            "fill them (`--fill`, or fill_missing = true in a scene) or crop the map"});
  const bool mirror = mirrored(map, tiling);
  const std::uint32_t columns = mirror ? 2 * (map.columns - 1) : map.columns;
  const std::uint32_t rows = mirror ? 2 * (map.rows - 1) : map.rows;
  std::vector<float> heights;
  heights.reserve(std::size_t{columns} * rows);
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i)
      heights.push_back(static_cast<float>(map.at(fold(i, map.columns), fold(j, map.rows))));
  return optics::HeightField(std::move(heights), columns, rows, map.pitch_x_um, map.pitch_y_um);
}

}  // namespace scintray::topography
