#include "scintray/core/file_lock.hpp"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <utility>

#include "scintray/core/error.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;

TEST_CASE("a lock is held by one, and its file is gone when it is released") {
  const auto file = test::scratch_folder("file_lock") / "x.lock";
  {
    std::optional<FileLock> first = FileLock::try_take(file);
    REQUIRE(first.has_value());
    CHECK_FALSE(FileLock::try_take(file).has_value());
    const FileLock moved = *std::move(first);
    first.reset();
    CHECK_FALSE(FileLock::try_take(file).has_value());
  }
  CHECK_FALSE(std::filesystem::exists(file));
  CHECK(FileLock::try_take(file).has_value());
}

TEST_CASE("a lock ends with its process, even when that is killed") {
  const auto file = test::scratch_folder("file_lock_killed") / "x.lock";
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const auto held = FileLock::try_take(file);
    std::raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  CHECK(std::filesystem::exists(file));
  CHECK(FileLock::try_take(file).has_value());
}

TEST_CASE("a lock where no file can be made is an error of the system") {
  const auto nowhere = test::scratch_folder("file_lock_nowhere") / "none" / "x.lock";
  CHECK_THROWS_AS(static_cast<void>(FileLock::try_take(nowhere)), SystemError);
}
