#include "scintray/core/journal.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/zlib_stream.hpp"

namespace scintray::core {

namespace {

constexpr std::string_view kMagic = "ScintRay journal 1\n";
/// Of a record: lengths of key and bytes before them, and the CRC-32 of all after.
constexpr std::size_t kHead = 2 * sizeof(std::uint64_t), kTail = sizeof(std::uint32_t);

template <typename T>
std::string plain(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

template <typename T>
T plain(std::string_view bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

std::string record(std::string_view key, std::string_view bytes) {
  std::string all = plain<std::uint64_t>(key.size()) + plain<std::uint64_t>(bytes.size());
  all.append(key).append(bytes);
  return all + plain(crc32(all));
}

/// Bytes of a file from a position on; fewer at its end. @throws SystemError
std::string read_at(int descriptor, std::uint64_t at, std::uint64_t size, const std::filesystem::path& path) {
  std::string bytes(size, '\0');
  std::uint64_t done = 0;
  while (done < size) {
    const ssize_t got = ::pread(descriptor, bytes.data() + done, size - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw SystemError(path.string() + ": cannot read: " + std::strerror(errno));
    if (got == 0) break;
    done += static_cast<std::uint64_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

/// A record that was read whole.
struct Record {
  std::string key, bytes;
};

/// The record at a position; nothing where the file has none to its end.
std::optional<Record> record_at(int descriptor, std::uint64_t at, std::uint64_t file_size,
                                const std::filesystem::path& path) {
  if (file_size - at < kHead + kTail) return std::nullopt;
  const std::string head = read_at(descriptor, at, kHead, path);
  const auto key = plain<std::uint64_t>(std::string_view(head).substr(0, sizeof(std::uint64_t)));
  const auto size = plain<std::uint64_t>(std::string_view(head).substr(sizeof(std::uint64_t)));
  const std::uint64_t left = file_size - at - kHead - kTail;
  if (key > left || size > left - key) return std::nullopt;
  const std::string body = read_at(descriptor, at + kHead, key + size + kTail, path);
  if (body.size() != key + size + kTail) return std::nullopt;
  const std::string_view content = std::string_view(body).substr(0, key + size);
  if (crc32(content, crc32(head)) != plain<std::uint32_t>(std::string_view(body).substr(key + size)))
    return std::nullopt;
  return Record{std::string(content.substr(0, key)), std::string(content.substr(key))};
}

}  // namespace

Journal::Journal(JournalSettings settings, std::string identity)
    : settings_(std::move(settings)), identity_(std::move(identity)) {
  std::error_code ignored;
  if (!std::filesystem::exists(settings_.path, ignored)) return;
  const bool of_this = read_earlier();
  const auto refused = [&](const std::string& what, const std::string& hint) {
    return InputError({{settings_.path.string()}, what, hint});
  };
  if (settings_.start == JournalStart::refuse && of_this && !pieces_.empty())
    throw refused("unfinished work has left its finished pieces here",
                  "add --resume to go on after them, or --restart to begin anew");
  if (settings_.start == JournalStart::resume && !of_this)
    throw refused("these are the finished pieces of other work: another input, option, seed or version",
                  "repeat the command that they are of, or add --restart to begin anew");
  if (settings_.start == JournalStart::resume) return;
  pieces_.clear();
  end_ = 0;
}

Journal::~Journal() {
  if (descriptor_ < 0) return;
  ::fsync(descriptor_);
  ::close(descriptor_);
}

bool Journal::read_earlier() {
  const int descriptor = ::open(settings_.path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw SystemError(settings_.path.string() + ": cannot open: " + std::strerror(errno));
  struct stat status {};
  ::fstat(descriptor, &status);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  try {
    const std::string magic = read_at(descriptor, 0, kMagic.size(), settings_.path);
    if (!kMagic.starts_with(magic) || !S_ISREG(status.st_mode))
      throw InputError({{settings_.path.string()},
                        "this exists and is no journal of ScintRay, so it is not written over",
                        "move it away, or choose another output"});
    bool of_this = true;
    std::uint64_t at = kMagic.size();
    for (bool first = true; magic.size() == kMagic.size(); first = false) {
      const std::optional<Record> found = record_at(descriptor, at, size, settings_.path);
      if (!found) break;
      if (first) {
        of_this = found->key.empty() && found->bytes == identity_;
        if (!of_this) break;
      } else {
        pieces_[found->key] = {at + kHead + found->key.size(), found->bytes.size()};
      }
      at += kHead + found->key.size() + found->bytes.size() + kTail;
      end_ = at;
    }
    ::close(descriptor);
    return of_this;
  } catch (...) {
    ::close(descriptor);
    throw;
  }
}

void Journal::open_for_writing() {
  // Of earlier pieces only the sound ones stay.
  descriptor_ = ::open(settings_.path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0 || ::ftruncate(descriptor_, static_cast<off_t>(end_)) != 0)
    throw SystemError(settings_.path.string() + ": cannot write: " + std::strerror(errno));
  if (end_ == 0) write(std::string(kMagic) + record({}, identity_));
  sync_folder_of(settings_.path);
}

void Journal::write(std::string_view bytes) {
  std::uint64_t done = 0;
  while (done < bytes.size()) {
    const ssize_t put =
        ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(end_ + done));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) throw SystemError(settings_.path.string() + ": cannot write: " + std::strerror(errno));
    done += static_cast<std::uint64_t>(put);
  }
  end_ += bytes.size();
}

std::optional<std::string> Journal::find(const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = pieces_.find(key);
  if (found == pieces_.end()) return std::nullopt;
  const int descriptor =
      descriptor_ >= 0 ? descriptor_ : ::open(settings_.path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw SystemError(settings_.path.string() + ": cannot open: " + std::strerror(errno));
  std::string bytes = read_at(descriptor, found->second.at, found->second.size, settings_.path);
  if (descriptor != descriptor_) ::close(descriptor);
  if (bytes.size() != found->second.size)
    throw SystemError(settings_.path.string() + ": became shorter while it was read");
  return bytes;
}

void Journal::add(const std::string& key, std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (descriptor_ < 0) open_for_writing();
  const std::uint64_t at = end_ + kHead + key.size();
  write(record(key, bytes));
  pieces_[key] = {at, bytes.size()};
  const auto now = std::chrono::steady_clock::now();
  if (now - synced_ < settings_.sync_every) return;
  ::fsync(descriptor_);
  synced_ = now;
}

std::size_t Journal::pieces() const {
  const std::lock_guard lock(mutex_);
  return pieces_.size();
}

void Journal::remove() {
  const std::lock_guard lock(mutex_);
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  pieces_.clear();
  std::error_code ignored;
  std::filesystem::remove(settings_.path, ignored);
}

}  // namespace scintray::core
