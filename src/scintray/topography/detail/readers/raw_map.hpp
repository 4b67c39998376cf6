#pragma once
/// What a height map file states, before units that it lacks are supplied. Internal to the readers.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/zip_archive.hpp"

namespace scintray::topography {

inline constexpr double kUmPerMetre = 1e6;

/// Most points of a map that is read: 1 GiB of heights.
inline constexpr std::size_t kMostPoints = std::size_t{1} << 27;

/// What a parser is requested, and what the file is called in messages.
struct ReadRequest {
  std::string file;
  std::optional<std::string> channel;  ///< by name; nothing: the rule of choose_channel
};

struct RawMap {
  std::string format;
  std::string title;
  std::uint32_t columns = 0, rows = 0;
  std::vector<double> values;  ///< row-major, top row first, in the file's unit; NaN where missing
  std::optional<double> pitch_x_um, pitch_y_um;
  double pitch_ratio = 1.0;              ///< pitch along y over x, known even where no unit is
  std::optional<double> height_unit_um;  ///< um per unit of `values`
  std::string height_unit;               ///< as the file writes it; empty when it writes none
  std::string channel;                   ///< the channel taken; empty in a format without names
  std::vector<std::string> channels;     ///< all of them, by name
  std::vector<std::string> notes;        ///< what was done or left, for the map's steps
};

/// um per length unit as instruments write it ("m", "µm" in UTF-8 or Latin-1, "~m", "nm", ...);
/// nothing when it is no length.
std::optional<double> length_unit_um(std::string_view unit);

/// A number that is the whole of `text`, or nothing.
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
