#pragma once
/// The height map formats that ScintRay reads itself. Internal to the readers.

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

/// All formats, the ones with a clear mark first.
std::span<const Format> formats();

/// The format of a file's content, or nothing.
const Format* find_format(std::string_view content);

/// "Gwyddion (.gwy), ..., numbers as text".
std::string format_names();

/// One pair per format; parsers throw InputError with the place of what is wrong, and allocate no
/// more than a small multiple of what the content holds.
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

/// A .gwy that Gwyddion made of another file: its masks mark what the file had no height for.
RawMap parse_converted_gwy(std::string_view content, const ReadRequest& request);

/// Unpacks gzip data. InputError when damaged, when more than one file is inside, or when the
/// size that the trailer declares, or what comes out, is more than most_unpacked or than `most` bytes.
std::string gunzip(std::string_view packed, const std::string& file, std::size_t most);

/// What came of asking the program.
enum class GwyddionAnswer {
  converted,
  not_installed,  ///< no `gwyddion` on PATH
  refused,        ///< it does not know the format either, or the file is damaged
  timed_out,
};

struct GwyddionResult {
  GwyddionAnswer answer = GwyddionAnswer::not_installed;
  std::optional<RawMap> map;
};

/// Lets `gwyddion --convert-to-gwy` convert the file into a folder of its own and reads what came
/// out. The program is started without a shell, a display or input, and is ended when the time is over.
/// InputError from reading what it wrote (a channel that is not there, for one).
GwyddionResult query_gwyddion(const std::filesystem::path& path, const ReadRequest& request,
                              std::chrono::milliseconds time_limit = std::chrono::minutes(1));

}  // namespace scintray::topography
