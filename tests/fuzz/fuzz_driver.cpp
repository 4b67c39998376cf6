/// fuzz_driver [TARGET [N [SEED]]]: N damaged files at the reader TARGET, by number from SEED; without
/// arguments the names of all readers. They are read by child processes, with 10 s for each and 1 GB for all
/// that one holds. What ends a child is written to the file fuzz-TARGET-SEED-NUMBER. Exit code 1 if there was
/// any.

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include "entries.hpp"
#include "geometry_entries.hpp"
#include "mutate.hpp"
#include "own_entries.hpp"
#include "scintray/core/philox.hpp"

namespace {

using namespace scintray;
using namespace scintray::fuzz;

constexpr unsigned kSeconds = 10;
constexpr rlim_t kBytes = rlim_t{1} << 30;
constexpr std::uint64_t kPerChild = 2000;

std::vector<Entry> all_entries() {
  std::vector<Entry> all;
  for (const auto& list : {entries(), geometry_entries(), own_entries()})
    all.insert(all.end(), list.begin(), list.end());
  return all;
}

/// The file of a number: it depends on nothing else.
std::string input(const std::vector<std::string>& seeds, std::uint64_t seed, std::uint64_t number) {
  core::Rng rng(seed, core::StreamKind::other, number);
  return mutated(seeds[number % seeds.size()], seeds, rng);
}

/// Reads the files from `first` to `last` and states in `at` which is being read.
[[noreturn]] void read_all(const Entry& entry, const std::vector<std::string>& seeds, std::uint64_t seed,
                           std::uint64_t last, std::atomic<std::uint64_t>& at) {
  const rlimit limit{kBytes, kBytes};
  setrlimit(RLIMIT_DATA, &limit);
  for (; at < last; ++at) {
    const std::string content = input(seeds, seed, at);
    alarm(kSeconds);
    try {
      entry.run(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", entry.name, error.what());
      std::fflush(stdout);
      _exit(1);
    }
  }
  _exit(0);
}

int fuzz_reader(const Entry& entry, std::uint64_t count, std::uint64_t seed) {
  const std::vector<std::string> seeds = entry.seeds();
  void* shared = mmap(nullptr, sizeof(std::atomic<std::uint64_t>), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return 2;
  std::atomic<std::uint64_t>& at = *new (shared) std::atomic<std::uint64_t>(0);
  int found = 0;
  while (at < count) {
    const std::uint64_t last = std::min<std::uint64_t>(count, at + kPerChild);
    const pid_t child = fork();
    if (child < 0) return 2;
    if (child == 0) read_all(entry, seeds, seed, last, at);
    int status = 0;
    waitpid(child, &status, 0);
    if (status == 0) continue;
    ++found;
    const std::uint64_t number = at;
    const std::string name =
        std::string("fuzz-") + entry.name + "-" + std::to_string(seed) + "-" + std::to_string(number);
    std::ofstream(name, std::ios::binary) << input(seeds, seed, number);
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    std::printf("%s: %s (%s)\n", name.c_str(),
                signal == SIGALRM ? "took over 10 s"
                : signal          ? strsignal(signal)
                                  : "no input error",
                entry.name);
    at = number + 1;
  }
  std::printf("%-20s %10llu inputs from seed %llu, %d found\n", entry.name,
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(seed), found);
  return found > 0 ? 1 : 0;
}

}  // namespace

int main(int count, char** words) {
  for (const Entry& entry : all_entries()) {
    if (count < 2)
      std::puts(entry.name);
    else if (std::strcmp(entry.name, words[1]) == 0)
      return fuzz_reader(entry, count > 2 ? std::strtoull(words[2], nullptr, 10) : 10'000,
                         count > 3 ? std::strtoull(words[3], nullptr, 10) : 1);
  }
  return count < 2 ? 0 : 2;
}
