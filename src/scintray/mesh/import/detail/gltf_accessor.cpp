#include "scintray/mesh/import/detail/gltf_accessor.hpp"

#include <cstring>
#include <string>

#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::mesh {
namespace {

/// Where an accessor's elements lie: count elements of `size` bytes, `stride` bytes apart.
struct Elements {
  const unsigned char* data;
  std::size_t count, stride;
};

template <typename T>
const T& at(const std::vector<T>& list, int index, const char* what, const std::filesystem::path& path) {
  if (index < 0 || static_cast<std::size_t>(index) >= list.size()) {
    reject_file(path, std::string(what) + " " + std::to_string(index) + " does not exist in the glTF file",
                "the file is damaged; export it again");
  }
  return list[static_cast<std::size_t>(index)];
}

Elements locate(const tinygltf::Model& model, const tinygltf::Accessor& accessor, int index, std::size_t size,
                const std::filesystem::path& path) {
  const std::string name = "accessor " + std::to_string(index);
  if (accessor.sparse.isSparse) {
    reject_file(path, name + " is sparse, which is not supported for geometry",
                "export without sparse accessors");
  }
  const auto& view = at(model.bufferViews, accessor.bufferView, "buffer view", path);
  const auto& buffer = at(model.buffers, view.buffer, "buffer", path).data;
  const std::size_t stride = view.byteStride == 0 ? size : view.byteStride;
  const std::size_t count = accessor.count;
  const bool fits = view.byteOffset <= buffer.size() && view.byteLength <= buffer.size() - view.byteOffset &&
                    accessor.byteOffset <= view.byteLength && stride >= size && count <= kMostElements &&
                    (count == 0 || (view.byteLength - accessor.byteOffset >= size &&
                                    (count - 1) <= (view.byteLength - accessor.byteOffset - size) / stride));
  if (!fits) {
    reject_file(path, name + " reaches beyond its buffer",
                "the file is cut short or damaged; export it again");
  }
  return {buffer.data() + view.byteOffset + accessor.byteOffset, count, stride};
}

}  // namespace

std::vector<core::Vec3> read_positions(const tinygltf::Model& model, int accessor_index,
                                       const std::filesystem::path& path) {
  const auto& accessor = at(model.accessors, accessor_index, "accessor", path);
  if (accessor.type != TINYGLTF_TYPE_VEC3 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
    reject_file(path, "accessor " + std::to_string(accessor_index) + " of POSITION is not a float VEC3",
                "export without quantised or compressed positions");
  }
  const Elements elements = locate(model, accessor, accessor_index, 3 * sizeof(float), path);
  std::vector<core::Vec3> positions(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i) {
    float xyz[3];
    std::memcpy(xyz, elements.data + i * elements.stride, sizeof xyz);
    positions[i] = core::Vec3(xyz[0], xyz[1], xyz[2]);
  }
  return positions;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor_index,
                                        std::size_t vertices, const std::filesystem::path& path) {
  const auto& accessor = at(model.accessors, accessor_index, "accessor", path);
  std::size_t size = 0;
  if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) size = 1;
  if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) size = 2;
  if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) size = 4;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || size == 0) {
    reject_file(
        path, "accessor " + std::to_string(accessor_index) + " of indices is not an unsigned integer SCALAR",
        "the file is damaged; export it again");
  }
  const Elements elements = locate(model, accessor, accessor_index, size, path);
  std::vector<std::uint32_t> indices(elements.count);
  for (std::size_t i = 0; i < elements.count; ++i) {
    std::uint32_t index = 0;
    for (std::size_t byte = 0; byte < size; ++byte) {  // glTF buffers are little-endian
      index |= static_cast<std::uint32_t>(elements.data[i * elements.stride + byte]) << (8 * byte);
    }
    if (index >= vertices) {
      reject_file(path,
                  "index " + std::to_string(i) + " of accessor " + std::to_string(accessor_index) +
                      " refers to vertex " + std::to_string(index) + " of " + std::to_string(vertices),
                  "the file is damaged; export it again");
    }
    indices[i] = index;
  }
  return indices;
}

}  // namespace scintray::mesh
