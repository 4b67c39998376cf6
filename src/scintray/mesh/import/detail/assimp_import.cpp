#include "scintray/mesh/import/mesh_format.hpp"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>

#include <cstring>
#include <mutex>
#include <set>
#include <string_view>

#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

using AssimpMatrix = aiMatrix4x4t<double>;

/// Collects assimp's warnings and errors, which list what it skipped. The logger is one per process, so
/// imports take turns.
class WarningCapture {
 public:
  WarningCapture() : lock_(mutex()) {
    if (!Assimp::DefaultLogger::isNullLogger()) return;  // the host program has its own
    Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Stream(*this), Assimp::Logger::Warn | Assimp::Logger::Err);
    ours_ = true;
  }
  WarningCapture(const WarningCapture&) = delete;
  WarningCapture& operator=(const WarningCapture&) = delete;
  ~WarningCapture() {
    if (ours_) Assimp::DefaultLogger::kill();
  }
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  class Stream : public Assimp::LogStream {
   public:
    explicit Stream(WarningCapture& owner) : owner_(owner) {}
    void write(const char* message) override { owner_.keep(message); }

   private:
    WarningCapture& owner_;
  };

  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  void keep(std::string_view message) {
    constexpr std::size_t kMost = 20;
    while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.remove_suffix(1);
    // Material libraries are not opened (OneFile), which leaves the names of materials as they are.
    if (message.find("material") != std::string_view::npos) return;
    if (message.empty() || messages_.size() > kMost) return;
    messages_.push_back(messages_.size() == kMost ? "assimp: and more" : "assimp: " + std::string(message));
  }

  std::lock_guard<std::mutex> lock_;
  std::vector<std::string> messages_;
  bool ours_ = false;
};

/// The bytes of one file, and no other file: files that a mesh file refers to, such as the material library
/// of an OBJ, may be a pipe or any other file of the user's. Only names of materials are read, which are in
/// the file itself.
class OneFile : public Assimp::IOSystem {
 public:
  explicit OneFile(const MeshFile& file) : path_(file.path.string()), content_(file.content) {}
  bool Exists(const char* path) const override { return path_ == path; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char*) override {
    if (!Exists(path)) return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(content_.data()),
                                      content_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string path_;
  const std::string& content_;
};

AssimpMatrix to_double(const aiMatrix4x4& m) {
  return {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4};
}

std::string material_name(const aiScene& scene, const aiMesh& mesh) {
  aiString name;
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return {};
  if (scene.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name) != AI_SUCCESS) return {};
  return std::strcmp(name.C_Str(), AI_DEFAULT_MATERIAL_NAME) == 0 ? std::string() : name.C_Str();
}

/// Name of an object; empty when the file does not name it.
std::string object_name(const aiScene& scene, const aiMesh& mesh, const aiNode& node) {
  const std::string material = material_name(scene, mesh);
  std::string object = mesh.mName.C_Str();
  // For the second and later materials of an OBJ object, assimp names the mesh after the material.
  if (object.empty() || object == material) object = node.mName.C_Str();
  // Assimp's own names for objects that the file does not name.
  if (object.starts_with("<") || object == "defaultobject") object.clear();
  return object;
}

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const std::filesystem::path& path) : scene_(scene), path_(path) {}

  RawMesh read() {
    visit(*scene_.mRootNode, AssimpMatrix());
    raw_.fill_body();
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
      if (!used_.contains(m)) {
        raw_.notes.push_back("object \"" + std::string(scene_.mMeshes[m]->mName.C_Str()) +
                             "\" left out: no node of the file places it");
      }
    }
    return std::move(raw_);
  }

 private:
  void visit(const aiNode& node, const AssimpMatrix& parent) {
    const AssimpMatrix transform = parent * to_double(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes)
        reject_file(path_, "a node refers to an object that does not exist");
      used_.insert(node.mMeshes[i]);
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
      begin_body(node, object_name(scene_, mesh, node));
      append(mesh, node, transform);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], transform);
  }

  /// The materials of one object are meshes of their own, one after the other.
  void begin_body(const aiNode& node, const std::string& name) {
    if (latest_node_ == &node && latest_name_ == name) return;
    raw_.begin_body(name);
    latest_node_ = &node;
    latest_name_ = name;
  }

  void append(const aiMesh& source, const aiNode& node, const AssimpMatrix& transform) {
    TriMesh& mesh = raw_.mesh;
    if (mesh.vertices.size() + source.mNumVertices > kMostElements ||
        mesh.triangles.size() + source.mNumFaces > kMostElements) {
      reject_file(path_, "the mesh has more than 2^31 vertices or triangles", "split it in several files");
    }
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    const bool identity = transform == AssimpMatrix();
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
      const aiVector3D& p = source.mVertices[v];
      const aiVector3t<double> given(p.x, p.y, p.z);
      // A transform would spread a non-finite coordinate over all three.
      const aiVector3t<double> moved = identity ? given : transform * given;
      mesh.vertices.emplace_back(moved.x, moved.y, moved.z);
    }
    const bool mirrored = transform.Determinant() < 0.0;
    const bool has_faces = source.mNumFaces > 0 && (source.mPrimitiveTypes & kSurfaces) != 0;
    const std::uint32_t group =
        has_faces
            ? mesh.group_index(group_name(object_name(scene_, source, node), material_name(scene_, source)))
            : 0;
    std::vector<std::uint32_t> corners;
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      const std::string name = "face " + std::to_string(f + 1);
      corners.assign(face.mIndices, face.mIndices + face.mNumIndices);
      for (std::uint32_t& corner : corners) {
        if (corner >= source.mNumVertices) {
          reject_file(path_, name + " refers to a vertex that does not exist",
                      "the file is damaged; export it again");
        }
        corner += offset;
      }
      if (!raw_.add_polygon(corners, group, mirrored)) {
        reject_file(path_,
                    name + " has " + std::to_string(corners.size()) + " corners, more than can be read",
                    "cut polygons in triangles when exporting");
      }
    }
  }

  static constexpr unsigned kSurfaces = aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON;

  const aiScene& scene_;
  const std::filesystem::path& path_;
  RawMesh raw_;
  std::set<unsigned> used_;
  const aiNode* latest_node_ = nullptr;
  std::string latest_name_;
};

}  // namespace

/// Mesh of an STL or OBJ file, by assimp, without the files that it names. The sizes that the file states
/// must have been checked.
RawMesh import_through_assimp(const MeshFile& file) {
  const std::filesystem::path& path = file.path;
  WarningCapture warnings;
  Assimp::Importer importer;
  importer.SetIOHandler(new OneFile(file));  // which the importer deletes
  const aiScene* scene = nullptr;
  std::string reason;
  try {
    scene = importer.ReadFile(path.string(), 0);
    reason = importer.GetErrorString();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    reject_file(path, "cannot read the mesh: " + (reason.empty() ? "assimp reports no reason" : reason),
                "check that the content matches the extension " + path.extension().string() +
                    ", and export it again");
  }
  RawMesh raw = SceneReader(*scene, path).read();
  raw.notes.insert(raw.notes.end(), warnings.messages().begin(), warnings.messages().end());
  return raw;
}

}  // namespace scintray::mesh
