#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <filesystem>

#include "child_program.hpp"
#include "profile.hpp"
#include "scintray/core/error.hpp"

namespace scintray::bench {

namespace {

/// Difference of the addresses in memory and in the program's file.
std::uintptr_t load_address() {
  std::uintptr_t address = 0;
  // The program comes first.
  const auto first = [](dl_phdr_info* info, std::size_t, void* result) {
    *static_cast<std::uintptr_t*>(result) = info->dlpi_addr;
    return 1;
  };
  ::dl_iterate_phdr(first, &address);
  return address;
}

/// The library of an address; empty for the program itself.
std::string library_of(std::uintptr_t address) {
  static const int in_program = 0;
  Dl_info here{}, there{};
  if (::dladdr(reinterpret_cast<const void*>(address), &there) == 0) return "unknown";
  if (::dladdr(&in_program, &here) != 0 && here.dli_fbase == there.dli_fbase) return {};
  return std::filesystem::path(there.dli_fname).filename().string();
}

/// "file.cpp:12 (discriminator 3)" as "file.cpp"; empty for "??:0".
std::string file_of_line(const std::string& line) {
  const std::string file = line.substr(0, line.rfind(':'));
  return file.starts_with("??") ? "" : file;
}

/// Reads addr2line's output: an address, then two lines a frame, the function and its file and line.
void read_frames(ChildProgram& addr2line, std::uintptr_t load, std::map<std::uintptr_t, CodePlace>& places) {
  CodePlace* place = nullptr;
  while (const auto line = addr2line.read_line()) {
    if (line->starts_with("0x")) {
      place = &places[std::stoull(*line, nullptr, 16) + load];
    } else if (place) {
      const auto where = addr2line.read_line();
      if (where) place->frames.push_back({*line, file_of_line(*where)});
    }
  }
}

}  // namespace

std::map<std::uintptr_t, CodePlace> find_code(const std::vector<std::uintptr_t>& addresses) {
  std::map<std::uintptr_t, CodePlace> places;
  for (const std::uintptr_t address : addresses)
    if (!places.contains(address)) places[address].library = library_of(address);

  const std::uintptr_t load = load_address();
  std::vector<std::string> arguments{
      "addr2line", "-e", std::filesystem::read_symlink("/proc/self/exe"), "-a", "-f", "-i", "-C"};
  const std::size_t options = arguments.size();
  for (const auto& [address, place] : places)
    if (place.library.empty()) arguments.push_back(fmt::format("{:#x}", address - load));
  if (arguments.size() == options) return places;
  try {
    ChildProgram addr2line(arguments);
    read_frames(addr2line, load, places);
  } catch (const core::SystemError&) {
    // No addr2line: no frames.
  }
  return places;
}

WorkShares attribute(const std::vector<std::uintptr_t>& samples,
                     const std::map<std::uintptr_t, CodePlace>& places) {
  WorkShares result;
  for (const std::uintptr_t sample : samples) {
    const auto found = places.find(sample);
    if (found == places.end()) continue;
    const CodePlace& place = found->second;
    const WorkKind kind = place.library.empty() ? kind_of_code(place.frames) : kind_of_library(place.library);
    result.shares[static_cast<std::size_t>(kind)] += 1.0;
    ++result.samples;
    const auto has_line = [](const CodeFrame& frame) { return !frame.file.empty(); };
    result.lines = result.lines || std::any_of(place.frames.begin(), place.frames.end(), has_line);
  }
  if (result.samples > 0)
    for (double& share : result.shares) share /= static_cast<double>(result.samples);
  return result;
}

}  // namespace scintray::bench
