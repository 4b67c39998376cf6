#pragma once
/// Options of every command that reads a height map.

#include <CLI/CLI.hpp>
#include <string>

#include "scintray/topography/height_map.hpp"
#include "scintray/topography/preparation.hpp"

namespace scintray::cli {

/// A length such as "0.175 um", in um. InputError when it is not a length.
double length_um(const std::string& text);

/// Options of the reader, which supplement the file.
struct MapOptions {
  std::string map, channel, pitch, width, unit;
  bool periodic = false;
};
void add_map_options(CLI::App& app, MapOptions& options);
topography::ReadOptions read_options(const MapOptions& options);
topography::HeightMap read_map(const MapOptions& options);

/// Options of the preparation.
struct PreparationOptions {
  std::string level = "plane", crop, loess, gaussian;
  double outliers = 0.0;  ///< 0: none are removed
  int outlier_radius = 2;
  int median = 0;  ///< 0: no median filter
  bool fill = false;
};
void add_preparation_options(CLI::App& app, PreparationOptions& options);
/// The preparation. InputError for invalid values of options.
topography::Preparation preparation_of(const PreparationOptions& options);

}  // namespace scintray::cli
