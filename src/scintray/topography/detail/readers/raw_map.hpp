#pragma once
/// Content of a height map file, before missing units are supplied.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/zip_archive.hpp"

namespace scintray::topography {

inline constexpr double kUmPerMetre = 1e6;

/// Limit of the points of a map: 1 GiB of heights.
inline constexpr std::size_t kMostPoints = std::size_t{1} << 27;

/// Options of a parser, and the file's name in messages.
struct ReadRequest {
  std::string file;
  std::optional<std::string> channel;  ///< by name; empty: the rule of choose_channel
};

struct RawMap {
  std::string format;
  std::string title;
  std::uint32_t columns = 0, rows = 0;
  std::vector<double> values;  ///< row-major, top row first, in the file's unit; NaN where missing
  std::optional<double> pitch_x_um, pitch_y_um;
  double pitch_ratio = 1.0;              ///< pitch along y over x, known even without a unit
  std::optional<double> height_unit_um;  ///< um per unit of `values`
  std::string height_unit;               ///< as in the file; empty when it has none
  std::string channel;                   ///< the channel read; empty in a format without names
  std::vector<std::string> channels;     ///< all of them, by name
  std::vector<std::string> notes;        ///< processing done or left out, for the map's steps
};

/// Length in um of a unit as instruments write it ("m", "µm" in UTF-8 or Latin-1, "~m", "nm", ...);
/// empty when it is not a length.
std::optional<double> length_unit_um(std::string_view unit);

/// The number that `text` consists of; empty when it is not one number.
std::optional<double> whole_number(std::string_view text);

std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

/// Number of points of a map of `columns` x `rows`. InputError unless both are at least 1, the
/// product is at most kMostPoints, and `bytes_there` can hold it at `bytes_a_point`.
std::size_t checked_points(double columns, double rows, std::size_t bytes_there, std::size_t bytes_a_point,
                           const std::string& file);

/// Reverses the order of rows, for formats that store the bottom row first.
void flip_rows(RawMap& map);

}  // namespace scintray::topography
