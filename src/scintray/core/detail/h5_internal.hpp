#pragma once
/// Shared parts of the HDF5 layer; only core's h5_*.cpp files include this.

#include <hdf5.h>
#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "scintray/core/h5.hpp"

namespace scintray::core::h5 {

/// Switches HDF5's printing to stderr off during its lifetime; its destructor restores the setting.
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

/// Cause of HDF5's latest failure: the deepest entry of its error stack.
std::string hdf5_reason();
/// Message "FILE: cannot ACTION OBJECT: reason", with the reason of HDF5's latest failure.
std::string failure_text(const std::string& file, const std::string& object, const std::string& action);

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
  /// Closes it now. False when that fails: a dataset may then have values that have not reached the file.
  bool close() { return closer_(std::exchange(id_, -1)) >= 0; }
  /// For a file that is already closed, with everything in it.
  void release() { id_ = -1; }

 private:
  hid_t id_;
  Closer closer_;
};

/// HDF5 type of text of any length in UTF-8.
Handle text_type();
/// Creation properties of files and groups: members keep their order, and there are no time stamps, so that
/// equal results are equal files.
Handle creation_order_properties(hid_t kind);

/// Access properties of a file: closed with everything in it, without locks where there are none.
Handle access_properties();

/// Access properties of a group, dataset or object (`kind`) that is opened by its name: links to other files
/// are not followed.
Handle inside_properties(hid_t kind);

/// True when a dataset of that shape can be what is stored for it.
bool fits_storage(const Handle& dataset, const Shape& shape);

/// "keeps its numbers in another file, ...", for a virtual dataset or one with external storage; else empty.
std::string foreign_storage(const Handle& dataset);

/// Appends the digest of a finished file to it (Seal). `name` is for messages. @throws SystemError
void append_seal(const std::filesystem::path& path, const std::filesystem::path& name);

/// Throws InputError for a file that HDF5 cannot be trusted with. What has an intact seal is what this
/// library wrote; any other file is first read to its end in a child process, since HDF5 1.10 crashes, hangs
/// or allocates without bound on some damaged files, and follows links to wherever they point.
void require_sound(const std::filesystem::path& path);

/// Allocates disk space for [from, to) of a file. Returns 0 or an errno value.
int allocate(int descriptor, off_t from, off_t to);

/// State that a file and its groups share: groups may outlive the file.
///
/// HDF5 cannot release a file whose caches it could not write: closing fails, and the process crashes in
/// HDF5's exit handler. So disk space is allocated before HDF5 needs it, and a full disk is detected here.
struct Life {
  hid_t file = -1;  ///< -1 once closed
  bool writing = false;
  std::string failure;             ///< message of the first failed write; nothing is written after it
  std::uint64_t reserved = 0;      ///< bytes of the file known to have disk space
  std::uint64_t stream_bytes = 0;  ///< most that the chunk caches of all streams can hold back

  int descriptor() const;
  /// Allocates disk space for `bytes` more of data and its metadata. Returns 0 or an errno value.
  int reserve(std::uint64_t bytes);
  /// Abandons the file when a write fails all the same: from then on its descriptor refers to memory, which
  /// receives what the caches still hold when the file is closed.
  void give_up(const std::string& message);
  void require_usable(const std::string& name) const;
};

/// The heaps in which a file keeps its texts, before HDF5 reads them: it trusts them and what refers to them
/// (HDF5 1.10). Layout: HDF5 File Format Specification 3.0, section III.E (https://github.com/HDFGroup/hdf5,
/// doxygen/examples/H5.format.html, commit 03a3f5c7). Addresses in a file are from the end of its user block
/// on.
class TextHeaps {
 public:
  explicit TextHeaps(const std::filesystem::path& path);
  ~TextHeaps();
  TextHeaps(const TextHeaps&) = delete;
  TextHeaps& operator=(const TextHeaps&) = delete;

  /// True when HDF5 would not come to an end in a heap of this file. It walks through the objects of a heap
  /// by their sizes and does not check that it moves: an object of no bytes, or one whose end is beyond all
  /// 64-bit numbers, holds it for ever.
  bool endless() const;
  /// Whether `count` references of 16 bytes, from a byte of the file on, are to texts that the heaps have.
  /// HDF5 does not check the number of an object, and copies from wherever it takes it to be.
  bool have(std::uint64_t from, std::uint64_t count) const;
  /// The same of the `count` texts of an attribute of the object whose header has an address. True also where
  /// the header does not hold the attribute itself: those of netCDF-4 with more than eight attributes, in a
  /// heap of their own, are not checked.
  bool have_attribute(std::uint64_t header, const std::string& attribute, std::uint64_t count) const;

 private:
  std::string_view bytes() const;

  void* begin_ = nullptr;  ///< of the file in memory; none when it could not be mapped
  std::size_t size_ = 0;
  std::uint64_t base_ = 0;  ///< size of the user block
};

/// Byte of a file at which the values of an attribute begin; nothing where the header of the object does not
/// hold it itself.
/// @param base    size of the file's user block
/// @param header  address of the object's header, from the end of the user block on
std::optional<std::uint64_t> attribute_values_at(std::string_view bytes, std::uint64_t base,
                                                 std::uint64_t header, const std::string& name);

struct File::State {
  std::filesystem::path path;
  std::filesystem::path temporary;  ///< empty for a file opened for reading
  std::shared_ptr<Life> life = std::make_shared<Life>();

  [[noreturn]] void give_up() const;
};

struct Group::State {
  std::string file;
  std::string name;  ///< path inside the file, "/" for the root
  Handle group{-1, H5Gclose};
  std::map<std::string, Handle> streams;  ///< kept open, so that a chunk is compressed once
  std::shared_ptr<Life> life;

  ~State();
  std::string object(const std::string& member) const;
  [[noreturn]] void fail(const std::string& action, const std::string& member) const;
  /// As fail(), when data accepted before may not have reached the file.
  [[noreturn]] void give_up(const std::string& action, const std::string& member) const;
  [[noreturn]] void refuse(const std::string& action, const std::string& member,
                           const std::string& reason) const;
  void reserve(std::uint64_t bytes, const std::string& action, const std::string& member) const;
  void require_open() const { life->require_usable(file + ": " + name); }

  /// The object that carries attributes: a member or, for "", the group itself.
  Handle attribute_owner(const std::string& member) const;
  Handle open_dataset(const std::string& member) const;
  /// Shape of a dataset, checked against the size of the file.
  Shape checked_shape(const Handle& dataset, const std::string& member) const;
  void write_text_attribute(const std::string& member, const std::string& attribute, const char* text) const;
  void write_attribute(const std::string& member, const std::string& attribute, hid_t file_type,
                       hid_t memory_type, const void* value) const;
  /// An attribute of one value, of text or of a number as requested.
  Handle open_attribute(const std::string& member, const std::string& attribute, bool text) const;
};

}  // namespace scintray::core::h5
