#pragma once
/// Measured or synthetic height maps, before they become surfaces.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scintray/optics/height_field.hpp"

namespace scintray::topography {

/// Heights on a rectangular grid, um, with the record of their processing.
struct HeightMap {
  std::vector<double> heights_um;  ///< row-major, heights_um[row * columns + column]; NaN: missing
  std::uint32_t columns = 0;       ///< along x
  std::uint32_t rows = 0;          ///< along y
  double pitch_x_um = 0.0;
  double pitch_y_um = 0.0;
  std::string title;
  bool periodic = false;           ///< the row after the last is the first, by construction
  std::vector<std::string> steps;  ///< origin and processing steps, in order

  double& at(std::uint32_t column, std::uint32_t row) {
    return heights_um[std::size_t{row} * columns + column];
  }
  double at(std::uint32_t column, std::uint32_t row) const {
    return heights_um[std::size_t{row} * columns + column];
  }
  /// The steps on one line, separated by "; ".
  std::string history() const;
};

/// Options of the reader beyond the content of the file. A value set here replaces the file's own.
struct ReadOptions {
  std::optional<double> pitch_um;        ///< distance of neighbouring points, both ways
  std::optional<double> width_um;        ///< lateral width of the whole map, columns * pitch
  std::optional<double> height_unit_um;  ///< um per unit of the numbers in the file
  std::optional<std::string> channel;    ///< by name, or the unique beginning of a name
  bool periodic = false;                 ///< the map is one period of a periodic surface
  bool query_gwyddion = true;            ///< other formats are converted by gwyddion where it is installed
};

/// Height map of a file; the format is detected from the content, also within gzip.
///
/// Formats: Gwyddion (.gwy, also of version 1) and its simple field (.gsf) and text export with an
/// English or German header, Nanoscope, PicoView (.mi), Igor wave (.ibw), ISO 25178-71 (.sdf) and -72
/// (.x3p), the text matrix of optical profilers ("h=650 w=650 / pixel size=..."), a bare matrix of
/// numbers, a list of x y z on a grid; docs/height_maps.md describes them. Other files are passed to
/// the program gwyddion, where it is installed and the options allow it.
///
/// Units are read, never guessed: InputError when neither file nor options state one. In a file of several
/// channels with none requested, the height that a sensor measured has precedence over another height,
/// forward over backward; InputError lists the channels when this leaves several, or when the requested one
/// does not exist. The channel and the number of missing points are in the map's steps. InputError also on
/// truncated data, on sizes that the file cannot hold, and on infinite heights.
HeightMap read_height_map(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes a Gwyddion simple field, metres in single precision. Throws SystemError on failure.
void write_gsf(const std::filesystem::path& path, const HeightMap& map);

/// Continuation of a finite map without an edge.
enum class Tiling {
  mirror,     ///< mirrored at every edge: period 2 (N - 1) points
  periodic,   ///< repeated as it is
  automatic,  ///< periodic when the map is, else mirror
};

/// "mirror" or "periodic": the effect of `tiling` for this map.
std::string tiling_name(const HeightMap& map, Tiling tiling);

/// The map as a surface without edges. InputError when the map is smaller than 2 x 2 or has missing points.
optics::HeightField make_height_field(const HeightMap& map, Tiling tiling = Tiling::automatic);

}  // namespace scintray::topography
