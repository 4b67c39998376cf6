#pragma once
/// The fixed set of scenes that the benchmark measures.

#include <string>
#include <vector>

#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::bench {

/// A key of a scene file with the value that a benchmark scene gives it, as written in TOML.
struct Setting {
  std::string key;                     ///< dotted path, as of a sweep
  std::string value;                   ///< "\"polished\"", "[40, 40]"
  std::vector<std::string> also = {};  ///< keys that are given the same value
};

struct BenchScene {
  std::string name;
  std::string shows;  ///< what its figures show, for the list of scenes
  std::string file;   ///< in tools/benchmark/scenes
  std::vector<Setting> settings = {};
  /// Makes the mesh that replaces the shape of the first part; null: the file's own shape.
  mesh::TriMesh (*mesh)() = nullptr;
  /// Name of the scene to whose segments/s those of this one are compared in every round; empty: none.
  std::string relative_to = {};
};

/// All scenes, in the order in which they are measured.
const std::vector<BenchScene>& scene_list();

/// The scenes whose names match any of the patterns (with *), in the order of the list; all without a
/// pattern.
/// @throws InputError for every pattern that matches none, with the nearest name
std::vector<BenchScene> select_scenes(const std::vector<std::string>& patterns);

/// The scene of a name. @throws InputError when there is none
const BenchScene& scene_named(const std::string& name);

/// Specification of a scene; Workload puts the mesh made in code into it. @throws InputError for errors in
/// its file or settings
scene_file::SceneSpec spec_of(const BenchScene& scene);

}  // namespace scintray::bench
