#include "scintray/core/h5.hpp"

#include <dlfcn.h>
#include <doctest/doctest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <limits>
#include <numeric>

#include "scintray/core/error.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;

// A disk that fills up, for the child processes of the test below: taking more disk space than
// allowed fails, and so does every write to where no space was taken before.
namespace {

long allowance_bytes = -1;  ///< -1: no limit
off_t taken_bytes = 0;

bool limited(int descriptor) {
  struct stat status {};
  return allowance_bytes >= 0 && ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
         status.st_nlink > 0;  // not pipes, not unlinked memory files
}

}  // namespace

extern "C" int fallocate(int descriptor, int mode, off_t offset, off_t length) {
  using Function = int (*)(int, int, off_t, off_t);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "fallocate"));
  if (limited(descriptor) && offset + length > allowance_bytes) {
    errno = ENOSPC;
    return -1;
  }
  taken_bytes = std::max(taken_bytes, offset + length);
  return real(descriptor, mode, offset, length);
}

extern "C" ssize_t pwrite(int descriptor, const void* buffer, size_t count, off_t offset) {
  using Function = ssize_t (*)(int, const void*, size_t, off_t);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "pwrite"));
  if (limited(descriptor) && offset + static_cast<off_t>(count) > taken_bytes) {
    ::dprintf(STDERR_FILENO, "a write where no space was taken\n");
    errno = ENOSPC;
    return -1;
  }
  return real(descriptor, buffer, count, offset);
}

namespace {

template <typename Exception, typename Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Exception& error) {
    return error.what();
  }
  return "";
}

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

template <typename T>
void check_round_trip(h5::Group group, const std::string& name) {
  const std::vector<T> values{std::numeric_limits<T>::lowest(), T(0), T(1), std::numeric_limits<T>::max()};
  group.write(name, values);
  CHECK(group.read<T>(name) == values);
}

}  // namespace

TEST_CASE("Every value type survives a file bit for bit") {
  const auto path = test::scratch_folder("h5_types") / "types.h5";
  auto file = h5::File::create(path);
  auto root = file.root();
  check_round_trip<double>(root, "f64");
  check_round_trip<float>(root, "f32");
  check_round_trip<std::int32_t>(root, "i32");
  check_round_trip<std::uint32_t>(root, "u32");
  check_round_trip<std::int64_t>(root, "i64");
  check_round_trip<std::uint64_t>(root, "u64");
  check_round_trip<std::uint8_t>(root, "u8");
  std::vector<double> cube(30 * 40 * 50);
  std::iota(cube.begin(), cube.end(), 0.5);
  root.write("cube", cube, {30, 40, 50});
  root.write("scalar", std::vector<double>{3.25}, {});
  root.write("empty", std::vector<double>{});
  root.write_strings("text", {"µm", "", "<b>&"});
  root.write_strings("no_text", {});
  root.set_attribute("", "title", std::string("rough ≠ polished"));
  root.set_attribute("cube", "unit", std::string("mm"));
  root.set_attribute("cube", "step", 0.1);
  root.set_attribute("cube", "version", std::int64_t{1} << 60);
  root.set_attribute("cube", "version", std::int64_t{-7});
  file.commit();

  const auto orphan = h5::File::open(path).root();
  CHECK_THROWS_AS(orphan.members(), InternalError);  // its File is gone
  const auto again = h5::File::open(path);
  const auto group = again.root();
  h5::Shape shape;
  CHECK(group.read<double>("cube", &shape) == cube);
  CHECK(shape == h5::Shape{30, 40, 50});
  CHECK(group.read<double>("scalar", &shape) == std::vector<double>{3.25});
  CHECK(shape.empty());
  CHECK(group.read<double>("empty").empty());
  CHECK(group.read_strings("text") == std::vector<std::string>{"µm", "", "<b>&"});
  CHECK(group.read_strings("no_text").empty());
  CHECK(group.string_attribute("", "title") == "rough ≠ polished");
  CHECK(group.double_attribute("cube", "step") == 0.1);
  CHECK(group.integer_attribute("cube", "version") == -7);
  CHECK(group.has_attribute("cube", "unit"));
  CHECK_FALSE(group.has_attribute("cube", "colour"));
  CHECK(group.members() == std::vector<std::string>{"f64", "f32", "i32", "u32", "i64", "u64", "u8", "cube",
                                                    "scalar", "empty", "text", "no_text"});
}

TEST_CASE("Groups nest and list their members in the order of creation") {
  const auto path = test::scratch_folder("h5_groups") / "groups.h5";
  {
    auto file = h5::File::create(path);
    auto points = file.root().create_group("points");
    for (const char* name : {"0001", "0000", "z", "a"})
      points.create_group(name).write("n", std::vector<std::int32_t>{1});
    file.commit();
  }
  const auto file = h5::File::open(path);
  const auto points = file.root().open_group("points");
  CHECK(points.members() == std::vector<std::string>{"0001", "0000", "z", "a"});
  CHECK(points.has("z/n"));
  CHECK_FALSE(points.has("z/m"));
  CHECK_FALSE(points.has("y/n"));
  CHECK(points.open_group("z").read<double>("n") == std::vector<double>{1.0});
}

TEST_CASE("A stream grows, and is read back in parts") {
  const auto path = test::scratch_folder("h5_stream") / "stream.h5";
  {
    auto file = h5::File::create(path);
    auto root = file.root();
    root.create_stream<std::uint64_t>("n", 1000);
    std::uint64_t next = 0;
    for (std::uint64_t block : {1, 999, 0, 1500, 2500}) {
      std::vector<std::uint64_t> values(block);
      std::iota(values.begin(), values.end(), next);
      next += block;
      root.append("n", values);
    }
    file.commit();
  }
  const auto file = h5::File::open(path);
  std::vector<std::uint64_t> expected(5000);
  std::iota(expected.begin(), expected.end(), std::uint64_t{0});
  CHECK(file.root().read<std::uint64_t>("n") == expected);
  CHECK(file.root().shape("n") == h5::Shape{5000});
  CHECK(file.root().read_part<std::uint64_t>("n", 4998, 10) == std::vector<std::uint64_t>{4998, 4999});
  CHECK(file.root().read_part<std::uint64_t>("n", 9000, 10).empty());
}

TEST_CASE("Equal contents make equal files") {
  const auto folder = test::scratch_folder("h5_equal");
  std::vector<std::string> contents;
  for (const char* name : {"a.h5", "b.h5"}) {
    auto file = h5::File::create(folder / name);
    file.root().create_group("g").write("x", std::vector<double>(5000, 0.1));
    file.commit();
    std::ifstream in(folder / name, std::ios::binary);
    contents.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  CHECK(contents[0] == contents[1]);
}

TEST_CASE("What is not committed leaves nothing behind, and the old file stays") {
  const auto folder = test::scratch_folder("h5_uncommitted");
  {
    auto file = h5::File::create(folder / "a.h5");
    file.root().write("x", std::vector<double>{1.0});
    file.flush();
    CHECK_FALSE(std::filesystem::exists(folder / "a.h5"));
  }
  CHECK(files_in(folder) == 0);
  auto first = h5::File::create(folder / "a.h5");
  first.root().write("x", std::vector<double>{1.0});
  first.commit();
  CHECK(files_in(folder) == 1);
  {
    auto second = h5::File::create(folder / "a.h5");
    second.root().write("x", std::vector<double>{2.0});
  }
  CHECK(h5::File::open(folder / "a.h5").path() == folder / "a.h5");
  const auto kept = h5::File::open(folder / "a.h5");
  CHECK(kept.root().read<double>("x") == std::vector<double>{1.0});
}

TEST_CASE("Files that are missing, foreign or cut short are refused with the reason") {
  const auto folder = test::scratch_folder("h5_refused");
  CHECK(contains(message_of<InputError>([&] { h5::File::open(folder / "none.h5"); }),
                 "none.h5: error: there is no"));
  CHECK(contains(message_of<InputError>([&] { h5::File::open(folder); }), "folder"));
  std::ofstream(folder / "text.h5") << "a,b\n1,2\n";
  CHECK(contains(message_of<InputError>([&] { h5::File::open(folder / "text.h5"); }), "not an HDF5 file"));
  {
    auto file = h5::File::create(folder / "cut.h5");
    file.root().write("x", std::vector<double>(100, 1.0));
    file.commit();
  }
  std::filesystem::resize_file(folder / "cut.h5", std::filesystem::file_size(folder / "cut.h5") - 200);
  const auto message = message_of<InputError>([&] { h5::File::open(folder / "cut.h5"); });
  CHECK(contains(message, "cut.h5"));
  CHECK(contains(message, "truncated file"));
}

TEST_CASE("Reading what is missing or of another type is an error that names object and file") {
  const auto path = test::scratch_folder("h5_objects") / "o.h5";
  {
    auto file = h5::File::create(path);
    auto group = file.root().create_group("g");
    group.write("x", std::vector<double>{0.5, 1e300, -1.0});
    group.write_strings("words", {"a"});
    group.set_attribute("x", "unit", std::string("mm"));
    CHECK(contains(message_of<SystemError>([&] { group.create_group("x"); }), "/g/x: name already exists"));
    CHECK_THROWS_AS(group.write("y", std::vector<double>{1.0, 2.0}, {3}), InternalError);
    file.commit();
  }
  const auto file = h5::File::open(path);
  const auto group = file.root().open_group("g");
  const auto missing = message_of<SystemError>([&] { group.read<double>("y"); });
  CHECK(contains(missing, path.string() + ": cannot open dataset /g/y: "));
  CHECK(contains(missing, "doesn't exist"));
  CHECK(contains(message_of<SystemError>([&] { group.read<double>("words"); }), "does not hold numbers"));
  CHECK(contains(message_of<SystemError>([&] { group.read_strings("x"); }), "does not hold text"));
  CHECK(contains(message_of<SystemError>([&] { group.integer_attribute("x", "unit"); }), "not a number"));
  CHECK(contains(message_of<SystemError>([&] { group.string_attribute("x", "name"); }), "\"name\" of /g/x"));
  CHECK_THROWS_AS(group.read<float>("x"), SystemError);          // 1e300 is no float
  CHECK_THROWS_AS(group.read<std::uint32_t>("x"), SystemError);  // nor is 0.5 an integer
}

TEST_CASE("A place that cannot be written fails at once") {
  const auto folder = test::scratch_folder("h5_unwritable");
  CHECK(contains(message_of<SystemError>([&] { h5::File::create(folder / "no" / "a.h5"); }),
                 "there is no folder"));
  CHECK(contains(message_of<SystemError>([&] { h5::File::create(folder); }), "it is a folder"));
  CHECK(contains(message_of<SystemError>([&] { h5::File::create("/proc/a.h5"); }),
                 "/proc/a.h5: cannot write: "));
}

namespace {

struct ChildEnd {
  int status = 0;
  std::string output;
};

/// Runs `write` in a child whose disk is full after `bytes`; SystemError makes exit status 7.
template <typename Write>
ChildEnd run_on_small_disk(long bytes, const Write& write) {
  int channel[2];
  REQUIRE(::pipe(channel) == 0);
  std::fflush(nullptr);  // else the child prints it again
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::dup2(channel[1], STDERR_FILENO);
    ::signal(SIGSEGV, SIG_DFL);  // instead of doctest's
    ::alarm(60);
    int status = 0;
    try {
      allowance_bytes = bytes;
      write();
    } catch (const SystemError& error) {
      ::dprintf(STDERR_FILENO, "SystemError %s\n", error.what());
      status = 7;
    }
    std::exit(status);  // with the exit handlers, where HDF5 closes what is still open
  }
  ::close(channel[1]);
  ChildEnd end;
  char buffer[4096];
  for (ssize_t n = 0; (n = ::read(channel[0], buffer, sizeof buffer)) > 0;)
    end.output.append(buffer, static_cast<std::size_t>(n));
  ::close(channel[0]);
  ::waitpid(child, &end.status, 0);
  return end;
}

}  // namespace

TEST_CASE("A disk that fills at any moment ends with a message, no file, and a clean exit") {
  const auto folder = test::scratch_folder("h5_full");
  const auto write = [&](bool stream) {
    std::vector<std::uint64_t> noise(8192);  // 64 KiB that deflate cannot shrink
    std::uint64_t state = 1;
    auto file = h5::File::create(folder / "full.h5");
    auto root = file.root();
    if (stream) root.create_stream<std::uint64_t>("n", 1024);
    for (const std::string name : {"n0", "n1", "n2", "n3", "n4", "n5", "n6", "n7"}) {
      for (auto& value : noise) value = state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      if (stream) {
        root.append("n", noise);
      } else {
        root.write(name, noise);
        root.set_attribute(name, "unit", std::string("mm"));
      }
    }
    root.write_strings("words", {"a", "b"});
    file.commit();
  };
  for (const bool stream : {false, true}) {
    const auto whole = run_on_small_disk(-1, [&] { write(stream); });
    CAPTURE(whole.output);
    REQUIRE(WIFEXITED(whole.status));
    REQUIRE(WEXITSTATUS(whole.status) == 0);
    const auto size = static_cast<long>(std::filesystem::file_size(folder / "full.h5"));
    std::filesystem::remove(folder / "full.h5");
    int fitted = 0, refused = 0;
    constexpr long kRoomTakenAhead = 4 << 20;
    for (long bytes = 0; bytes < size + kRoomTakenAhead; bytes += size / 20) {
      CAPTURE(stream);
      CAPTURE(bytes);
      const auto end = run_on_small_disk(bytes, [&] { write(stream); });
      CAPTURE(end.output);
      REQUIRE(WIFEXITED(end.status));
      if (WEXITSTATUS(end.status) == 0) {  // it fitted
        CHECK(bytes >= size);
        CHECK(end.output.empty());
        CHECK(static_cast<long>(std::filesystem::file_size(folder / "full.h5")) == size);
        std::filesystem::remove(folder / "full.h5");
        ++fitted;
        continue;
      }
      CHECK(WEXITSTATUS(end.status) == 7);
      CHECK(contains(end.output, "full.h5: cannot "));
      CHECK(contains(end.output, "No space left on device"));
      CHECK(std::count(end.output.begin(), end.output.end(), '\n') == 1);  // nothing from HDF5 itself
      CHECK(files_in(folder) == 0);
      ++refused;
    }
    CHECK(fitted > 0);
    CHECK(refused > 20);
  }
}
