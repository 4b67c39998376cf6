// Whether the bytes of an HDF5 file may be handed to the HDF5 library of this process.
#include <fcntl.h>
#include <malloc.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <deque>
#include <fstream>
#include <functional>
#include <mutex>
#include <set>
#include <stdexcept>
#include <tuple>

#include "scintray/core/child_process.hpp"
#include "scintray/core/detail/h5_internal.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/sha256.hpp"

namespace scintray::core::h5 {

namespace {

/// Begins the line that follows HDF5's own end of a file; then come the digest and a line feed.
constexpr std::string_view kSealMark = "\nScintRay seal, SHA-256: ";
constexpr std::size_t kDigestDigits = 64;
constexpr std::size_t kSealBytes = kSealMark.size() + kDigestDigits + 1;

/// Memory of the child that reads a file without a seal, beyond what this process has.
constexpr std::size_t kMostBytes = std::size_t{512} << 20;
/// Processor time of that child: at least 5 s, and a second for each 20 MB.
constexpr unsigned kLeastSeconds = 5;
constexpr std::uint64_t kBytesPerSecond = 20'000'000;

/// The end of what is found of a file that refers to others.
constexpr std::string_view kNotFollowed = ", which is not followed";

constexpr std::uint64_t kSlabBytes = std::uint64_t{4} << 20;
constexpr std::size_t kDeepestGroup = 64;
constexpr std::size_t kMostObjects = 1'000'000;

/// The digest of the first `size` bytes of a file.
std::string digest_of(std::ifstream& file, std::uint64_t size) {
  Sha256 hash;
  std::array<char, 1 << 16> part{};
  while (size > 0 && file) {
    file.read(part.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(size, part.size())));
    const auto got = static_cast<std::size_t>(file.gcount());
    hash.add({part.data(), got});
    size -= got;
  }
  return size == 0 ? hash.hex() : "";
}

/// What makes a file unfit to be read, found in the child.
struct Unsound : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads everything in a file once: groups, attributes, datasets of numbers and text.
class Examination {
 public:
  Examination(hid_t file, const TextHeaps& heaps) : file_(file), heaps_(heaps) {}

  void run() const {
    const Handle root(H5Gopen2(file_, "/", H5P_DEFAULT), H5Gclose);
    if (!root.valid()) unreadable("/");
    std::set<haddr_t> seen;
    group(root.id(), "", 0, seen);
  }

 private:
  [[noreturn]] static void unreadable(const std::string& name) {
    throw Unsound(in_quotes(name) + " cannot be read: " + hdf5_reason());
  }

  void group(hid_t id, const std::string& name, std::size_t depth, std::set<haddr_t>& seen) const {
    if (depth > kDeepestGroup) throw Unsound("its groups are nested too deeply");
    attributes(id, name);
    H5G_info_t info;
    if (H5Gget_info(id, &info) < 0) unreadable(name);
    for (hsize_t i = 0; i < info.nlinks; ++i) {
      const auto length = H5Lget_name_by_idx(id, ".", H5_INDEX_NAME, H5_ITER_INC, i, nullptr, 0, H5P_DEFAULT);
      if (length < 0) unreadable(name);
      std::string link(static_cast<std::size_t>(length) + 1, '\0');
      if (H5Lget_name_by_idx(id, ".", H5_INDEX_NAME, H5_ITER_INC, i, link.data(), link.size(), H5P_DEFAULT) <
          0)
        unreadable(name);
      link.pop_back();
      member(id, link, name + "/" + link, depth, seen);
    }
  }

  void member(hid_t parent, const std::string& link, const std::string& name, std::size_t depth,
              std::set<haddr_t>& seen) const {
    H5L_info_t info;
    if (H5Lget_info(parent, link.c_str(), &info, H5P_DEFAULT) < 0) unreadable(name);
    if (info.type == H5L_TYPE_SOFT) return;  // what it names in this file is reached by its own link
    if (info.type != H5L_TYPE_HARD)
      throw Unsound(in_quotes(name) + " is a link to another file" + std::string(kNotFollowed));
    const Handle object(H5Oopen(parent, link.c_str(), H5P_DEFAULT), H5Oclose);
    H5O_info_t about;
    if (!object.valid() || H5Oget_info2(object.id(), &about, H5O_INFO_BASIC) < 0) unreadable(name);
    if (!seen.insert(about.addr).second) return;
    if (seen.size() > kMostObjects) throw Unsound("it has more than a million objects");
    if (about.type == H5O_TYPE_GROUP) return group(object.id(), name, depth + 1, seen);
    attributes(object.id(), name);
    if (about.type == H5O_TYPE_DATASET) dataset(object, name);
  }

  void attributes(hid_t owner, const std::string& name) const {
    struct Context {
      const TextHeaps& heaps;
      haddr_t header;
      std::string without_texts;  ///< the attribute that refers to texts that are not there
    };
    const auto read = [](hid_t object, const char* attribute, const H5A_info_t*, void* data) -> herr_t {
      Context& context = *static_cast<Context*>(data);
      const Handle opened(H5Aopen(object, attribute, H5P_DEFAULT), H5Aclose);
      if (!opened.valid()) return -1;
      const Handle space(H5Aget_space(opened.id()), H5Sclose), type(H5Aget_type(opened.id()), H5Tclose);
      const H5T_class_t kind = H5Tget_class(type.id());
      const hssize_t values = H5Sget_simple_extent_npoints(space.id());
      if (values < 0 || kind == H5T_NO_CLASS) return -1;
      if (kind != H5T_INTEGER && kind != H5T_FLOAT && kind != H5T_STRING) return 0;  // is never read
      const auto count = static_cast<std::uint64_t>(values);
      if (kind == H5T_STRING && H5Tis_variable_str(type.id()) > 0 &&
          !context.heaps.have_attribute(context.header, attribute, count)) {
        context.without_texts = attribute;
        return -1;
      }
      return read_values(count, type, space,
                         [&](hid_t as, void* to) { return H5Aread(opened.id(), as, to); });
    };
    H5O_info_t about;
    if (H5Oget_info2(owner, &about, H5O_INFO_BASIC) < 0) unreadable(name);
    Context context{heaps_, about.addr, {}};
    if (H5Aiterate2(owner, H5_INDEX_NAME, H5_ITER_INC, nullptr, read, &context) >= 0) return;
    const std::string object = name.empty() ? "/" : name;
    if (!context.without_texts.empty())
      throw Unsound("attribute " + in_quotes(context.without_texts) + " of " + in_quotes(object) +
                    " refers to texts that are not in the file");
    unreadable(object + " (its attributes)");
  }

  void dataset(const Handle& object, const std::string& name) const {
    require_own_storage(object, name);
    const Handle space(H5Dget_space(object.id()), H5Sclose), type(H5Dget_type(object.id()), H5Tclose);
    const int dimensions = H5Sget_simple_extent_ndims(space.id());
    if (dimensions < 0) unreadable(name);
    std::vector<hsize_t> extent(static_cast<std::size_t>(dimensions));
    H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
    if (H5Sget_simple_extent_type(space.id()) == H5S_NULL) return;
    if (!fits_storage(object, {extent.begin(), extent.end()}))
      throw Unsound(in_quotes(name) + " states a shape that does not fit what is stored for it");
    const H5T_class_t kind = H5Tget_class(type.id());
    if (kind == H5T_NO_CLASS) unreadable(name);
    const auto count = static_cast<std::uint64_t>(H5Sget_simple_extent_npoints(space.id()));
    if (kind == H5T_STRING) {
      if (H5Tis_variable_str(type.id()) > 0) require_texts(object, count, name);
      if (read_values(count, type, space, [&](hid_t as, void* to) {
            return H5Dread(object.id(), as, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
          }) < 0)
        unreadable(name);
    } else if (kind == H5T_INTEGER || kind == H5T_FLOAT) {
      numbers(object, space, extent, H5Tget_size(type.id()), name);
    }
  }

  static void require_own_storage(const Handle& dataset, const std::string& name) {
    const std::string foreign = foreign_storage(dataset);
    if (!foreign.empty()) throw Unsound(in_quotes(name) + " " + foreign);
  }

  /// Reads numbers block by block, each of about kSlabBytes.
  static void numbers(const Handle& dataset, const Handle& space, const std::vector<hsize_t>& extent,
                      std::size_t value_bytes, const std::string& name) {
    std::vector<hsize_t> block = extent;
    double bytes = static_cast<double>(value_bytes);
    for (const hsize_t length : block) bytes *= static_cast<double>(length);
    if (bytes == 0.0) return;
    for (hsize_t& length : block)
      while (bytes > kSlabBytes && length > 1) {
        bytes *= static_cast<double>((length + 1) / 2) / static_cast<double>(length);
        length = (length + 1) / 2;
      }
    std::vector<hsize_t> start(extent.size(), 0);
    std::vector<std::uint64_t> values;
    for (bool more = true; more;) {
      std::vector<hsize_t> count(extent.size());
      hsize_t size = 1;
      for (std::size_t k = 0; k < extent.size(); ++k)
        size *= count[k] = std::min(block[k], extent[k] - start[k]);
      values.resize(size);
      const Handle memory(H5Screate_simple(1, &size, nullptr), H5Sclose);
      if (!extent.empty() &&
          H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0)
        unreadable(name);
      // As 8-byte floating numbers, which every integer and floating type converts to.
      if (H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, values.data()) < 0)
        unreadable(name);
      more = false;
      for (std::size_t k = extent.size(); k-- > 0 && !more;) {
        start[k] += block[k];
        more = start[k] < extent[k];
        if (!more) start[k] = 0;
      }
    }
  }

  /// Reads `count` numbers or texts with `read(type, to)`.
  template <typename Read>
  static herr_t read_values(std::uint64_t count, const Handle& type, const Handle& space, const Read& read) {
    if (count == 0) return 0;
    if (H5Tget_class(type.id()) != H5T_STRING) {
      std::vector<double> values(count);
      return read(H5T_NATIVE_DOUBLE, values.data());
    }
    if (H5Tis_variable_str(type.id()) <= 0) {
      std::vector<char> text(count * H5Tget_size(type.id()));
      return read(type.id(), text.data());
    }
    std::vector<char*> texts(count, nullptr);
    const herr_t status = read(type.id(), texts.data());
    std::size_t length = 0;  // every character is read
    for (const char* text : texts) length += text == nullptr ? 0 : std::strlen(text);
    H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, texts.data());
    return length > kMostBytes ? -1 : status;
  }

  /// The references of a dataset to its texts lie in one place, unless it was compressed.
  void require_texts(const Handle& dataset, std::uint64_t count, const std::string& name) const {
    const haddr_t at = H5Dget_offset(dataset.id());
    if (at != HADDR_UNDEF && !heaps_.have(at, count))
      throw Unsound(in_quotes(name) + " refers to texts that are not in the file");
  }

  hid_t file_;
  const TextHeaps& heaps_;
};

constexpr const char* kSound = "sound";

/// kSound, or what is wrong with a file. Runs in the child.
std::string examine(const std::filesystem::path& path) {
  try {
    // HDF5 reads memory that it has not set where a text refers to what its heap does not have, and that was
    // not found. Set to what is no address, that ends this process rather than, sometimes, the next.
    mallopt(M_PERTURB, 0x55);
    const TextHeaps heaps(path);
    if (heaps.endless()) return "an object in its heap of texts has no length";
    const Quiet quiet;
    const Handle access = access_properties();
    const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
    if (!file.valid()) return hdf5_reason();
    Examination(file.id(), heaps).run();
    return kSound;
  } catch (const Unsound& found) {
    return found.what();
  } catch (const std::exception&) {
    return "reading it takes more memory than its content could need";
  }
}

/// Files that were found sound, recognised by place, size and times; so a command that opens a file for each
/// block of its rows examines it once.
class SoundFiles {
 public:
  using Key = std::tuple<dev_t, ino_t, off_t, time_t, long, time_t, long>;
  static Key key_of(const struct stat& status) {
    return {status.st_dev,          status.st_ino,         status.st_size,        status.st_mtim.tv_sec,
            status.st_mtim.tv_nsec, status.st_ctim.tv_sec, status.st_ctim.tv_nsec};
  }
  bool contains(const Key& key) {
    const std::scoped_lock lock(mutex_);
    return std::find(keys_.begin(), keys_.end(), key) != keys_.end();
  }
  void add(const Key& key) {
    constexpr std::size_t kMostKept = 256;
    const std::scoped_lock lock(mutex_);
    keys_.push_back(key);
    if (keys_.size() > kMostKept) keys_.pop_front();
  }

 private:
  std::mutex mutex_;
  std::deque<Key> keys_;
};

SoundFiles& sound_files() {
  static SoundFiles files;
  return files;
}

[[noreturn]] void refuse_damaged(const std::filesystem::path& path, const std::string& found) {
  throw InputError({{path.string()},
                    "this HDF5 file is damaged: " + found,
                    "copy it again from where it was made, or make it again"});
}

/// Throws InputError for what an examination found: damage, or references to other files.
[[noreturn]] void refuse_unsound(const std::filesystem::path& path, const std::string& found) {
  if (!found.ends_with(kNotFollowed)) refuse_damaged(path, found);
  throw InputError({{path.string()},
                    "this HDF5 file is not complete by itself: " + found,
                    "copy what it refers to into one file"});
}

}  // namespace

std::string foreign_storage(const Handle& dataset) {
  const Handle properties(H5Dget_create_plist(dataset.id()), H5Pclose);
  if (!properties.valid()) return "cannot be read: " + hdf5_reason();
  if (H5Pget_layout(properties.id()) == H5D_VIRTUAL)
    return "is a virtual dataset, composed of other files" + std::string(kNotFollowed);
  if (H5Pget_external_count(properties.id()) > 0)
    return "keeps its numbers in another file" + std::string(kNotFollowed);
  return {};
}

void append_seal(const std::filesystem::path& path, const std::filesystem::path& name) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream written(path, std::ios::binary);
  const std::string digest = error ? "" : digest_of(written, size);
  if (digest.empty()) throw SystemError(name.string() + ": cannot read back what was written");
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file << kSealMark << digest << '\n' << std::flush;
  if (!file) throw SystemError(name.string() + ": cannot write: " + std::strerror(errno));
}

Seal seal_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error || size < kSealBytes) return Seal::none;
  std::ifstream file(path, std::ios::binary);
  std::string end(kSealBytes, '\0');
  file.seekg(static_cast<std::streamoff>(size - kSealBytes));
  file.read(end.data(), static_cast<std::streamsize>(end.size()));
  if (!file || !end.starts_with(kSealMark)) return Seal::none;
  if (end.back() != '\n') return Seal::broken;
  file.seekg(0);
  const std::string digest = digest_of(file, size - kSealBytes);
  return digest == std::string_view(end).substr(kSealMark.size(), kDigestDigits) ? Seal::intact
                                                                                 : Seal::broken;
}

void require_sound(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    throw SystemError(path.string() + ": cannot read: " + std::strerror(errno));
  const SoundFiles::Key key = SoundFiles::key_of(status);
  if (sound_files().contains(key)) return;
  switch (seal_of(path)) {
    case Seal::intact:
      break;
    case Seal::broken:
      refuse_damaged(path, "its content is not what was written, by the digest at its end");
    case Seal::none: {
      const auto seconds =
          kLeastSeconds + static_cast<unsigned>(static_cast<std::uint64_t>(status.st_size) / kBytesPerSecond);
      const ChildAnswer answer = run_in_child([&] { return examine(path); }, kMostBytes, seconds);
      if (!answer.trouble.empty())
        refuse_damaged(path, "HDF5 cannot read it to its end, in a process of its own " + answer.trouble);
      if (answer.bytes != kSound) refuse_unsound(path, answer.bytes);
    }
  }
  // A file just written could change again without changing its times, which have the grain of the system's
  // clock.
  constexpr time_t kSettled_s = 2;
  if (::time(nullptr) - status.st_ctim.tv_sec >= kSettled_s) sound_files().add(key);
}

}  // namespace scintray::core::h5
