/// Every reader against files damaged at random, from a fixed seed.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <new>

#include "entries.hpp"
#include "mutate.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::fuzz;

// Memory is watched through the global operator new; the sanitizers bring their own.
#if !defined(__SANITIZE_ADDRESS__)
namespace {
std::size_t largest_request = 0;
}

void* operator new(std::size_t size) {
  largest_request = std::max(largest_request, size);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#else
namespace {
std::size_t largest_request = 0;
}
#endif

namespace {

/// Room for what does not grow with the file: the maps of units, a chunk of the unpacker.
constexpr std::size_t kAlwaysAllowed = std::size_t{1} << 20;

/// True when all was read.
bool run(const Entry& entry, const std::string& content) {
  largest_request = 0;
  bool read = false;
  std::string escaped;
  try {
    read = entry.run(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
  } catch (const std::exception& error) {
    escaped = error.what();
  }
  // Once a case has failed there is no use in saying so a thousand times.
  if (!escaped.empty()) FAIL(entry.name << ": " << escaped);
  if (largest_request > entry.bytes_per_byte * content.size() + kAlwaysAllowed)
    FAIL(entry.name << ": " << largest_request << " bytes asked for, with an input of " << content.size());
  return read;
}

}  // namespace

TEST_CASE("the seeds are sound: every one is read by its own format") {
  for (const Entry& entry : entries()) {
    CAPTURE(entry.name);
    for (const std::string& seed : entry.seeds()) CHECK(run(entry, seed));
  }
}

TEST_CASE("no reader lets anything but an input error escape, or asks for more than the file can fill") {
  constexpr int kTrials = 10000;
  std::uint64_t stream = 0;
  for (const Entry& entry : entries()) {
    CAPTURE(entry.name);
    const std::vector<std::string> seeds = entry.seeds();
    Rng rng(20261121, StreamKind::other, ++stream);
    int read = 0;
    for (int trial = 0; trial < kTrials; ++trial)
      read += run(entry, mutated(seeds[static_cast<std::size_t>(trial) % seeds.size()], seeds, rng)) ? 1 : 0;
    // Damage that is always, or never, noticed would leave one of the two outcomes untried.
    CHECK(read > kTrials / 1000);
    CHECK(read < kTrials - kTrials / 1000);
  }
}

TEST_CASE("every file cut short after any byte ends in a map or an input error") {
  for (const Entry& entry : entries())
    for (const std::string& seed : entry.seeds())
      for (std::size_t size = 0; size<seed.size(); size += seed.size()> 2000 ? 7 : 1)
        run(entry, seed.substr(0, size));
}

TEST_CASE("published files damaged at random end in a map or an input error") {
  const Entry& any = entries().back();
  std::uint64_t stream = 0;
  for (const char* name : {"di-3.di", "mi-1.mi", "P0089OP0027.ibw", "10x10-one_channel_without_name.ibw",
                           "gwyfile-test.gwy", "chip.gwy", "sdf-1.sdf", "sample-land.x3p", "xyz-1.txt"}) {
    const auto path = test::shared_file(std::string("data/topography/") + name);
    if (!path) return;
    std::ifstream file(*path, std::ios::binary);
    const std::vector<std::string> seed{std::string((std::istreambuf_iterator<char>(file)), {})};
    Rng rng(20261122, StreamKind::other, ++stream);
    CAPTURE(name);
    CHECK(run(any, seed.front()));
    for (int trial = 0; trial < 20; ++trial) run(any, mutated(seed.front(), seed, rng));
  }
}
