#include "scene_list.hpp"

#include <algorithm>

#include "build_facts.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/pattern.hpp"
#include "scintray/mesh/shapes/primitives.hpp"
#include "scintray/scene_file/read_scene.hpp"

namespace scintray::bench {

namespace {

/// The box of crystal.toml with 16^2 triangles in place of each of its 12.
mesh::TriMesh crystal_of_3072_triangles() {
  return mesh::subdivide_faces(mesh::make_box({-1, -1, -10}, {1, 1, 10}), 16);
}

BenchScene crystal(const std::string& name, const std::string& shows, const std::string& surface) {
  return {name, shows, "crystal.toml", {{"part.crystal.surface", "\"" + surface + "\""}}};
}

/// The light of another scene's crystal with the wavelengths of its emission.
BenchScene with_spectrum(const std::string& name, const std::string& shows, const std::string& surface,
                         const std::string& relative_to) {
  BenchScene scene = crystal(name, shows, surface);
  scene.settings.push_back({"source.wavelength", "\"emission\""});
  scene.relative_to = relative_to;
  return scene;
}

BenchScene embree_crystal(const std::string& name, const std::string& shows, mesh::TriMesh (*mesh)()) {
  return {name, shows, "crystal.toml", {{"run.accelerator", "\"embree\""}}, mesh};
}

/// Arrays of n x n crystals, and the single one with which they are compared.
BenchScene array(int n, const std::string& kind, const std::string& surface) {
  const std::string count = std::to_string(n), middle = std::to_string(n / 2);
  BenchScene scene{
      "array_" + count + "_" + kind,
      n == 1 ? "one crystal as in the " + kind + " arrays" : count + " x " + count + " crystals, " + kind,
      "array.toml",
      {{"array.crystal.count", "[" + count + ", " + count + "]", {"array.grease.count", "array.pad.count"}},
       {"array.crystal.element.surface", "\"" + surface + "\""},
       {"source.region.part", "\"crystal[" + middle + "," + middle + "]\""}}};
  if (n > 1) scene.relative_to = "array_1_" + kind;
  return scene;
}

config::TomlNode value_of(const Setting& setting) {
  const config::TomlNodePtr root = config::parse_toml("value = " + setting.value, "scene_list.cpp");
  return *root->find("value");
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const BenchScene& scene : scene_list()) names.push_back(scene.name);
  return names;
}

}  // namespace

const std::vector<BenchScene>& scene_list() {
  static const std::vector<BenchScene> scenes{
      crystal("polished", "total reflections, rays by planes", "polished"),
      embree_crystal("polished_embree", "the same by Embree", nullptr),
      embree_crystal("polished_3072", "the same with 3072 triangles", crystal_of_3072_triangles),
      crystal("unified", "facets of the UNIFIED model, 18 deg", "roncali2013_unified_rough"),
      crystal("table", "table of a ground surface", "lso_ground_30um_420nm"),
      crystal("painted", "Lambertian reflector on the crystal", "painted"),
      crystal("table_ptfe", "table of a ground surface, air gap, PTFE", "table_ptfe"),
      crystal("height_map", "rays on a ground height map, no table", "ground_on_the_spot"),
      with_spectrum("unified_spectrum", "facets as in unified, wavelengths of the crystal's emission",
                    "roncali2013_unified_rough", "unified"),
      with_spectrum("table_spectrum", "a ground surface tabulated over the wavelengths of the emission",
                    "lso_ground_30um", "table"),
      {"rod", "polished rod, its wall by formula", "rod.toml", {}, nullptr, "polished"},
      {"plate", "polished plate with 49 exact round holes", "plate.toml", {}, nullptr, "plate_facets"},
      {"plate_facets",
       "the same, its holes of 288 flat sides",
       "plate.toml",
       {{"run.curved", "\"facets\""}, {"array.hole.element.cylinder.segments", "288"}}},
      {"birefringent",
       "polished crystal of a biaxial medium",
       "crystal.toml",
       {{"part.crystal.medium", "\"biaxial\""}},
       nullptr,
       "polished"},
      {"tape", "film with an explicit air gap, polished crystal", "tape.toml"},
      array(1, "bare", "polished"),
      array(20, "bare", "polished"),
      array(40, "bare", "polished"),
      array(1, "wrapped", "polished_lambertian_097"),
      array(20, "wrapped", "polished_lambertian_097"),
      array(40, "wrapped", "polished_lambertian_097"),
      {"block", "block detector: 12 x 12 crystals, septa, light guide", "block.toml"},
      {"million_triangles", "polished ball of 1,003,520 triangles", "ball.toml"},
      {"gamma_array", "511 keV events in 8 x 8 crystals, with readout", "gamma.toml"},
  };
  return scenes;
}

std::vector<BenchScene> select_scenes(const std::vector<std::string>& patterns) {
  const std::vector<std::string> names = scene_names();
  core::Problems problems;
  for (const std::string& pattern : patterns)
    if (core::matching(pattern, names).empty())
      problems.add(core::unknown_name({}, "benchmark scene", pattern, names));
  problems.throw_if_any();
  std::vector<BenchScene> chosen;
  for (const BenchScene& scene : scene_list()) {
    const auto matches = [&](const std::string& pattern) {
      return core::matches_pattern(pattern, scene.name);
    };
    if (patterns.empty() || std::any_of(patterns.begin(), patterns.end(), matches)) chosen.push_back(scene);
  }
  return chosen;
}

const BenchScene& scene_named(const std::string& name) {
  for (const BenchScene& scene : scene_list())
    if (scene.name == name) return scene;
  throw core::unknown_name({}, "benchmark scene", name, scene_names());
}

scene_file::SceneSpec spec_of(const BenchScene& scene) {
  std::vector<scene_file::KeySetting> settings;
  for (const Setting& setting : scene.settings) {
    scene_file::KeyPath path{setting.key, setting.also, {}, "key of the benchmark scene"};
    settings.push_back({std::move(path), value_of(setting)});
  }
  return scene_file::SceneFile::load(scene_folder() / scene.file).spec(0, settings);
}

}  // namespace scintray::bench
