#include "scintray/core/detail/h5_internal.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <numeric>

#include "scintray/core/error.hpp"

namespace scintray::core::h5 {

namespace {

/// Deflate cannot shrink by more than 1032:1 (zlib technical details), so a dataset that claims more
/// than this per stored byte is damaged.
constexpr std::uint64_t kLargestDeflateRatio = 1032;

}  // namespace

std::string hdf5_reason() {
  std::string deepest;
  const auto visit = [](unsigned depth, const H5E_error2_t* entry, void* data) -> herr_t {
    if (depth == 0 && entry->desc != nullptr) *static_cast<std::string*>(data) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &deepest);
  if (deepest.empty()) return "HDF5 reports no reason";
  // Messages about system calls hide the cause in a list of addresses: take the cause alone.
  const std::string mark = "error message = '";
  const auto start = deepest.find(mark);
  if (start == std::string::npos) return deepest;
  const auto end = deepest.find('\'', start + mark.size());
  return deepest.substr(start + mark.size(), end - start - mark.size());
}

std::string failure_text(const std::string& file, const std::string& object, const std::string& action) {
  return file + ": cannot " + action + (object.empty() ? "" : " " + object) + ": " + hdf5_reason();
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

Handle creation_order_properties(hid_t kind) {
  Handle properties(H5Pcreate(kind), H5Pclose);
  H5Pset_link_creation_order(properties.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_obj_track_times(properties.id(), false);
  return properties;
}

Handle access_properties() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(properties.id(), H5F_CLOSE_STRONG);
  // Some cluster file systems have no locks; a results file is readable there, too.
  H5Pset_file_locking(properties.id(), true, true);
  return properties;
}

Handle inside_properties(hid_t kind) {
  Handle properties(H5Pcreate(kind), H5Pclose);
  const auto refuse = [](const char*, const char*, const char*, const char*, unsigned*, hid_t,
                         void*) -> herr_t { return -1; };
  H5Pset_elink_cb(properties.id(), refuse, nullptr);
  return properties;
}

bool fits_storage(const Handle& dataset, const Shape& shape) {
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const double stated = std::accumulate(shape.begin(), shape.end(),
                                        static_cast<double>(H5Tget_size(type.id())), std::multiplies<>());
  return stated <=
         static_cast<double>(H5Dget_storage_size(dataset.id())) * static_cast<double>(kLargestDeflateRatio);
}

int allocate(int descriptor, off_t from, off_t to) {
  if (::fallocate(descriptor, 0, from, to - from) == 0) return 0;
  if (errno != EOPNOTSUPP && errno != ENOSYS) return errno;
  const std::vector<char> zeros(static_cast<std::size_t>(std::min<off_t>(to - from, 1 << 20)), '\0');
  for (off_t at = from; at < to;) {
    const auto length = static_cast<std::size_t>(std::min<off_t>(to - at, static_cast<off_t>(zeros.size())));
    const ssize_t written = ::pwrite(descriptor, zeros.data(), length, at);
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    at += written;
  }
  return 0;
}

int Life::descriptor() const {
  void* handle = nullptr;
  return H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 ? -1 : *static_cast<const int*>(handle);
}

int Life::reserve(std::uint64_t bytes) {
  constexpr std::uint64_t kMetadata = 1 << 18, kStep = 1 << 20;
  hsize_t size = 0;
  H5Fget_filesize(file, &size);
  const std::uint64_t needed = size + bytes + stream_bytes + kMetadata;
  if (needed <= reserved) return 0;
  const std::uint64_t target = std::max(needed, reserved + kStep);
  const int cause = allocate(descriptor(), static_cast<off_t>(reserved), static_cast<off_t>(target));
  if (cause == 0) reserved = target;
  return cause;
}

void Life::give_up(const std::string& message) {
  if (!writing || file < 0 || !failure.empty()) return;
  failure = message;
  const int target = descriptor(), memory = ::memfd_create("scintray-discarded", MFD_CLOEXEC);
  if (memory < 0) return;
  if (target >= 0) ::dup2(memory, target);
  ::close(memory);
}

void Life::require_usable(const std::string& name) const {
  if (file < 0) throw InternalError(name + " used after its file was closed");
  if (!failure.empty()) throw SystemError(failure);
}

void File::State::give_up() const {
  const std::string message = failure_text(path.string(), "", "write");
  life->give_up(message);
  throw SystemError(message);
}

Group::State::~State() {
  if (life->file < 0) {  // closing the file has closed everything in it
    group.release();
    for (auto& entry : streams) entry.second.release();
  }
  const Quiet quiet;
  streams.clear();
  group = Handle(-1, H5Gclose);
}

std::string Group::State::object(const std::string& member) const {
  if (member.empty()) return name;
  std::string text = name;
  if (text != "/") text += '/';
  return text += member;
}

void Group::State::fail(const std::string& action, const std::string& member) const {
  throw SystemError(failure_text(file, object(member), action));
}

void Group::State::give_up(const std::string& action, const std::string& member) const {
  const std::string message = failure_text(file, object(member), action);
  life->give_up(message);
  throw SystemError(message);
}

void Group::State::refuse(const std::string& action, const std::string& member,
                          const std::string& reason) const {
  throw SystemError(file + ": cannot " + action + " " + object(member) + ": " + reason);
}

void Group::State::reserve(std::uint64_t bytes, const std::string& action, const std::string& member) const {
  require_open();
  const int cause = life->reserve(bytes);
  if (cause == 0) return;
  const std::string message =
      file + ": cannot " + action + " " + object(member) + ": " + std::strerror(cause);
  life->give_up(message);
  throw SystemError(message);
}

Handle Group::State::attribute_owner(const std::string& member) const {
  require_open();
  const Handle inside = inside_properties(H5P_LINK_ACCESS);
  Handle owner(H5Oopen(group.id(), member.empty() ? "." : member.c_str(), inside.id()), H5Oclose);
  if (!owner.valid()) fail("open", member);
  return owner;
}

Handle Group::State::open_dataset(const std::string& member) const {
  require_open();
  const Handle inside = inside_properties(H5P_DATASET_ACCESS);
  Handle dataset(H5Dopen2(group.id(), member.c_str(), inside.id()), H5Dclose);
  if (!dataset.valid()) fail("open dataset", member);
  if (const std::string foreign = foreign_storage(dataset); !foreign.empty())
    refuse("read", member, "it " + foreign);
  return dataset;
}

Shape Group::State::checked_shape(const Handle& dataset, const std::string& member) const {
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const int dimensions = H5Sget_simple_extent_ndims(space.id());
  if (dimensions < 0) fail("read the shape of", member);
  std::vector<hsize_t> extent(static_cast<std::size_t>(dimensions));
  H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
  Shape shape(extent.begin(), extent.end());
  if (H5Sget_simple_extent_type(space.id()) == H5S_NULL) shape = {0};
  if (!fits_storage(dataset, shape))
    refuse("read", member,
           "its shape does not fit the " + std::to_string(H5Dget_storage_size(dataset.id())) +
               " bytes stored for it");
  return shape;
}

void Group::State::write_text_attribute(const std::string& member, const std::string& attribute,
                                        const char* text) const {
  const Handle type = text_type();
  write_attribute(member, attribute, type.id(), type.id(), static_cast<const void*>(&text));
}

void Group::State::write_attribute(const std::string& member, const std::string& attribute, hid_t file_type,
                                   hid_t memory_type, const void* value) const {
  reserve(0, "write attribute \"" + attribute + "\" of", member);
  const Handle owner = attribute_owner(member);
  if (H5Aexists(owner.id(), attribute.c_str()) > 0) H5Adelete(owner.id(), attribute.c_str());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle created(
      H5Acreate2(owner.id(), attribute.c_str(), file_type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!created.valid() || H5Awrite(created.id(), memory_type, value) < 0)
    fail("write attribute \"" + attribute + "\" of", member);
}

Handle Group::State::open_attribute(const std::string& member, const std::string& attribute,
                                    bool text) const {
  const Handle owner = attribute_owner(member);
  Handle opened(H5Aopen(owner.id(), attribute.c_str(), H5P_DEFAULT), H5Aclose);
  const std::string action = "read attribute \"" + attribute + "\" of";
  if (!opened.valid()) fail(action, member);
  const Handle space(H5Aget_space(opened.id()), H5Sclose);
  const Handle type(H5Aget_type(opened.id()), H5Tclose);
  if (H5Sget_simple_extent_npoints(space.id()) != 1) refuse(action, member, "it is not a single value");
  const H5T_class_t kind = H5Tget_class(type.id());
  if (text && kind != H5T_STRING) refuse(action, member, "it is not text");
  if (!text && kind != H5T_INTEGER && kind != H5T_FLOAT) refuse(action, member, "it is not a number");
  return opened;
}

}  // namespace scintray::core::h5
