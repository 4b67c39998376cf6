#include "scintray/mesh/import/mesh_format.hpp"

#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>
#include <string>

#include "scintray/core/error.hpp"
#include "scintray/mesh/import/detail/gltf_file.hpp"
#include "scintray/mesh/import/file_checks.hpp"
#include "scintray/mesh/import/raw_mesh.hpp"

namespace scintray::mesh {
namespace {

/// Location of an accessor's elements: count elements of `size` bytes, `stride` bytes apart.
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

/// Vertex positions. Throws InputError naming `path` unless the accessor is a dense float VEC3 that
/// lies wholly in its buffer.
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

/// Vertex indices. Throws InputError unless the accessor is a dense unsigned integer SCALAR that lies
/// wholly in its buffer and every index is below `vertices`.
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

Eigen::Affine3d node_transform(const tinygltf::Node& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (node.matrix.size() == 16) {
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());  // both column-major
    return transform;
  }
  if (node.translation.size() == 3) {
    transform.translate(core::Vec3(node.translation[0], node.translation[1], node.translation[2]));
  }
  if (node.rotation.size() == 4) {
    const Eigen::Quaterniond rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    transform.rotate(rotation.normalized());
  }
  if (node.scale.size() == 3) transform.scale(core::Vec3(node.scale[0], node.scale[1], node.scale[2]));
  return transform;
}

/// Adds the scalar members of `extras` (glTF 2.0 specification, section 3.3), over those of the same name;
/// objects and arrays in them are skipped.
void add_tags(const tinygltf::Value& extras, FaceTags& tags) {
  if (!extras.IsObject()) return;
  for (const std::string& key : extras.Keys()) {
    const tinygltf::Value& value = extras.Get(key);
    if (value.IsString()) tags[key] = value.Get<std::string>();
    if (value.IsBool()) tags[key] = value.Get<bool>() ? "true" : "false";
    if (value.IsNumber()) tags[key] = tag_text(value.GetNumberAsDouble());
  }
}

class ModelReader {
 public:
  ModelReader(const tinygltf::Model& model, const std::filesystem::path& path) : model_(model), path_(path) {}

  RawMesh read() {
    refuse_hidden_geometry();
    raw_.unit = {"m", 1000.0, false, 1000.0};
    for (const int root : root_nodes()) visit(root, {Eigen::Affine3d::Identity(), {}}, 0);
    raw_.fill_body();
    add_notes();
    return std::move(raw_);
  }

 private:
  /// State that a node passes to its children and its mesh.
  struct Inherited {
    Eigen::Affine3d transform;
    FaceTags tags;
  };

  void refuse_hidden_geometry() const {
    for (const std::string& extension : model_.extensionsRequired) {
      const bool hides = extension == "KHR_draco_mesh_compression" ||
                         extension == "EXT_meshopt_compression" || extension == "KHR_mesh_quantization" ||
                         extension == "EXT_mesh_gpu_instancing";
      if (hides) {
        reject_file(path_, "the glTF file needs the extension " + extension + ", which is not supported",
                    "export the mesh without compression, quantisation and instancing");
      }
    }
  }

  std::vector<int> root_nodes() const {
    if (!model_.scenes.empty()) {
      const auto wanted = static_cast<std::size_t>(std::max(model_.defaultScene, 0));
      if (wanted >= model_.scenes.size())
        reject_file(path_, "the default scene does not exist in the glTF file");
      return model_.scenes[wanted].nodes;
    }
    std::set<int> children;
    for (const auto& node : model_.nodes) children.insert(node.children.begin(), node.children.end());
    std::vector<int> roots;
    for (int i = 0; i < static_cast<int>(model_.nodes.size()); ++i) {
      if (!children.contains(i)) roots.push_back(i);
    }
    return roots;
  }

  void visit(int index, const Inherited& parent, std::size_t depth) {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size()) {
      reject_file(path_, "node " + std::to_string(index) + " does not exist in the glTF file");
    }
    // In a tree every node is visited once; a second visit means a loop or a shared child.
    if (!visited_.insert(index).second) {
      reject_file(path_, "node " + std::to_string(index) + " has more than one parent or is inside itself",
                  "the nodes of a glTF file must form a tree");
    }
    if (depth > kDeepestNesting) reject_file(path_, "nodes are nested more than 500 deep");
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    Inherited own{parent.transform * node_transform(node), parent.tags};
    add_tags(node.extras, own.tags);
    if (node.skin >= 0) ++skins_;
    if (node.mesh >= 0) append_mesh(node, own);
    for (const int child : node.children) visit(child, own, depth + 1);
  }

  void append_mesh(const tinygltf::Node& node, Inherited own) {
    if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) {
      reject_file(path_, "mesh " + std::to_string(node.mesh) + " does not exist in the glTF file");
    }
    used_meshes_.insert(node.mesh);
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    raw_.begin_body(node.name.empty() ? mesh.name : node.name);
    add_tags(mesh.extras, own.tags);
    for (const auto& primitive : mesh.primitives) append_primitive(primitive, own);
  }

  void append_primitive(const tinygltf::Primitive& primitive, const Inherited& inherited) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
      ++raw_.points_and_lines;
      return;
    }
    if (!primitive.targets.empty()) ++morphs_;
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
      ++without_positions_;
      return;
    }
    const auto positions = read_positions(model_, position->second, path_);
    std::vector<std::uint32_t> indices(positions.size());
    std::iota(indices.begin(), indices.end(), 0U);
    if (primitive.indices >= 0) indices = read_indices(model_, primitive.indices, positions.size(), path_);

    TriMesh& mesh = raw_.mesh;
    if (mesh.vertices.size() + positions.size() > kMostElements ||
        mesh.triangles.size() + indices.size() > kMostElements) {
      reject_file(path_, "the mesh has more than 2^31 vertices or triangles", "split it in several files");
    }
    first_vertex_ = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const core::Vec3& p : positions) mesh.vertices.push_back(inherited.transform * p);
    FaceTags tags = inherited.tags;
    const std::string material = material_name(primitive.material);
    if (primitive.material >= 0)
      add_tags(model_.materials[static_cast<std::size_t>(primitive.material)].extras, tags);
    add_tags(primitive.extras, tags);
    group_ = mesh.group_index(material, tags);
    mirrored_ = inherited.transform.linear().determinant() < 0.0;
    append_triangles(mode, indices);
  }

  void append_triangles(int mode, const std::vector<std::uint32_t>& i) {
    if (mode == TINYGLTF_MODE_TRIANGLES) {
      leftover_indices_ += i.size() % 3;
      for (std::size_t k = 0; k + 2 < i.size(); k += 3) add(i[k], i[k + 1], i[k + 2]);
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {  // glTF 2.0 specification, section 3.7.2.1
      for (std::size_t k = 0; k + 2 < i.size(); ++k) add(i[k], i[k + 1 + k % 2], i[k + 2 - k % 2]);
    } else {
      for (std::size_t k = 0; k + 2 < i.size(); ++k) add(i[k + 1], i[k + 2], i[0]);
    }
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (mirrored_) std::swap(b, c);
    raw_.mesh.triangles.push_back({first_vertex_ + a, first_vertex_ + b, first_vertex_ + c});
    raw_.mesh.group.push_back(group_);
  }

  std::string material_name(int material) const {
    if (material < 0) return "default";
    if (static_cast<std::size_t>(material) >= model_.materials.size()) {
      reject_file(path_, "material " + std::to_string(material) + " does not exist in the glTF file");
    }
    const std::string& name = model_.materials[static_cast<std::size_t>(material)].name;
    return name.empty() ? "material " + std::to_string(material) : name;
  }

  void add_notes() {
    const auto note = [this](std::size_t count, const std::string& what) {
      if (count > 0) raw_.notes.push_back(std::to_string(count) + " " + what);
    };
    note(without_positions_, "primitives without POSITION left out");
    note(leftover_indices_, "indices at the end of primitives left out: they form no complete triangle");
    note(skins_, "skins left out: the mesh is imported unposed");
    note(morphs_, "sets of morph targets left out: the mesh is imported undeformed");
    note(model_.meshes.size() - used_meshes_.size(), "meshes left out: no node of the scene refers to them");
  }

  const tinygltf::Model& model_;
  const std::filesystem::path& path_;
  RawMesh raw_;
  std::set<int> visited_, used_meshes_;
  std::uint32_t first_vertex_ = 0, group_ = 0;
  bool mirrored_ = false;
  std::size_t without_positions_ = 0, leftover_indices_ = 0, skins_ = 0, morphs_ = 0;
};

RawMesh read_gltf(const MeshFile& file, bool binary) {
  std::vector<std::string> notes;
  const tinygltf::Model model = load_gltf(file.path, file.content, binary, notes);
  RawMesh raw = ModelReader(model, file.path).read();
  raw.notes.insert(raw.notes.end(), notes.begin(), notes.end());
  return raw;
}

}  // namespace

/// Mesh of a glTF 2.0 file, by tinygltf: text, with buffers embedded or in files beside it. Coordinates in
/// metres, in glTF's axes (y up). Reads the default scene, else the first, else every root node; groups are
/// material names, tags the scalar extras of nodes, mesh, material and primitive, the later ones taking
/// precedence; bodies are nodes with a mesh. Throws InputError also for extensions that hide the geometry.
RawMesh import_gltf(const MeshFile& file) { return read_gltf(file, false); }

/// The same for a binary file (.glb).
RawMesh import_glb(const MeshFile& file) { return read_gltf(file, true); }

}  // namespace scintray::mesh
