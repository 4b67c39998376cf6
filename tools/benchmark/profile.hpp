#pragma once
/// Share of the processor time by kind of work, from samples of the program counter.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "work_kind.hpp"

namespace scintray::bench {

/// Samples of the program counter of the calling thread while `work` runs, one every millisecond and a little
/// (997 us, which is no multiple of a tick). A signal stops the thread for about a microsecond per sample, so
/// nothing is timed in the same run. Empty where the program counter cannot be read (not x86-64 or aarch64).
/// At most 100,000 are kept. Not to be used by two threads at once.
std::vector<std::uintptr_t> sample_program_counter(const std::function<void()>& work);

/// Where an address of this program lies.
struct CodePlace {
  std::string library;            ///< "libm.so.6"; empty: the program itself
  std::vector<CodeFrame> frames;  ///< in the program: the functions inlined there, innermost first
};

/// Places of addresses. Those in the program are resolved by addr2line (GNU binutils); without it they have
/// no frames.
std::map<std::uintptr_t, CodePlace> find_code(const std::vector<std::uintptr_t>& addresses);

/// Share of the samples by kind of work.
struct WorkShares {
  std::size_t samples = 0;
  bool lines = false;  ///< attributed by source line, inlined functions included; else by whole functions
  std::array<double, kWorkKindCount> shares{};  ///< by WorkKind, 0 to 1, sum 1 with samples
};

/// Shares of samples at the places found for them.
WorkShares attribute(const std::vector<std::uintptr_t>& samples,
                     const std::map<std::uintptr_t, CodePlace>& places);

}  // namespace scintray::bench
