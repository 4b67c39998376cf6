#pragma once
/// What a height map file says, before units that it lacks are supplied. Internal to the readers.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scintray {

struct RawMap {
  std::string format;
  std::string title;
  std::uint32_t columns = 0, rows = 0;
  std::vector<double> values;  ///< row-major, in the file's unit
  std::optional<double> pitch_x_um, pitch_y_um;
  std::optional<double> height_unit_um;  ///< um per unit of `values`
};

/// um per length unit as instruments write it ("m", "µm" in UTF-8 or Latin-1, "nm", ...); nothing
/// when it is no length.
std::optional<double> length_unit_um(std::string_view unit);

/// True when the content is a Gwyddion simple field.
bool is_gsf(std::string_view content);

/// Parsers; `file` is for messages. InputError with the place of what is wrong.
RawMap parse_gsf(std::string_view content, const std::string& file);
RawMap parse_text_map(std::string_view content, const std::string& file);

/// A number that is the whole of `text`, or nothing.
std::optional<double> whole_number(std::string_view text);

std::string_view trimmed(std::string_view text);

}  // namespace scintray
