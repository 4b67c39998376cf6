/// One entry as a libFuzzer target. SCINTRAY_FUZZ_ENTRY is its name.

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "corpus.hpp"
#include "curve_entries.hpp"
#include "detector_entries.hpp"
#include "entries.hpp"
#include "geometry_entries.hpp"

namespace {

const scintray::fuzz::Entry& entry() {
  for (const auto& entries : {scintray::fuzz::entries(), scintray::fuzz::geometry_entries(),
                              scintray::fuzz::detector_entries(), scintray::fuzz::curve_entries()})
    for (const scintray::fuzz::Entry& candidate : entries)
      if (std::strcmp(candidate.name, SCINTRAY_FUZZ_ENTRY) == 0) return candidate;
  std::abort();
}

}  // namespace

/// Writes the seeds into the first folder named on the command line, where libFuzzer begins.
extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  for (int k = 1; k < *count; ++k) {
    if ((*words)[k][0] == '-' || !std::filesystem::is_directory((*words)[k])) continue;
    int number = 0;
    for (const std::string& seed : scintray::fuzz::all_seeds(entry()))
      std::ofstream(std::filesystem::path((*words)[k]) / ("seed-" + std::to_string(++number)),
                    std::ios::binary)
          << seed;
    break;
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  entry().run(data, size);
  return 0;
}
