// HDF5 files that are damaged, or that refer to other files.
#include <doctest/doctest.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iostream>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::test;

namespace {

using Path = std::filesystem::path;

std::string bytes_of(const Path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void put_bytes(const Path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

Path small_file(const Path& path) {
  auto file = h5::File::create(path);
  auto root = file.root();
  root.set_attribute("", "format", std::string("made for this test"));
  root.write("numbers", std::vector<double>(20, 0.25));
  root.write("compressed", std::vector<std::uint64_t>(5000, 7), {50, 100});
  root.write_strings("words", {"one", "two", "a longer text", ""});
  root.set_attribute("words", "unit", std::string("1"));
  auto group = root.create_group("group");
  group.write("count", std::vector<std::uint64_t>{3}, {});
  group.create_stream<float>("rows", 16, 3);
  group.append("rows", std::vector<float>(60, 1.5f));
  file.commit();
  return path;
}

/// The bytes of a file as ScintRay 0.1 wrote it, without a seal.
std::string unsealed(const Path& path) {
  const std::string bytes = bytes_of(path);
  return bytes.substr(0, bytes.rfind("\nScintRay seal"));
}

/// What opening a file and reading all of it throws; empty when nothing.
std::string complaint(const Path& path) {
  try {
    const auto file = h5::File::open(path);
    const auto root = file.root();
    for (const std::string& name : root.members()) root.attributes(name);
    if (root.has("numbers")) root.read<double>("numbers");
    if (root.has("compressed")) root.read<std::uint64_t>("compressed");
    if (root.has("words")) root.read_strings("words");
    if (root.has("group")) root.open_group("group").read_part<float>("rows", 0, 100);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

/// An HDF5 file with one dataset or link, by the library itself.
template <typename Fill>
Path foreign(const Path& path, const Fill& fill) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE(file >= 0);
  fill(file);
  H5Fclose(file);
  return path;
}

}  // namespace

TEST_CASE("A committed file ends in a seal, and any changed byte is found") {
  const auto folder = scratch_folder("h5_seal");
  const Path path = small_file(folder / "a.h5");
  CHECK(h5::seal_of(path) == h5::Seal::intact);
  CHECK(complaint(path) == "");
  const std::string bytes = bytes_of(path);
  const std::size_t content = unsealed(path).size();
  std::size_t refused = 0, tried = 0;
  for (std::size_t at = 0; at < content; at += 97) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    put_bytes(path, changed);
    CHECK(h5::seal_of(path) == h5::Seal::broken);
    refused += contains(complaint(path), "a.h5") ? 1 : 0;
    ++tried;
  }
  CHECK(refused == tried);
  CHECK(h5::seal_of(folder / "none.h5") == h5::Seal::none);
}

TEST_CASE("A file without a seal, as ScintRay 0.1 and other programs write it, opens") {
  const Path path = small_file(scratch_folder("h5_unsealed") / "a.h5");
  put_bytes(path, unsealed(path));
  CHECK(h5::seal_of(path) == h5::Seal::none);
  CHECK(complaint(path) == "");
}

TEST_CASE("A file without a seal and with flipped bits is read or refused, never more") {
  const Path path = small_file(scratch_folder("h5_flips") / "a.h5");
  const std::string bytes = unsealed(path);
  std::size_t refused = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 41) {
    CAPTURE(at);
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ (1 << (at % 8)));
    put_bytes(path, changed);
    refused += complaint(path).empty() ? 0 : 1;
  }
  CHECK(refused > 10);
}

TEST_CASE("Texts whose heap HDF5 would walk through for ever are refused without waiting for it") {
  const auto folder = scratch_folder("h5_heap");
  const std::string sound = unsealed(small_file(folder / "sound.h5"));
  const std::size_t heap = sound.find("GCOL");
  REQUIRE(heap != std::string::npos);
  const std::size_t first = heap + 16;  // its first object: index, references, length at the 8th byte
  struct Harm {
    std::uint16_t index;
    std::uint64_t length;
  };
  for (const Harm& harm : {Harm{0, 0}, Harm{1, ~std::uint64_t{15}}, Harm{1, ~std::uint64_t{0}}}) {
    CAPTURE(harm.index);
    CAPTURE(harm.length);
    std::string bytes = sound;
    std::memcpy(bytes.data() + first, &harm.index, sizeof harm.index);
    std::memcpy(bytes.data() + first + 8, &harm.length, sizeof harm.length);
    put_bytes(folder / "harmed.h5", bytes);
    CHECK(contains(complaint(folder / "harmed.h5"), "no length"));
  }
}

TEST_CASE("References to texts that their heap does not have are refused before they are followed") {
  const auto folder = scratch_folder("h5_references");
  const std::string sound = unsealed(small_file(folder / "sound.h5"));
  const std::uint64_t heap = sound.find("GCOL");
  // A reference: length, address of the heap, number of the object.
  const std::string address(reinterpret_cast<const char*>(&heap), sizeof heap);
  std::size_t refused = 0, tried = 0;
  for (std::size_t at = sound.find(address); at != std::string::npos; at = sound.find(address, at + 1)) {
    std::uint32_t length = 0, first = 0;
    std::memcpy(&length, sound.data() + at - 4, sizeof length);
    std::memcpy(&first, sound.data() + at + 8, sizeof first);
    if (length > 100 || first == 0 || first > 100) continue;  // other bytes of the same value
    for (const std::uint32_t number : {std::uint32_t{300}, std::uint32_t{70'000}, ~std::uint32_t{0}}) {
      std::string bytes = sound;
      std::memcpy(bytes.data() + at + 8, &number, sizeof number);
      put_bytes(folder / "harmed.h5", bytes);
      refused +=
          contains(complaint(folder / "harmed.h5"), "refers to texts that are not in the file") ? 1 : 0;
      ++tried;
    }
  }
  CHECK(tried == 18);  // of two attributes and four texts of a dataset
  CHECK(refused == 18);
}

TEST_CASE(
    "Texts of attributes are looked for in headers of both versions, continued ones, behind a user block") {
  const auto folder = scratch_folder("h5_attributes");
  struct Form {
    bool latest;
    hsize_t user_block;
    int attributes;
    bool in_header;
  };
  for (const Form& form : {Form{false, 0, 5, true}, Form{false, 512, 60, true}, Form{true, 0, 5, true},
                           Form{true, 1024, 7, true}, Form{true, 0, 20, false}}) {
    CAPTURE(form.latest);
    CAPTURE(form.user_block);
    CAPTURE(form.attributes);
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS), creation = H5Pcreate(H5P_FILE_CREATE);
    if (form.latest) H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    H5Pset_userblock(creation, form.user_block);
    const Path path = folder / "sound.h5";
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access);
    REQUIRE(file >= 0);
    const hid_t group = H5Gcreate2(file, "parts", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, H5T_VARIABLE);
    for (int i = 0; i < form.attributes; ++i) {
      const std::string name = "attribute " + std::to_string(i), text = "text " + std::to_string(i);
      const char* value = text.c_str();
      const hid_t attribute = H5Acreate2(group, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
      H5Awrite(attribute, type, &value);
      H5Aclose(attribute);
    }
    H5Sclose(space);
    H5Tclose(type);
    H5Gclose(group);
    H5Fclose(file);
    H5Pclose(access);
    H5Pclose(creation);
    CHECK(complaint(path) == "");
    // Another number for the first object, which some attribute then refers to in vain.
    std::string bytes = bytes_of(path);
    const std::size_t heap = bytes.find("GCOL");
    REQUIRE(heap != std::string::npos);
    const std::uint16_t other = 999;
    std::memcpy(bytes.data() + heap + 16, &other, sizeof other);
    put_bytes(folder / "harmed.h5", bytes);
    if (form.in_header)
      check_contains(complaint(folder / "harmed.h5"),
                     {"attribute \"attribute ", "\"/parts\"", "refers to texts that are not in the file"});
  }
}

TEST_CASE("References to other files are refused before they are followed, and are no damage") {
  const auto folder = scratch_folder("h5_foreign");
  const auto refusal = [](const Path& path) {
    const std::string text = complaint(path);
    check_contains(text, "into one file");
    CHECK_FALSE(contains(text, "damaged"));
    return text;
  };
  const Path other = small_file(folder / "other.h5");
  const hsize_t size = 20;
  check_contains(refusal(foreign(folder / "link.h5",
                                 [&](hid_t file) {
                                   H5Lcreate_external(other.c_str(), "/numbers", file, "numbers", H5P_DEFAULT,
                                                      H5P_DEFAULT);
                                 })),
                 {"link.h5", "\"/numbers\" is a link to another file"});
  const Path pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  check_contains(refusal(foreign(folder / "storage.h5",
                                 [&](hid_t file) {
                                   const hid_t space = H5Screate_simple(1, &size, nullptr);
                                   const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
                                   H5Pset_external(properties, pipe.c_str(), 0, size * 8);
                                   H5Dclose(H5Dcreate2(file, "numbers", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                                                       properties, H5P_DEFAULT));
                                   H5Pclose(properties);
                                   H5Sclose(space);
                                 })),
                 {"storage.h5", "keeps its numbers in another file"});
  check_contains(refusal(foreign(folder / "virtual.h5",
                                 [&](hid_t file) {
                                   const hid_t space = H5Screate_simple(1, &size, nullptr);
                                   const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
                                   H5Pset_virtual(properties, space, other.c_str(), "/numbers", space);
                                   H5Dclose(H5Dcreate2(file, "numbers", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                                                       properties, H5P_DEFAULT));
                                   H5Pclose(properties);
                                   H5Sclose(space);
                                 })),
                 {"virtual.h5", "virtual dataset"});
  check_contains(complaint(pipe), {"pipe", "not a file"});
}

TEST_CASE("Damaged files that crashed HDF5 are refused, or hold nothing that does") {
  const auto folder = shared_file("findings/inputs/crashers");
  if (!folder) return;
  std::size_t refused = 0, files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("flip_")) continue;
    CAPTURE(name);
    ++files;
    const std::string found = complaint(entry.path());
    std::cout << name << ": " << (found.empty() ? "opens" : found) << "\n";
    refused += found.empty() ? 0 : 1;
  }
  CHECK(files > 0);
  CHECK(refused > 0);
}
