#include "scintray/mesh/export/gltf_writer.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>
#include <tuple>

#include "scintray/core/error.hpp"
#include "scintray/core/output_file.hpp"

namespace scintray::mesh {
namespace {

constexpr double kMetresPerMm = 1e-3;

/// Builds the file's model object by object.
class ModelMaker {
 public:
  explicit ModelMaker(GltfAxes axes) {
    model_.asset.version = "2.0";
    model_.asset.generator = "ScintRay";
    model_.buffers.emplace_back();
    model_.scenes.emplace_back();
    model_.defaultScene = 0;
    if (axes == GltfAxes::z_up) {
      tinygltf::Node root;
      root.name = "z up";
      const double half = std::sqrt(0.5);
      root.rotation = {-half, 0.0, 0.0, half};  // a quarter turn about x takes z to y
      model_.nodes.push_back(root);
      model_.scenes[0].nodes.push_back(0);
    }
    has_root_ = axes == GltfAxes::z_up;
  }

  void add(const GltfObject& object) {
    tinygltf::Mesh mesh;
    mesh.name = object.name;
    std::map<std::uint32_t, std::vector<std::uint32_t>> by_group;
    for (std::uint32_t t = 0; t < object.mesh->triangles.size(); ++t)
      by_group[object.mesh->group.empty() ? 0 : object.mesh->group[t]].push_back(t);
    for (const auto& [group, triangles] : by_group) {
      const bool named = group < object.mesh->groups.size();
      mesh.primitives.push_back(primitive(*object.mesh, triangles));
      mesh.primitives.back().material = material(named ? object.mesh->groups[group] : object.name,
                                                 object.mesh->tags_of(group), object.colour);
    }
    tinygltf::Node node;
    node.name = object.name;
    node.mesh = static_cast<int>(model_.meshes.size());
    const int index = static_cast<int>(model_.nodes.size());
    model_.meshes.push_back(std::move(mesh));
    model_.nodes.push_back(std::move(node));
    (has_root_ ? model_.nodes[0].children : model_.scenes[0].nodes).push_back(index);
  }

  const tinygltf::Model& model() const { return model_; }

 private:
  /// Appends to the one buffer; returns the number of the view on it.
  template <typename T>
  int view(const std::vector<T>& values, int target) {
    auto& data = model_.buffers[0].data;
    tinygltf::BufferView result;
    result.buffer = 0;
    result.byteOffset = data.size();
    result.byteLength = values.size() * sizeof(T);
    result.target = target;
    data.resize(data.size() + result.byteLength);
    std::memcpy(data.data() + result.byteOffset, values.data(), result.byteLength);
    model_.bufferViews.push_back(result);
    return static_cast<int>(model_.bufferViews.size() - 1);
  }

  tinygltf::Primitive primitive(const TriMesh& mesh, const std::vector<std::uint32_t>& triangles) {
    std::map<std::uint32_t, std::uint32_t> index;
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
    std::vector<double> low(3, HUGE_VAL), high(3, -HUGE_VAL);
    for (const std::uint32_t t : triangles)
      for (const std::uint32_t v : mesh.triangles[t]) {
        const auto [known, is_new] = index.try_emplace(v, static_cast<std::uint32_t>(index.size()));
        indices.push_back(known->second);
        if (!is_new) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const auto x = static_cast<float>(kMetresPerMm * mesh.vertices[v][static_cast<int>(axis)]);
          positions.push_back(x);
          low[axis] = std::min(low[axis], static_cast<double>(x));
          high[axis] = std::max(high[axis], static_cast<double>(x));
        }
      }
    tinygltf::Accessor points, corners;
    points.bufferView = view(positions, TINYGLTF_TARGET_ARRAY_BUFFER);
    points.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    points.type = TINYGLTF_TYPE_VEC3;
    points.count = index.size();
    points.minValues = low;
    points.maxValues = high;
    corners.bufferView = view(indices, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    corners.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    corners.type = TINYGLTF_TYPE_SCALAR;
    corners.count = indices.size();
    tinygltf::Primitive result;
    result.mode = TINYGLTF_MODE_TRIANGLES;
    result.attributes["POSITION"] = static_cast<int>(model_.accessors.size());
    model_.accessors.push_back(points);
    result.indices = static_cast<int>(model_.accessors.size());
    model_.accessors.push_back(corners);
    return result;
  }

  int material(const std::string& name, const FaceTags& tags,
               const std::optional<std::array<double, 4>>& colour) {
    const auto [known, is_new] =
        materials_.try_emplace({name, tags, colour}, static_cast<int>(model_.materials.size()));
    if (!is_new) return known->second;
    constexpr std::array<double, 4> kGrey{0.7, 0.7, 0.7, 1.0};
    const auto& rgba = colour.value_or(kGrey);
    tinygltf::Material result;
    result.name = name;
    result.doubleSided = true;
    result.pbrMetallicRoughness.baseColorFactor.assign(rgba.begin(), rgba.end());
    result.pbrMetallicRoughness.metallicFactor = 0.0;
    result.pbrMetallicRoughness.roughnessFactor = 0.9;
    if (rgba[3] < 1.0) result.alphaMode = "BLEND";
    if (!tags.empty()) {
      tinygltf::Value::Object extras;
      for (const auto& [key, value] : tags) extras.emplace(key, tinygltf::Value(value));
      result.extras = tinygltf::Value(std::move(extras));
    }
    model_.materials.push_back(std::move(result));
    return known->second;
  }

  tinygltf::Model model_;
  std::map<std::tuple<std::string, FaceTags, std::optional<std::array<double, 4>>>, int> materials_;
  bool has_root_ = false;
};

}  // namespace

void write_glb(const std::filesystem::path& path, const std::vector<GltfObject>& objects, GltfAxes axes) {
  ModelMaker maker(axes);
  for (const GltfObject& object : objects)
    if (!object.mesh->triangles.empty()) maker.add(object);
  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(const_cast<tinygltf::Model*>(&maker.model()), stream, false, true))
    throw core::SystemError("cannot write " + path.string() + ": the glTF library failed");
  core::write_whole_file(path, stream.str());
}

}  // namespace scintray::mesh
