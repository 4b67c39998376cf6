#pragma once
/// A measured or made height map, before it becomes a surface that light interacts with.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/optics/height_field.hpp"

namespace scintray::topography {

/// Heights on a rectangular grid, um, with the record of everything that was done to them.
struct HeightMap {
  std::vector<double> heights_um;  ///< row-major, heights_um[row * columns + column]; NaN: missing
  std::uint32_t columns = 0;       ///< along x
  std::uint32_t rows = 0;          ///< along y
  double pitch_x_um = 0.0;
  double pitch_y_um = 0.0;
  std::string title;
  bool periodic = false;           ///< the row after the last is the first again, by construction
  std::vector<std::string> steps;  ///< where it comes from and what was done, in order

  double& at(std::uint32_t column, std::uint32_t row) {
    return heights_um[std::size_t{row} * columns + column];
  }
  double at(std::uint32_t column, std::uint32_t row) const {
    return heights_um[std::size_t{row} * columns + column];
  }
  /// The steps on one line, separated by "; ".
  std::string history() const;
};

/// What the reader is given beyond what the file states. A value given here takes the place of the
/// file's own.
struct ReadOptions {
  std::optional<double> pitch_um;        ///< distance of neighbouring points, both ways
  std::optional<double> width_um;        ///< lateral width of the whole map, columns * pitch
  std::optional<double> height_unit_um;  ///< um per unit of the numbers in the file
  std::optional<std::string> channel;    ///< by name, or the beginning of one name
  bool periodic = false;                 ///< the map is one period of a periodic surface
  bool query_gwyddion = true;            ///< other formats go to the program gwyddion where it is installed
};

/// Reads a height map; the format is found from the content, through gzip where it is compressed.
///
/// Formats: Gwyddion (.gwy, also of version 1) and its simple field (.gsf) and text export with an
/// English or German header, Nanoscope, PicoView (.mi), Igor wave (.ibw), ISO 25178-71 (.sdf) and -72
/// (.x3p), the text matrix of optical profilers ("h=650 w=650 / pixel size=..."), a bare matrix of
/// numbers, a list of x y z on a grid; docs/height_maps.md tells which is which. Anything else is given to
/// the program gwyddion, where it is installed and the options allow it.
///
/// Units are read, never guessed: InputError requests what neither file nor options state. Where a
/// file has several channels and none is requested, the height that a sensor measured goes before
/// another height, forward before backward; InputError lists the channels when that leaves a choice,
/// or when the one requested is not there. The channel and the number of missing points stand in the
/// map's steps. InputError also on truncated data, on sizes that the file cannot hold, and on
/// infinite heights.
HeightMap read_height_map(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes a Gwyddion simple field, metres in single precision. SystemError when it cannot.
void write_gsf(const std::filesystem::path& path, const HeightMap& map);

/// How a finite map is continued without an edge.
enum class Tiling {
  mirror,     ///< mirrored at every edge: period 2 (N - 1) points
  periodic,   ///< repeated as it is
  automatic,  ///< periodic when the map states that it is, else mirror
};

/// "mirror" or "periodic": what `tiling` comes to for this map.
std::string tiling_name(const HeightMap& map, Tiling tiling);

/// The map as a surface without edges. InputError when the map is smaller than 2 x 2 or points of it
/// are missing.
optics::HeightField make_height_field(const HeightMap& map, Tiling tiling = Tiling::automatic);

}  // namespace scintray::topography
