#include "scintray/core/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/core/zlib_stream.hpp"

namespace scintray::core {

namespace {

bool starts_like(std::string_view text, std::string_view start) {
  return text.size() >= start.size() &&
         std::equal(start.begin(), start.end(), text.begin(), [](char wanted, char found) {
           return wanted == std::tolower(static_cast<unsigned char>(found));
         });
}

/// True when the first line that is no comment is a header or a key of TOML.
bool is_toml(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
    line = line.substr(0, line.find_last_not_of(kSpace) + 1);
    if (line.empty() || line.front() == '#') continue;
    const auto is_key = [](std::string_view key) {
      return !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("_-.\"' ").find(static_cast<char>(c)) != std::string_view::npos;
      });
    };
    if (line.front() != '[') return line.find('=') != line.npos && is_key(line.substr(0, line.find('=')));
    const std::string_view name = line.substr(line.starts_with("[[") ? 2 : 1);
    return is_key(name.substr(0, name.find(']'))) &&
           std::isdigit(static_cast<unsigned char>(name.front())) == 0;
  }
  return false;
}

/// Kind of a file by its first bytes, with its article; nullptr for one of no special kind.
const char* kind_of(std::string_view content) {
  if (content.starts_with("\x89HDF\r\n\x1a\n")) return "an HDF5 file";
  if (starts_like(content, "<!doctype html") || starts_like(content, "<html")) return "an HTML page";
  if (starts_like(content, "<svg") || starts_like(content, "<?xml")) return "an SVG or XML file";
  if (content.starts_with("Gwyddion Simple Field")) return "a height map";
  if (content.starts_with("glTF")) return "a binary glTF file";
  return is_toml(content) ? "a TOML file" : nullptr;
}

}  // namespace

void require_replaceable(const std::filesystem::path& path, std::string_view content) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return;
  const auto refuse = [&path](const std::string& what) {
    throw InputError({{path.string()},
                      what + ", so it is not written over",
                      "choose another name for what is written, or move what is there away"});
  };
  if (std::filesystem::is_directory(status)) refuse("this is a folder");
  if (!std::filesystem::is_regular_file(status)) refuse("this is a device, a pipe or a socket");
  constexpr std::size_t kHead = 1 << 16;
  const std::string head = read_beginning(path, kHead).value_or("");
  if (head.empty()) return;
  const char *there = kind_of(head), *to_be = kind_of(content);
  if (there == to_be || (there != nullptr && to_be != nullptr && std::string_view(there) == to_be)) return;
  refuse(std::string("this exists and is ") + (there == nullptr ? "a file of another kind" : there) +
         ", not " + (to_be == nullptr ? "of the kind that is to be written" : to_be));
}

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

OutputFile::OutputFile(std::filesystem::path path, Container container, const std::string& what,
                       std::string_view head)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.path = std::move(path);
  if (!what.empty()) s.what = " " + what;
  if (std::filesystem::is_directory(s.path)) s.fail(EISDIR);
  require_replaceable(s.path, head);
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
  OutputFile file(path, Container::plain, what, content);
  file.write(content);
  file.commit();
}

}  // namespace scintray::core
