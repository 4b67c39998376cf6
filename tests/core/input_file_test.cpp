#include "scintray/core/input_file.hpp"

#include <doctest/doctest.h>

#include "scintray/core/output_file.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;

TEST_CASE("A file is read as it is, byte for byte") {
  const auto folder = test::scratch_folder("input_file");
  std::string content("\xEF\xBB\xBF\0line\r\n\xFF", 12);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{12}, std::size_t{1} << 16, std::size_t{200'001}}) {
    CAPTURE(size);
    std::string written;
    while (written.size() < size) written += content;
    written.resize(size);
    write_whole_file(folder / "file", written);
    const auto read = read_whole_file(folder / "file");
    REQUIRE(read);
    CHECK(*read == written);
  }
}

TEST_CASE("A file whose size is not known beforehand is read whole") {
  const auto status = read_whole_file("/proc/self/status");
  REQUIRE(status);
  CHECK(status->find("Name:") == 0);
}

TEST_CASE("The beginning of a file is as long as requested, or the file") {
  const auto folder = test::scratch_folder("input_file_beginning");
  const std::string written(200'001, 'x');
  write_whole_file(folder / "file", written);
  for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{1} << 16, std::size_t{65'537},
                                 std::size_t{200'001}, std::size_t{300'000}}) {
    CAPTURE(most);
    CHECK(read_beginning(folder / "file", most) == written.substr(0, most));
  }
  InputRecord record;
  CHECK(read_beginning(folder / "file", 8).has_value());
  CHECK(record.files().empty());
}

TEST_CASE("A file that cannot be read is returned as nothing") {
  const auto folder = test::scratch_folder("input_file_none");
  CHECK_FALSE(read_beginning(folder / "missing", 8));
  CHECK_FALSE(read_beginning(folder, 8));
  CHECK_FALSE(read_whole_file(folder / "missing"));
  CHECK_FALSE(read_whole_file(folder));
}
