#pragma once
/// The height map formats that ScintRay reads itself.

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "scintray/topography/detail/readers/raw_map.hpp"

namespace scintray::topography {

/// One file format.
struct Format {
  const char* name;  ///< for messages: "Gwyddion (.gwy)"
  bool (*recognises)(std::string_view content);
  RawMap (*parse)(std::string_view content, const ReadRequest& request);
};

/// All formats, those with a distinctive magic number first.
std::span<const Format> formats();

/// The format of a file's content; empty when unknown.
const Format* find_format(std::string_view content);

/// Names of all formats: "Gwyddion (.gwy), ..., numbers as text".
std::string format_names();

/// One pair per format; parsers throw InputError with the place of the error, and allocate no more than a
/// small multiple of the size of the content.
bool is_gsf(std::string_view content);
RawMap parse_gsf(std::string_view content, const ReadRequest& request);
bool is_gwy(std::string_view content);
RawMap parse_gwy(std::string_view content, const ReadRequest& request);
bool is_ibw(std::string_view content);
RawMap parse_ibw(std::string_view content, const ReadRequest& request);
bool is_nanoscope(std::string_view content);
RawMap parse_nanoscope(std::string_view content, const ReadRequest& request);
bool is_picoview(std::string_view content);
RawMap parse_picoview(std::string_view content, const ReadRequest& request);
bool is_sdf(std::string_view content);
RawMap parse_sdf(std::string_view content, const ReadRequest& request);
bool is_x3p(std::string_view content);
RawMap parse_x3p(std::string_view content, const ReadRequest& request);
bool is_profiler_matrix(std::string_view content);
RawMap parse_profiler_matrix(std::string_view content, const ReadRequest& request);
bool is_number_text(std::string_view content);
RawMap parse_number_text(std::string_view content, const ReadRequest& request);

/// Map of a .gwy that Gwyddion converted from another file: its masks mark points without a height.
RawMap parse_converted_gwy(std::string_view content, const ReadRequest& request);

/// Unpacked gzip data. InputError when damaged, when more than one file is inside, or when the
/// size that the trailer declares, or what comes out, is more than most_unpacked or than `most` bytes.
std::string gunzip(std::string_view packed, const std::string& file, std::size_t most);

/// Result of running the program.
enum class GwyddionAnswer {
  converted,
  not_installed,  ///< no `gwyddion` on PATH
  refused,        ///< it does not read the format either, or the file is damaged
  timed_out,
};

struct GwyddionResult {
  GwyddionAnswer answer = GwyddionAnswer::not_installed;
  std::optional<RawMap> map;
};

/// Runs `gwyddion --convert-to-gwy` on the file, into a folder of its own, and reads the result. The program
/// is started without a shell, a display or input, and is killed after the time limit. InputError from
/// reading its output (for example a channel that does not exist).
GwyddionResult query_gwyddion(const std::filesystem::path& path, const ReadRequest& request,
                              std::chrono::milliseconds time_limit = std::chrono::minutes(1));

}  // namespace scintray::topography
