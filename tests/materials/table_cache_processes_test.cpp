/// The table cache as several processes use it at once.

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "materials/small_tables.hpp"
#include "support/shared.hpp"
#include "support/table_digest.hpp"

using namespace scintray;
using namespace scintray::materials;
using namespace scintray::optics;
using namespace scintray::test;

namespace {

/// Runs `work` in `number` processes; true when all of them returned true.
bool in_processes(int number, const std::function<bool()>& work) {
  std::vector<pid_t> children;
  for (int k = 0; k < number; ++k) {
    children.push_back(fork());
    REQUIRE(children.back() >= 0);
    if (children.back() == 0) _exit(work() ? 0 : 1);
  }
  bool good = true;
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    good = good && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  return good;
}

}  // namespace

TEST_CASE("of processes that need one table, one builds it and the others wait for it") {
  const Path folder = test::scratch_folder("cache_processes");
  write(folder / "builds", "");
  const std::string digest = content_digest(small_table());
  const SurfaceTable table = small_table();
  const auto work = [&] {
    TableHooks hooks;
    hooks.cache = folder / "cache";
    hooks.cache_bytes = kDefaultCacheBytes;
    TableCache cache(hooks);
    const auto got = cache.get({"a", "ground", ""}, [&] {
      std::ofstream(folder / "builds", std::ios::app) << "x";
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      return table;
    });
    return content_digest(*got) == digest;
  };
  CHECK(in_processes(6, work));
  CHECK(content_of(folder / "builds") == "x");
  CHECK(entries(folder / "cache") == 1);
}

TEST_CASE("processes that read, build and remove at once always get whole tables") {
  const Path folder = test::scratch_folder("cache_turmoil");
  const SurfaceTable table = small_table();
  const std::string digest = content_digest(table);
  Cache first(folder);
  first.get("0");
  const std::uint64_t one = std::filesystem::file_size(CacheFolder(folder).file_of("0"));
  const auto work = [&] {
    Cache cache(folder, 3 * one);
    TableCache kept(cache.hooks);
    bool good = true;
    for (int k = 0; k < 60; ++k) {
      const std::string key = std::to_string((k * k + getpid()) % 7);
      good = good && content_digest(*kept.get({key, "", ""}, [&] { return table; })) == digest;
    }
    return good && cache.warnings.empty();
  };
  CHECK(in_processes(4, work));
}

TEST_CASE("a full disk is said, and stops nothing") {
  const Path folder = scratch_folder("cache_full");
  const SurfaceTable table = small_table();
  const auto work = [&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    setrlimit(RLIMIT_FSIZE, &limit);
    Cache cache(folder);
    TableCache kept(cache.hooks);
    const auto got = kept.get({"a", "ground", ""}, [&] { return table; });
    return content_digest(*got) == content_digest(table) && cache.warnings.size() == 1;
  };
  CHECK(in_processes(1, work));
  CHECK(entries(folder) == 0);
}

TEST_CASE("a process that was killed while it built a table is in nobody's way") {
  const Path folder = test::scratch_folder("cache_killed");
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    TableHooks hooks;
    hooks.cache = folder;
    hooks.cache_bytes = kDefaultCacheBytes;
    TableCache(hooks).get({"a", "", ""}, []() -> SurfaceTable {
      std::raise(SIGKILL);
      return {};
    });
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  CHECK(entries(folder) == 1);  // its lock
  Path unfinished = CacheFolder(folder).file_of("a");
  unfinished.replace_filename("." + unfinished.filename().string() + ".12345.unfinished");
  write(unfinished, "half a table");
  write(folder / ("." + unfinished.filename().string() + ".12345.unfinished"), "a quarter");
  Cache cache(folder);
  cache.get("a");
  CHECK(cache.built == 1);
  CHECK(entries(folder) == 3);  // whoever holds the lock may be writing it
  cache.get("b");
  CHECK(entries(folder) == 2);  // the two tables
}
