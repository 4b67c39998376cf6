#pragma once
/// A thin, exception-safe layer over the HDF5 C library.
///
/// Files are written under a temporary name beside the target and renamed when committed, so that a partly
/// written file is never taken for a complete one. A committed file ends in a seal, the digest of all bytes
/// before it, which HDF5 ignores: a file with an intact seal is what was written. Other files are read to
/// their end in a child process before they are opened, since HDF5 crashes on some that are damaged.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace scintray::core::h5 {

/// Shape of a dataset, slowest dimension first; empty for a scalar.
using Shape = std::vector<std::uint64_t>;

/// The line behind the end of an HDF5 file that holds the SHA-256 of all bytes before it.
enum class Seal {
  none,    ///< written by another program or by ScintRay 0.1, or changed by another program
  intact,  ///< the bytes are those that were written
  broken,
};
/// The seal of a file; `none` for a file that does not exist. Reads the whole file.
Seal seal_of(const std::filesystem::path& path);

/// A group of a file, usable during the lifetime of its File.
/// T below is one of: double, float, std::int32_t, std::uint32_t, std::int64_t, std::uint64_t,
/// std::uint8_t. Every member throws SystemError with file, object and reason.
class Group {
 public:
  Group create_group(const std::string& name);
  Group open_group(const std::string& name) const;
  bool has(const std::string& name) const;
  /// True for a member that is a dataset.
  bool has_dataset(const std::string& name) const;
  /// Names of members (groups and datasets), in creation order.
  std::vector<std::string> members() const;

  /// Writes a dataset of `shape` (product = values.size()); compressed with deflate when larger
  /// than a few kilobytes.
  template <typename T>
  void write(const std::string& name, const std::vector<T>& values, const Shape& shape);
  template <typename T>
  void write(const std::string& name, const std::vector<T>& values) {
    write(name, values, Shape{values.size()});
  }
  void write_strings(const std::string& name, const std::vector<std::string>& values);

  /// Reads a whole dataset, converting numbers; `shape` receives its shape when given. The size is
  /// checked against the file's before anything is allocated.
  template <typename T>
  std::vector<T> read(const std::string& name, Shape* shape = nullptr) const;
  std::vector<std::string> read_strings(const std::string& name) const;
  /// At most `count` values of a one-dimensional dataset from `offset` on; fewer at its end. Of a
  /// two-dimensional dataset: `count` rows, one after the other.
  template <typename T>
  std::vector<T> read_part(const std::string& name, std::uint64_t offset, std::uint64_t count) const;
  /// Shape of a dataset.
  Shape shape(const std::string& name) const;

  /// Attributes of a member ("" for the group itself).
  void set_attribute(const std::string& member, const std::string& name, const std::string& value);
  void set_attribute(const std::string& member, const std::string& name, double value);
  void set_attribute(const std::string& member, const std::string& name, std::int64_t value);
  std::vector<std::string> attributes(const std::string& member) const;
  bool has_attribute(const std::string& member, const std::string& name) const;
  std::string string_attribute(const std::string& member, const std::string& name) const;
  double double_attribute(const std::string& member, const std::string& name) const;
  std::int64_t integer_attribute(const std::string& member, const std::string& name) const;

  /// Creates an extendible dataset, chunked; append() grows it. One-dimensional, or with a width above 0
  /// two-dimensional, of rows of that many values.
  template <typename T>
  void create_stream(const std::string& name, std::uint64_t chunk = 65536, std::uint64_t width = 0);
  /// `values` are whole rows when the dataset has a width.
  template <typename T>
  void append(const std::string& name, const std::vector<T>& values);

  /// Marks a one-dimensional dataset as a dimension scale (HDF5 Dimension Scale Specification 1.0): readers
  /// of netCDF, as xarray, take its name as that of a dimension, and its values as coordinates.
  void make_scale(const std::string& name);
  /// Attaches a scale of `owner` to a dimension of a dataset, from 0. A dataset that is itself a scale has
  /// none.
  void attach_scale(const std::string& name, unsigned dimension, const Group& owner,
                    const std::string& scale);
  /// True when a dimension of a dataset has a scale, or the dataset is one.
  bool has_scale(const std::string& name, unsigned dimension) const;

 private:
  friend class File;
  struct State;
  std::shared_ptr<State> state_;
};

class File {
 public:
  /// Creates a file under a temporary name; `commit` renames it. Without a commit the temporary file is
  /// removed. Throws InputError when `path` is something else than an HDF5 file (require_replaceable).
  static File create(const std::filesystem::path& path);
  /// Opens for reading. Throws InputError when the file is missing, is not HDF5, is damaged, or refers to
  /// other files (external links, external storage, virtual datasets).
  static File open(const std::filesystem::path& path);
  File(File&&) noexcept;
  File& operator=(File&&) noexcept;
  ~File();

  Group root() const;
  void flush();
  /// Closes a created file and renames it over `path`.
  void commit();
  const std::filesystem::path& path() const;

 private:
  File();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace scintray::core::h5
