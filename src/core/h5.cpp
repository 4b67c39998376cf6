#include "scintray/core/h5.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>
#include <system_error>
#include <utility>

#include "scintray/core/error.hpp"

namespace scintray::h5 {

namespace {

constexpr std::uint64_t kCompressFromBytes = 4096;
constexpr std::uint64_t kChunkBytes = 1 << 20;
constexpr unsigned kDeflateLevel = 4;
constexpr std::uint64_t kChunkCacheBytes = 1 << 20;  ///< HDF5's default for each dataset
/// Deflate cannot shrink by more than 1032:1 (zlib technical details), so a dataset that claims more
/// than this per stored byte is damaged.
constexpr std::uint64_t kLargestDeflateRatio = 1032;

/// Switches HDF5's printing to stderr off while it lives; the caller's setting comes back after.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// The deepest entry of HDF5's error stack: where the trouble began.
std::string hdf5_reason() {
  std::string deepest;
  const auto visit = [](unsigned depth, const H5E_error2_t* entry, void* data) -> herr_t {
    if (depth == 0 && entry->desc != nullptr) *static_cast<std::string*>(data) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &deepest);
  if (deepest.empty()) return "HDF5 gives no reason";
  // Messages about system calls bury the cause in a list of addresses: take the cause alone.
  const std::string mark = "error message = '";
  const auto start = deepest.find(mark);
  if (start == std::string::npos) return deepest;
  const auto end = deepest.find('\'', start + mark.size());
  return deepest.substr(start + mark.size(), end - start - mark.size());
}

std::string failure_text(const std::string& file, const std::string& object, const std::string& action) {
  return file + ": cannot " + action + (object.empty() ? "" : " " + object) + ": " + hdf5_reason();
}

/// An HDF5 identifier, closed with its own function.
class Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) closer_(id_);
  }
  hid_t id() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// For a file that is already closed, with everything in it.
  void release() { id_ = -1; }

 private:
  hid_t id_;
  Closer closer_;
};

template <typename T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::uint32_t>) return H5T_NATIVE_UINT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_NATIVE_UINT64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

std::uint64_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

Handle space_of(const Shape& shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose};
}

/// No time stamps: equal results make equal files.
Handle dataset_properties() {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);
  return properties;
}

void compress(const Handle& properties, const std::vector<hsize_t>& chunk) {
  H5Pset_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data());
  if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) <= 0) return;
  H5Pset_shuffle(properties.id());
  H5Pset_deflate(properties.id(), kDeflateLevel);
}

/// Chunk of at most about kChunkBytes, cut along the slowest dimensions first.
std::vector<hsize_t> chunk_of(const Shape& shape, std::uint64_t value_bytes) {
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  std::uint64_t bytes = product(shape) * value_bytes;
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    while (bytes > kChunkBytes && chunk[i] > 1) {
      const hsize_t half = (chunk[i] + 1) / 2;
      bytes = bytes / chunk[i] * half;
      chunk[i] = half;
    }
  }
  return chunk;
}

/// A number that does not fit the type it is read into is an error, not a clipped value.
H5T_conv_ret_t refuse_overflow(H5T_conv_except_t exception, hid_t, hid_t, void*, void*, void*) {
  return exception == H5T_CONV_EXCEPT_PRECISION ? H5T_CONV_UNHANDLED : H5T_CONV_ABORT;
}

Handle transfer_properties() {
  Handle properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_type_conv_cb(properties.id(), refuse_overflow, nullptr);
  return properties;
}

/// Makes [from, to) of a file real disk space. 0 or an errno value.
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

/// Makes a new file with disk space for HDF5's first write, so that a folder without permission or a
/// full disk is found before HDF5 starts.
void take_space(const std::filesystem::path& path, const std::filesystem::path& name) {
  constexpr off_t kFirstBytes = 1 << 16;
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const int cause = descriptor < 0 ? errno : allocate(descriptor, 0, kFirstBytes);
  if (descriptor >= 0) ::close(descriptor);
  if (cause != 0) throw SystemError(name.string() + ": cannot write: " + std::strerror(cause));
}

/// Delayed writing errors (quotas, network file systems) show only here. `name` is for the message.
void sync_to_disk(const std::filesystem::path& path, const std::filesystem::path& name) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  const int status = descriptor < 0 ? -1 : ::fsync(descriptor);
  const int cause = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (status != 0 && cause != EINVAL)  // EINVAL: a file system that cannot sync
    throw SystemError(name.string() + ": cannot write to disk: " + std::strerror(cause));
}

/// What a file and its groups know of each other: groups may outlive the file.
///
/// HDF5 cannot let go of a file whose caches it could not write: closing fails, and the process crashes
/// in HDF5's exit handler. So disk space is taken before HDF5 needs it, and a full disk is met here.
struct Life {
  hid_t file = -1;  ///< -1 once closed
  bool writing = false;
  std::string failure;             ///< message of the first failed write; nothing is written after it
  std::uint64_t reserved = 0;      ///< bytes of the file known to have disk space
  std::uint64_t stream_bytes = 0;  ///< most that the chunk caches of all streams can hold back

  int descriptor() const {
    void* handle = nullptr;
    return H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 ? -1 : *static_cast<const int*>(handle);
  }

  /// Takes disk space for `bytes` more of data and for what describes it. 0 or an errno value.
  int reserve(std::uint64_t bytes) {
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

  /// Should a write fail all the same, the file is thrown away: from then on its descriptor points to
  /// memory, where what the caches still hold goes when the file is closed.
  void give_up(const std::string& message) {
    if (!writing || file < 0 || !failure.empty()) return;
    failure = message;
    const int target = descriptor(), memory = ::memfd_create("scintray-discarded", MFD_CLOEXEC);
    if (memory < 0) return;
    if (target >= 0) ::dup2(memory, target);
    ::close(memory);
  }
  void require_usable(const std::string& name) const {
    if (file < 0) throw InternalError(name + " used after its file was closed");
    if (!failure.empty()) throw SystemError(failure);
  }
};

}  // namespace

struct File::State {
  std::filesystem::path path;
  std::filesystem::path temporary;  ///< empty for a file opened for reading
  std::shared_ptr<Life> life = std::make_shared<Life>();

  [[noreturn]] void give_up() const {
    const std::string message = failure_text(path.string(), "", "write");
    life->give_up(message);
    throw SystemError(message);
  }
};

struct Group::State {
  std::string file;
  std::string name;  ///< path inside the file, "/" for the root
  Handle group{-1, H5Gclose};
  std::map<std::string, Handle> streams;  ///< kept open, so that a chunk is compressed once
  std::shared_ptr<Life> life;

  ~State() {
    if (life->file < 0) {  // closing the file has closed everything in it
      group.release();
      for (auto& entry : streams) entry.second.release();
    }
    const Quiet quiet;
    streams.clear();
    group = Handle(-1, H5Gclose);
  }
  std::string object(const std::string& member) const {
    if (member.empty()) return name;
    std::string text = name;
    if (text != "/") text += '/';
    return text += member;
  }
  [[noreturn]] void fail(const std::string& action, const std::string& member) const {
    throw SystemError(failure_text(file, object(member), action));
  }
  /// As fail(), when data already accepted may not have reached the file.
  [[noreturn]] void give_up(const std::string& action, const std::string& member) const {
    const std::string message = failure_text(file, object(member), action);
    life->give_up(message);
    throw SystemError(message);
  }
  [[noreturn]] void refuse(const std::string& action, const std::string& member,
                           const std::string& reason) const {
    throw SystemError(file + ": cannot " + action + " " + object(member) + ": " + reason);
  }
  void reserve(std::uint64_t bytes, const std::string& action, const std::string& member) const {
    require_open();
    const int cause = life->reserve(bytes);
    if (cause == 0) return;
    const std::string message =
        file + ": cannot " + action + " " + object(member) + ": " + std::strerror(cause);
    life->give_up(message);
    throw SystemError(message);
  }
  void require_open() const { life->require_usable(file + ": " + name); }

  /// The object that carries attributes: a member or, for "", the group itself.
  Handle attribute_owner(const std::string& member) const {
    require_open();
    Handle owner(H5Oopen(group.id(), member.empty() ? "." : member.c_str(), H5P_DEFAULT), H5Oclose);
    if (!owner.valid()) fail("open", member);
    return owner;
  }

  Handle open_dataset(const std::string& member) const {
    require_open();
    Handle dataset(H5Dopen2(group.id(), member.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset.valid()) fail("open dataset", member);
    return dataset;
  }

  /// Shape of a dataset, checked to be no larger than what the file can hold.
  Shape checked_shape(const Handle& dataset, const std::string& member) const {
    const Handle space(H5Dget_space(dataset.id()), H5Sclose);
    const int dimensions = H5Sget_simple_extent_ndims(space.id());
    if (dimensions < 0) fail("read the shape of", member);
    std::vector<hsize_t> extent(static_cast<std::size_t>(dimensions));
    H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
    Shape shape(extent.begin(), extent.end());
    if (H5Sget_simple_extent_type(space.id()) == H5S_NULL) shape = {0};
    const Handle type(H5Dget_type(dataset.id()), H5Tclose);
    const auto stored = H5Dget_storage_size(dataset.id());
    const double claimed = std::accumulate(shape.begin(), shape.end(),
                                           static_cast<double>(H5Tget_size(type.id())), std::multiplies<>());
    if (claimed > static_cast<double>(stored) * static_cast<double>(kLargestDeflateRatio))
      refuse("read", member, "its shape does not fit the " + std::to_string(stored) + " bytes stored for it");
    return shape;
  }

  void write_text_attribute(const std::string& member, const std::string& attribute, const char* text) const {
    const Handle type = text_type();
    write_attribute(member, attribute, type.id(), type.id(), static_cast<const void*>(&text));
  }

  void write_attribute(const std::string& member, const std::string& attribute, hid_t file_type,
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

  /// An attribute of one value whose type has class text or number, as asked.
  Handle open_attribute(const std::string& member, const std::string& attribute, bool text) const {
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
};

namespace {

Handle creation_order_properties(hid_t kind) {
  Handle properties(H5Pcreate(kind), H5Pclose);
  H5Pset_link_creation_order(properties.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_obj_track_times(properties.id(), false);
  return properties;
}

}  // namespace

Group Group::create_group(const std::string& name) {
  const Quiet quiet;
  state_->reserve(0, "create group", name);
  const Handle properties = creation_order_properties(H5P_GROUP_CREATE);
  Handle created(H5Gcreate2(state_->group.id(), name.c_str(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
                 H5Gclose);
  if (!created.valid()) state_->fail("create group", name);
  Group group;
  group.state_.reset(new State{state_->file, state_->object(name), std::move(created), {}, state_->life});
  return group;
}

Group Group::open_group(const std::string& name) const {
  state_->require_open();
  const Quiet quiet;
  Handle opened(H5Gopen2(state_->group.id(), name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!opened.valid()) state_->fail("open group", name);
  Group group;
  group.state_.reset(new State{state_->file, state_->object(name), std::move(opened), {}, state_->life});
  return group;
}

bool Group::has(const std::string& name) const {
  state_->require_open();
  const Quiet quiet;
  for (auto end = name.find('/');; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    if (H5Lexists(state_->group.id(), part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> Group::members() const {
  state_->require_open();
  const Quiet quiet;
  const hid_t group = state_->group.id();
  const Handle properties(H5Gget_create_plist(group), H5Pclose);
  unsigned order = 0;
  H5Pget_link_creation_order(properties.id(), &order);
  const H5_index_t index = (order & H5P_CRT_ORDER_TRACKED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  H5G_info_t info;
  if (H5Gget_info(group, &info) < 0) state_->fail("list", "");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto length = H5Lget_name_by_idx(group, ".", index, H5_ITER_INC, i, nullptr, 0, H5P_DEFAULT);
    if (length < 0) state_->fail("list", "");
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    H5Lget_name_by_idx(group, ".", index, H5_ITER_INC, i, name.data(), name.size(), H5P_DEFAULT);
    name.pop_back();
    names.push_back(std::move(name));
  }
  return names;
}

template <typename T>
void Group::write(const std::string& name, const std::vector<T>& values, const Shape& shape) {
  if (product(shape) != values.size())
    throw InternalError(state_->object(name) + ": shape and number of values differ");
  const Quiet quiet;
  state_->reserve(values.size() * sizeof(T), "write dataset", name);
  const Handle space = space_of(shape);
  const Handle properties = dataset_properties();
  if (values.size() * sizeof(T) > kCompressFromBytes) compress(properties, chunk_of(shape, sizeof(T)));
  const Handle dataset(H5Dcreate2(state_->group.id(), name.c_str(), native_type<T>(), space.id(), H5P_DEFAULT,
                                  properties.id(), H5P_DEFAULT),
                       H5Dclose);
  if (!dataset.valid()) state_->fail("create dataset", name);
  if (values.empty()) return;
  // Flushed here, because an error at closing could no longer be told from one in another dataset.
  if (H5Dwrite(dataset.id(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0 ||
      H5Dflush(dataset.id()) < 0)
    state_->give_up("write dataset", name);
}

void Group::write_strings(const std::string& name, const std::vector<std::string>& values) {
  const Quiet quiet;
  constexpr std::uint64_t kReferenceBytes = 64;  // a text's address, length and share of its heap
  std::uint64_t bytes = 0;
  for (const std::string& value : values) bytes += value.size() + kReferenceBytes;
  state_->reserve(bytes, "write dataset", name);
  const Handle type = text_type();
  const Handle space = space_of({values.size()});
  const Handle properties = dataset_properties();
  const Handle dataset(H5Dcreate2(state_->group.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT,
                                  properties.id(), H5P_DEFAULT),
                       H5Dclose);
  if (!dataset.valid()) state_->fail("create dataset", name);
  if (values.empty()) return;
  std::vector<const char*> pointers;
  for (const std::string& value : values) pointers.push_back(value.c_str());
  if (H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0 ||
      H5Dflush(dataset.id()) < 0)
    state_->give_up("write dataset", name);
}

template <typename T>
std::vector<T> Group::read(const std::string& name, Shape* shape) const {
  const Quiet quiet;
  const Handle dataset = state_->open_dataset(name);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.id());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) state_->refuse("read", name, "it does not hold numbers");
  const Shape found = state_->checked_shape(dataset, name);
  std::vector<T> values(product(found));
  if (!values.empty()) {
    const Handle transfer = transfer_properties();
    if (H5Dread(dataset.id(), native_type<T>(), H5S_ALL, H5S_ALL, transfer.id(), values.data()) < 0)
      state_->fail("read dataset", name);
  }
  if (shape != nullptr) *shape = found;
  return values;
}

template <typename T>
std::vector<T> Group::read_part(const std::string& name, std::uint64_t offset, std::uint64_t count) const {
  const Quiet quiet;
  const Handle dataset = state_->open_dataset(name);
  const Shape found = state_->checked_shape(dataset, name);
  if (found.size() != 1) state_->refuse("read", name, "it is not one-dimensional");
  const std::uint64_t first = std::min(offset, found[0]);
  const hsize_t start = first;
  const hsize_t length = std::min(count, found[0] - first);
  std::vector<T> values(length);
  if (values.empty()) return values;
  const Handle file_space(H5Dget_space(dataset.id()), H5Sclose);
  const Handle memory_space = space_of({length});
  const Handle transfer = transfer_properties();
  if (H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, &start, nullptr, &length, nullptr) < 0 ||
      H5Dread(dataset.id(), native_type<T>(), memory_space.id(), file_space.id(), transfer.id(),
              values.data()) < 0)
    state_->fail("read dataset", name);
  return values;
}

Shape Group::shape(const std::string& name) const {
  const Quiet quiet;
  return state_->checked_shape(state_->open_dataset(name), name);
}

std::vector<std::string> Group::read_strings(const std::string& name) const {
  const Quiet quiet;
  const Handle dataset = state_->open_dataset(name);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) <= 0)
    state_->refuse("read", name, "it does not hold text of variable length");
  const Shape shape = state_->checked_shape(dataset, name);
  std::vector<char*> pointers(product(shape), nullptr);
  if (pointers.empty()) return {};
  // The character set must be the file's own: HDF5 does not convert between ASCII and UTF-8.
  if (H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0)
    state_->fail("read dataset", name);
  std::vector<std::string> values;
  for (const char* text : pointers) values.emplace_back(text == nullptr ? "" : text);
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, pointers.data());
  return values;
}

void Group::set_attribute(const std::string& member, const std::string& name, const std::string& value) {
  const Quiet quiet;
  state_->write_text_attribute(member, name, value.c_str());
}

void Group::set_attribute(const std::string& member, const std::string& name, double value) {
  const Quiet quiet;
  state_->write_attribute(member, name, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, &value);
}

void Group::set_attribute(const std::string& member, const std::string& name, std::int64_t value) {
  const Quiet quiet;
  state_->write_attribute(member, name, H5T_NATIVE_INT64, H5T_NATIVE_INT64, &value);
}

std::vector<std::string> Group::attributes(const std::string& member) const {
  const Quiet quiet;
  const Handle owner = state_->attribute_owner(member);
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  if (H5Aiterate2(owner.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0)
    state_->fail("list the attributes of", member);
  return names;
}

bool Group::has_attribute(const std::string& member, const std::string& name) const {
  const Quiet quiet;
  return H5Aexists(state_->attribute_owner(member).id(), name.c_str()) > 0;
}

std::string Group::string_attribute(const std::string& member, const std::string& name) const {
  const Quiet quiet;
  const Handle attribute = state_->open_attribute(member, name, true);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  if (H5Tis_variable_str(type.id()) <= 0) {  // fixed length, as other programs write it
    std::string text(H5Tget_size(type.id()), '\0');
    if (H5Aread(attribute.id(), type.id(), text.data()) < 0)
      state_->fail("read attribute " + name + " of", member);
    return text.substr(0, text.find('\0'));
  }
  char* text = nullptr;
  if (H5Aread(attribute.id(), type.id(), &text) < 0) state_->fail("read attribute " + name + " of", member);
  const std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  return value;
}

double Group::double_attribute(const std::string& member, const std::string& name) const {
  const Quiet quiet;
  const Handle attribute = state_->open_attribute(member, name, false);
  double value = 0.0;
  if (H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value) < 0)
    state_->fail("read attribute " + name + " of", member);
  return value;
}

std::int64_t Group::integer_attribute(const std::string& member, const std::string& name) const {
  const Quiet quiet;
  const Handle attribute = state_->open_attribute(member, name, false);
  std::int64_t value = 0;
  if (H5Aread(attribute.id(), H5T_NATIVE_INT64, &value) < 0)
    state_->fail("read attribute " + name + " of", member);
  return value;
}

template <typename T>
void Group::create_stream(const std::string& name, std::uint64_t chunk) {
  const Quiet quiet;
  state_->life->stream_bytes += kChunkCacheBytes + chunk * sizeof(T);
  state_->reserve(0, "create dataset", name);
  const hsize_t none = 0, unlimited = H5S_UNLIMITED;
  const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
  const Handle properties = dataset_properties();
  compress(properties, {chunk});
  Handle dataset(H5Dcreate2(state_->group.id(), name.c_str(), native_type<T>(), space.id(), H5P_DEFAULT,
                            properties.id(), H5P_DEFAULT),
                 H5Dclose);
  if (!dataset.valid()) state_->fail("create dataset", name);
  state_->streams.insert_or_assign(name, std::move(dataset));
}

template <typename T>
void Group::append(const std::string& name, const std::vector<T>& values) {
  if (values.empty()) return;
  const Quiet quiet;
  state_->reserve(values.size() * sizeof(T), "append to dataset", name);
  auto found = state_->streams.find(name);
  if (found == state_->streams.end()) found = state_->streams.emplace(name, state_->open_dataset(name)).first;
  const hid_t dataset = found->second.id();
  hsize_t start = 0;
  {
    const Handle space(H5Dget_space(dataset), H5Sclose);
    if (H5Sget_simple_extent_ndims(space.id()) != 1)
      state_->refuse("append to", name, "it is not one-dimensional");
    H5Sget_simple_extent_dims(space.id(), &start, nullptr);
  }
  const hsize_t count = values.size(), end = start + count;
  if (H5Dset_extent(dataset, &end) < 0) state_->give_up("extend dataset", name);
  const Handle file_space(H5Dget_space(dataset), H5Sclose);
  const Handle memory_space = space_of({count});
  if (H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, &start, nullptr, &count, nullptr) < 0 ||
      H5Dwrite(dataset, native_type<T>(), memory_space.id(), file_space.id(), H5P_DEFAULT, values.data()) < 0)
    state_->give_up("append to dataset", name);
}

#define SCINTRAY_H5_VALUE(T)                                                                           \
  template void Group::write<T>(const std::string&, const std::vector<T>&, const Shape&);              \
  template std::vector<T> Group::read<T>(const std::string&, Shape*) const;                            \
  template std::vector<T> Group::read_part<T>(const std::string&, std::uint64_t, std::uint64_t) const; \
  template void Group::create_stream<T>(const std::string&, std::uint64_t);                            \
  template void Group::append<T>(const std::string&, const std::vector<T>&);
SCINTRAY_H5_VALUE(double)
SCINTRAY_H5_VALUE(float)
SCINTRAY_H5_VALUE(std::int32_t)
SCINTRAY_H5_VALUE(std::uint32_t)
SCINTRAY_H5_VALUE(std::int64_t)
SCINTRAY_H5_VALUE(std::uint64_t)
SCINTRAY_H5_VALUE(std::uint8_t)
#undef SCINTRAY_H5_VALUE

namespace {

Handle access_properties() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(properties.id(), H5F_CLOSE_STRONG);
  // Some cluster file systems have no locks; a result there is as readable as anywhere.
  H5Pset_file_locking(properties.id(), true, true);
  return properties;
}

}  // namespace

namespace {

/// Cuts off the disk space taken in advance; that HDF5 opens the file shows that it is whole.
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
  if (::access(path.c_str(), R_OK) != 0)
    throw SystemError(path.string() + ": cannot read: " + std::strerror(errno));
  const Quiet quiet;
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw wrong("this is not an HDF5 file", "name a file that ScintRay wrote, or make it again");
  File file;
  file.state_->path = path;
  const Handle access = access_properties();
  file.state_->life->file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id());
  if (file.state_->life->file < 0)
    throw wrong("this HDF5 file is damaged: " + hdf5_reason(),
                "copy it again from where it was made, or run again");
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
  sync_to_disk(state_->temporary, state_->path);
  std::error_code error;
  std::filesystem::rename(state_->temporary, state_->path, error);
  if (error)
    throw SystemError(state_->path.string() + ": cannot put the finished file in place: " + error.message());
  state_->temporary.clear();
}

const std::filesystem::path& File::path() const { return state_->path; }

}  // namespace scintray::h5
