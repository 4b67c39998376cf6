#pragma once
/// Other formats, through the program gwyddion where it is installed. Internal to the readers.

#include <chrono>
#include <filesystem>
#include <optional>

#include "scintray/topography/detail/readers/raw_map.hpp"

namespace scintray::topography {

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
GwyddionResult ask_gwyddion(const std::filesystem::path& path, const ReadRequest& request,
                            std::chrono::milliseconds time_limit = std::chrono::minutes(1));

}  // namespace scintray::topography
