#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "scintray/core/detail/h5_internal.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/input_file.hpp"
#include "scintray/core/output_file.hpp"

namespace scintray::core::h5 {

namespace {

/// Creates a file with disk space for HDF5's first write, so that a folder without permission or a
/// full disk is detected before HDF5 starts.
void take_space(const std::filesystem::path& path, const std::filesystem::path& name) {
  constexpr off_t kFirstBytes = 1 << 16;
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const int cause = descriptor < 0 ? errno : allocate(descriptor, 0, kFirstBytes);
  if (descriptor >= 0) ::close(descriptor);
  if (cause != 0) throw SystemError(name.string() + ": cannot write: " + std::strerror(cause));
}

/// Delayed writing errors (quotas, network file systems) appear only here. `name` is for the message.
void sync_to_disk(const std::filesystem::path& path, const std::filesystem::path& name) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  const int status = descriptor < 0 ? -1 : ::fsync(descriptor);
  const int cause = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (status != 0 && cause != EINVAL)  // EINVAL: a file system that cannot sync
    throw SystemError(name.string() + ": cannot write to disk: " + std::strerror(cause));
}

/// Releases the disk space allocated in advance; that HDF5 opens the file shows that it is complete.
void drop_unused_end(const std::filesystem::path& path, const std::filesystem::path& name) {
  const Handle access = access_properties();
  haddr_t end = 0;
  {
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
    if (!file.valid() || H5Fget_eoa(file.id(), &end) < 0)
      throw SystemError(failure_text(name.string(), "", "read back"));
  }
  if (::truncate(path.c_str(), static_cast<off_t>(end)) != 0)
    throw SystemError(name.string() + ": cannot write: " + std::strerror(errno));
}

}  // namespace

File::File() : state_(std::make_unique<State>()) {}
File::File(File&&) noexcept = default;
File& File::operator=(File&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

File::~File() {
  if (!state_) return;
  const Quiet quiet;
  Life& life = *state_->life;
  life.give_up("not committed");
  if (life.file >= 0) H5Fclose(std::exchange(life.file, -1));
  std::error_code ignored;
  if (!state_->temporary.empty()) std::filesystem::remove(state_->temporary, ignored);
}

File File::create(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path))
    throw SystemError(path.string() + ": cannot write: it is a folder");
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder))
    throw SystemError(path.string() + ": cannot write: there is no folder " + folder.string());
  require_replaceable(path, "\x89HDF\r\n\x1a\n");
  const Quiet quiet;
  File file;
  file.state_->path = path;
  const auto temporary =
      folder / ("." + path.filename().string() + "." + std::to_string(::getpid()) + ".unfinished");
  file.state_->temporary = temporary;
  take_space(temporary, path);
  const Handle creation = creation_order_properties(H5P_FILE_CREATE);
  const Handle access = access_properties();
  file.state_->life->file = H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, creation.id(), access.id());
  if (file.state_->life->file < 0) throw SystemError(failure_text(path.string(), "", "write"));
  file.state_->life->writing = true;
  return file;
}

File File::open(const std::filesystem::path& path) {
  const auto wrong = [&](const std::string& what, const std::string& hint) {
    return InputError({{path.string()}, what, hint});
  };
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw wrong("there is no such file", "check the name and the folder");
  if (std::filesystem::is_directory(path))
    throw wrong("this is a folder, not a file", "name the file inside it");
  if (!std::filesystem::is_regular_file(path))
    throw wrong("this is a pipe or a device, not a file", "name the file that holds the data");
  if (::access(path.c_str(), R_OK) != 0)
    throw SystemError(path.string() + ": cannot read: " + std::strerror(errno));
  const Quiet quiet;
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw wrong("this is not an HDF5 file", "name a file that ScintRay wrote, or make it again");
  require_sound(path);
  File file;
  file.state_->path = path;
  const Handle access = access_properties();
  file.state_->life->file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id());
  if (file.state_->life->file < 0)
    throw wrong("this HDF5 file is damaged: " + hdf5_reason(),
                "copy it again from where it was made, or run again");
  InputRecord::add(path);
  return file;
}

Group File::root() const {
  state_->life->require_usable(state_->path.string());
  const Quiet quiet;
  Handle opened(H5Gopen2(state_->life->file, "/", H5P_DEFAULT), H5Gclose);
  if (!opened.valid()) throw SystemError(failure_text(state_->path.string(), "/", "open group"));
  Group group;
  group.state_.reset(new Group::State{state_->path.string(), "/", std::move(opened), {}, state_->life});
  return group;
}

void File::flush() {
  state_->life->require_usable(state_->path.string());
  const Quiet quiet;
  if (H5Fflush(state_->life->file, H5F_SCOPE_GLOBAL) < 0) state_->give_up();
}

void File::commit() {
  if (state_->temporary.empty())
    throw InternalError(state_->path.string() + ": commit of a file that is not being written");
  flush();
  const Quiet quiet;
  if (H5Fclose(state_->life->file) < 0) state_->give_up();
  state_->life->file = -1;
  drop_unused_end(state_->temporary, state_->path);
  append_seal(state_->temporary, state_->path);
  sync_to_disk(state_->temporary, state_->path);
  std::error_code error;
  std::filesystem::rename(state_->temporary, state_->path, error);
  if (error)
    throw SystemError(state_->path.string() + ": cannot put the finished file in place: " + error.message());
  state_->temporary.clear();
  sync_folder_of(state_->path);
}

const std::filesystem::path& File::path() const { return state_->path; }

}  // namespace scintray::core::h5
