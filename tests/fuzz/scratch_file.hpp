#pragma once
/// Files and folders as long as they are needed, for readers that take a path.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace scintray::fuzz {

/// A path in the folder of temporary files, of this process alone. What is there is removed at its end.
class ScratchPath {
 public:
  explicit ScratchPath(const std::string& ending)
      : path_(std::filesystem::temp_directory_path() /
              ("scintray_fuzz_" + std::to_string(getpid()) + ending)) {}
  ScratchPath(const ScratchPath&) = delete;
  ScratchPath& operator=(const ScratchPath&) = delete;
  ~ScratchPath() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A file of the bytes, as long as it lives.
class ScratchFile : public ScratchPath {
 public:
  ScratchFile(const std::uint8_t* data, std::size_t size, const char* ending) : ScratchPath(ending) {
    std::ofstream(path(), std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
};

/// An empty folder, as long as it lives.
class ScratchFolder : public ScratchPath {
 public:
  ScratchFolder() : ScratchPath("_folder") {
    std::filesystem::remove_all(path());
    std::filesystem::create_directories(path());
  }
};

}  // namespace scintray::fuzz
