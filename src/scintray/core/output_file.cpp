#include "scintray/core/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/core/zlib_stream.hpp"

namespace scintray::core {

struct OutputFile::State {
  std::filesystem::path path, temporary;
  std::string what;  ///< "" or " the report"
  int descriptor = -1;
  bool finished = false, committed = false;
  std::optional<Packer> packer;  ///< empty for plain text

  ~State() {
    if (descriptor >= 0) ::close(descriptor);
    std::error_code ignored;
    if (!committed) std::filesystem::remove(temporary, ignored);
  }

  [[noreturn]] void fail(int cause) const {
    throw SystemError(path.string() + ": cannot write" + what + ": " + std::strerror(cause));
  }

  void put(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t done = ::write(descriptor, bytes.data(), bytes.size());
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) fail(errno);
      bytes.remove_prefix(static_cast<std::size_t>(done));
    }
  }
};

OutputFile::OutputFile(std::filesystem::path path, Container container, const std::string& what)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.path = std::move(path);
  if (!what.empty()) s.what = " " + what;
  if (std::filesystem::is_directory(s.path)) s.fail(EISDIR);
  s.temporary = s.path;
  s.temporary.replace_filename("." + s.path.filename().string() + "." + std::to_string(::getpid()) +
                               ".unfinished");
  s.descriptor = ::open(s.temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (s.descriptor < 0) s.fail(errno);
  if (container == Container::zlib) s.packer.emplace();
}

OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

void OutputFile::write(std::string_view text) {
  State& s = *state_;
  if (s.packer)
    s.packer->add(text, [&s](std::string_view bytes) { s.put(bytes); });
  else
    s.put(text);
}

void OutputFile::finish() {
  State& s = *state_;
  if (s.finished) return;
  if (s.packer) s.packer->finish([&s](std::string_view bytes) { s.put(bytes); });
  // EINVAL: a file system that cannot sync.
  if (::fsync(s.descriptor) != 0 && errno != EINVAL) s.fail(errno);
  const int status = ::close(s.descriptor);
  const int cause = errno;
  s.descriptor = -1;
  if (status != 0) s.fail(cause);
  s.finished = true;
}

void OutputFile::commit() {
  finish();
  State& s = *state_;
  std::error_code error;
  std::filesystem::rename(s.temporary, s.path, error);
  if (error) s.fail(error.value());
  s.committed = true;
  sync_folder_of(s.path);
}

void sync_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void write_whole_file(const std::filesystem::path& path, std::string_view content, const std::string& what) {
  OutputFile file(path, Container::plain, what);
  file.write(content);
  file.commit();
}

}  // namespace scintray::core
