/// fuzz_driver [TARGET [N [SEED [FIRST]]]]: N damaged files at the reader TARGET, by number (from FIRST on,
/// 0 if not stated) from SEED; without arguments the names of all readers. Every 50,000 are stated, so that
/// what ends early can go on from there. They are read by child processes, with 10 s for each and 1 GB for
/// all that one holds. Where a reader has a process of its own for a library that may crash, it does that
/// work in place here, as this process is such a one; a file that ends it is given to the reader as users
/// have it. What ends that, too, is written to the file fuzz-TARGET-SEED-NUMBER. Exit code 1 if there was
/// any.

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
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
#include <stdexcept>
#include <string>
#include <vector>

#include "corpus.hpp"
#include "curve_entries.hpp"
#include "detector_entries.hpp"
#include "entries.hpp"
#include "geometry_entries.hpp"
#include "mutate.hpp"
#include "own_entries.hpp"
#include "scintray/core/child_process.hpp"
#include "scintray/core/rng.hpp"

namespace {

using namespace scintray;
using namespace scintray::fuzz;

constexpr unsigned kSeconds = 10, kMostWaiting_s = 300;
constexpr rlim_t kBytes = rlim_t{1} << 30;
constexpr std::uint64_t kPerChild = 2000, kPerStatement = 50'000;

std::vector<Entry> all_entries() {
  std::vector<Entry> all;
  for (const auto& list : {entries(), geometry_entries(), detector_entries(), curve_entries(), own_entries()})
    all.insert(all.end(), list.begin(), list.end());
  return all;
}

/// The file of a number: it depends on nothing else.
std::string input(const std::vector<std::string>& seeds, std::uint64_t seed, std::uint64_t number) {
  core::Rng rng(seed, core::StreamKind::other, number);
  return mutated(seeds[number % seeds.size()], seeds, rng);
}

/// Reads the files from `at` to `last`; `at` states to the parent which is being read.
[[noreturn]] void read_all(const Entry& entry, const std::vector<std::string>& seeds, std::uint64_t seed,
                           std::uint64_t last, std::atomic<std::uint64_t>& at) {
  const rlimit limit{kBytes, kBytes};
  setrlimit(RLIMIT_DATA, &limit);
  for (; at < last; ++at) {
    const std::string content = input(seeds, seed, at);
    // Of the processor, so that other work on the machine does not count; a reader that waits has more.
    const itimerval time{{0, 0}, {kSeconds, 0}};
    setitimer(ITIMER_PROF, &time, nullptr);
    alarm(kMostWaiting_s);
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

enum class OwnProcesses { as_users_have_them, in_place };

class Fuzzer {
 public:
  Fuzzer(const Entry& entry, std::uint64_t seed)
      : entry_(entry),
        seed_(seed),
        seeds_(all_seeds(entry)),
        at_(*new (shared()) std::atomic<std::uint64_t>(0)) {}

  /// Exit code of the program.
  int run(std::uint64_t first, std::uint64_t count) {
    const std::uint64_t end = first + count;
    at_ = first;
    for (std::uint64_t stated = first + kPerStatement; at_ < end;) {
      if (at_ >= stated) {
        std::fprintf(stderr, "%s: %llu to %llu read, %d found\n", entry_.name, number_of(first),
                     number_of(at_), found_);
        stated += kPerStatement;
      }
      const std::uint64_t last = std::min<std::uint64_t>(end, at_ + kPerChild);
      if (ends_well(last, OwnProcesses::in_place)) continue;
      const std::uint64_t number = at_;
      if (ends_well(number + 1, OwnProcesses::as_users_have_them))
        ++withstood_;
      else
        keep(number);
      at_ = number + 1;
    }
    std::printf(
        "%-20s %10llu inputs from %llu on of seed %llu, %llu ended a process of the reader's own, %d found\n",
        entry_.name, number_of(count), number_of(first), number_of(seed_), number_of(withstood_), found_);
    return found_ > 0 ? 1 : 0;
  }

 private:
  static unsigned long long number_of(std::uint64_t number) { return number; }

  static void* shared() {
    void* memory = mmap(nullptr, sizeof(std::atomic<std::uint64_t>), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return memory;
  }

  bool ends_well(std::uint64_t last, OwnProcesses processes) {
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot make a process");
    if (child == 0) {
      if (processes == OwnProcesses::in_place) core::work_in_place();
      read_all(entry_, seeds_, seed_, last, at_);
    }
    waitpid(child, &status_, 0);
    return status_ == 0;
  }

  void keep(std::uint64_t number) {
    ++found_;
    const std::string name =
        std::string("fuzz-") + entry_.name + "-" + std::to_string(seed_) + "-" + std::to_string(number);
    std::ofstream(name, std::ios::binary) << input(seeds_, seed_, number);
    const int signal = WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
    std::printf("%s: %s (%s)\n", name.c_str(),
                signal == SIGPROF || signal == SIGALRM ? "took over 10 s"
                : signal                               ? strsignal(signal)
                                                       : "no input error",
                entry_.name);
    std::fflush(stdout);
  }

  const Entry& entry_;
  std::uint64_t seed_;
  std::vector<std::string> seeds_;
  std::atomic<std::uint64_t>& at_;
  int status_ = 0, found_ = 0;
  std::uint64_t withstood_ = 0;
};

}  // namespace

int main(int count, char** words) {
  for (const Entry& entry : all_entries()) {
    if (count < 2)
      std::puts(entry.name);
    else if (std::strcmp(entry.name, words[1]) == 0)
      return Fuzzer(entry, count > 3 ? std::strtoull(words[3], nullptr, 10) : 1)
          .run(count > 4 ? std::strtoull(words[4], nullptr, 10) : 0,
               count > 2 ? std::strtoull(words[2], nullptr, 10) : 10'000);
  }
  return count < 2 ? 0 : 2;
}
