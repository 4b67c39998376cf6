#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <type_traits>

#include "scintray/core/detail/h5_internal.hpp"
#include "scintray/core/error.hpp"

namespace scintray::core::h5 {

namespace {

constexpr std::uint64_t kCompressFromBytes = 4096;
constexpr std::uint64_t kChunkBytes = 1 << 20;
/// Level 4 makes the tables of a million events 3 % smaller and takes 40 % more time.
constexpr unsigned kDeflateLevel = 1;
constexpr std::uint64_t kChunkCacheBytes = 1 << 20;  ///< HDF5's default for each dataset

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
  const Handle inside = inside_properties(H5P_GROUP_ACCESS);
  Handle opened(H5Gopen2(state_->group.id(), name.c_str(), inside.id()), H5Gclose);
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

bool Group::has_dataset(const std::string& name) const {
  if (!has(name)) return false;
  const Quiet quiet;
  const Handle object(H5Oopen(state_->group.id(), name.c_str(), H5P_DEFAULT), H5Oclose);
  return object.valid() && H5Iget_type(object.id()) == H5I_DATASET;
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
  Handle dataset(H5Dcreate2(state_->group.id(), name.c_str(), native_type<T>(), space.id(), H5P_DEFAULT,
                            properties.id(), H5P_DEFAULT),
                 H5Dclose);
  if (!dataset.valid()) state_->fail("create dataset", name);
  if (values.empty()) return;
  if (H5Dwrite(dataset.id(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0 ||
      !dataset.close())
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
  Handle dataset(H5Dcreate2(state_->group.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT,
                            properties.id(), H5P_DEFAULT),
                 H5Dclose);
  if (!dataset.valid()) state_->fail("create dataset", name);
  if (values.empty()) return;
  std::vector<const char*> pointers;
  for (const std::string& value : values) pointers.push_back(value.c_str());
  if (H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0 ||
      !dataset.close())
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
  if (found.size() != 1 && found.size() != 2)
    state_->refuse("read", name, "it is not a list of values or rows");
  const std::uint64_t first = std::min(offset, found[0]);
  Shape start(found.size(), 0), extent = found;
  start[0] = first;
  extent[0] = std::min(count, found[0] - first);
  std::vector<T> values(product(extent));
  if (values.empty()) return values;
  const std::vector<hsize_t> from(start.begin(), start.end()), size(extent.begin(), extent.end());
  const Handle file_space(H5Dget_space(dataset.id()), H5Sclose);
  const Handle memory_space = space_of({values.size()});
  const Handle transfer = transfer_properties();
  if (H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr) < 0 ||
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

template <typename T>
void Group::create_stream(const std::string& name, std::uint64_t chunk, std::uint64_t width) {
  const Quiet quiet;
  const std::uint64_t row = std::max<std::uint64_t>(width, 1);
  state_->life->stream_bytes += kChunkCacheBytes + chunk * row * sizeof(T);
  state_->reserve(0, "create dataset", name);
  const std::array<hsize_t, 2> none{0, width}, unlimited{H5S_UNLIMITED, width};
  const Handle space(H5Screate_simple(width > 0 ? 2 : 1, none.data(), unlimited.data()), H5Sclose);
  const Handle properties = dataset_properties();
  compress(properties, width > 0 ? std::vector<hsize_t>{chunk, width} : std::vector<hsize_t>{chunk});
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
  std::array<hsize_t, 2> extent{0, 0};
  int dimensions = 0;
  {
    const Handle space(H5Dget_space(dataset), H5Sclose);
    dimensions = H5Sget_simple_extent_ndims(space.id());
    if (dimensions != 1 && dimensions != 2)
      state_->refuse("append to", name, "it is not a list of values or rows");
    H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
  }
  const std::uint64_t width = dimensions == 2 ? extent[1] : 1;
  if (width == 0 || values.size() % width != 0)
    state_->refuse("append to", name, "the values are not whole rows");
  const std::array<hsize_t, 2> start{extent[0], 0}, count{values.size() / width, extent[1]};
  extent[0] += count[0];
  if (H5Dset_extent(dataset, extent.data()) < 0) state_->give_up("extend dataset", name);
  const Handle file_space(H5Dget_space(dataset), H5Sclose);
  const Handle memory_space = space_of({values.size()});
  if (H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) <
          0 ||
      H5Dwrite(dataset, native_type<T>(), memory_space.id(), file_space.id(), H5P_DEFAULT, values.data()) < 0)
    state_->give_up("append to dataset", name);
}

void Group::make_scale(const std::string& name) {
  const Quiet quiet;
  state_->reserve(0, "make a dimension scale of", name);
  if (H5DSset_scale(state_->open_dataset(name).id(), name.c_str()) < 0)
    state_->give_up("make a dimension scale of", name);
}

void Group::attach_scale(const std::string& name, unsigned dimension, const Group& owner,
                         const std::string& scale) {
  const Quiet quiet;
  state_->reserve(0, "attach a dimension scale to", name);
  const auto found = state_->streams.find(name);
  const auto attached = [&](hid_t dataset) {
    return H5DSattach_scale(dataset, owner.state_->open_dataset(scale).id(), dimension) >= 0;
  };
  const bool done = found != state_->streams.end() ? attached(found->second.id())
                                                   : attached(state_->open_dataset(name).id());
  if (!done) state_->give_up("attach a dimension scale to", name);
}

bool Group::has_scale(const std::string& name, unsigned dimension) const {
  const Quiet quiet;
  const Handle dataset = state_->open_dataset(name);
  return H5DSis_scale(dataset.id()) > 0 || H5DSget_num_scales(dataset.id(), dimension) > 0;
}

#define SCINTRAY_H5_VALUE(T)                                                                           \
  template void Group::write<T>(const std::string&, const std::vector<T>&, const Shape&);              \
  template std::vector<T> Group::read<T>(const std::string&, Shape*) const;                            \
  template std::vector<T> Group::read_part<T>(const std::string&, std::uint64_t, std::uint64_t) const; \
  template void Group::create_stream<T>(const std::string&, std::uint64_t, std::uint64_t);             \
  template void Group::append<T>(const std::string&, const std::vector<T>&);
SCINTRAY_H5_VALUE(double)
SCINTRAY_H5_VALUE(float)
SCINTRAY_H5_VALUE(std::int32_t)
SCINTRAY_H5_VALUE(std::uint32_t)
SCINTRAY_H5_VALUE(std::int64_t)
SCINTRAY_H5_VALUE(std::uint64_t)
SCINTRAY_H5_VALUE(std::uint8_t)
#undef SCINTRAY_H5_VALUE

}  // namespace scintray::core::h5
