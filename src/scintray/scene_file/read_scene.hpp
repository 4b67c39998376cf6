#pragma once
/// Scene files: parse, then transform (sweeps), then instantiate (SceneSpec).

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/scene_file/definitions.hpp"
#include "scintray/scene_file/spec.hpp"
#include "scintray/scene_file/sweep.hpp"
#include "scintray/scene_file/tally_variable.hpp"

namespace scintray::scene_file {

/// Registries needed while a scene file is read. Models of surfaces and sensors are needed later
/// (simulation::SimulationOptions::models).
struct Extensions {
  TallyVariables variables = TallyVariables::built_in();           ///< that tallies may name
  mesh::MeshFormats mesh_formats = mesh::MeshFormats::built_in();  ///< of parts, and of elements of arrays
};

/// Specification of a parsed scene (its sweeps are checked but not applied). `text` is the file's. Every
/// error is added to `problems`; the result may be used only without any.
SceneSpec read_scene(const config::TomlNodePtr& document, const std::string& text, core::Problems& problems,
                     const Extensions& extensions = {});

/// All keys that read_scene can read in the tables of this document, as "part.place.gap", sorted.
std::vector<std::string> scene_keys(const config::TomlNodePtr& document);

/// Uses of the keys of this document by read_scene, also with errors (config::explore_keys). Definitions,
/// [media.NAME] and the like, are read by the material database (materials::definition_key_uses).
std::vector<config::KeyUse> scene_key_uses(const config::TomlNodePtr& document);

/// A scene file with its sweeps, one scene per point.
class SceneFile {
 public:
  /// The scene file of a path; every value of its sweeps and of its fit's starts and bounds is read at least
  /// once. Throws InputError with every distinct problem; names without a definition are then reported too.
  static SceneFile load(const std::filesystem::path& path, const Extensions& extensions = {});
  /// The same for a scene in memory; `file` is used in messages and for relative paths.
  static SceneFile from_text(const std::string& text, const std::string& file,
                             const Extensions& extensions = {});

  /// The scene of a path, without its sweeps, as far as it can be read: for pictures of scenes that load()
  /// refuses.
  /// Throws InputError for a file that is not TOML.
  static SceneSpec load_readable(const std::filesystem::path& path);

  /// The definitions of a file, [media.NAME] and the like, with those made by its builders: of a scene, or of
  /// a file with definitions only. Throws InputError for a file that is not TOML, and for definitions that
  /// are not tables.
  static SceneSpec load_definitions(const std::filesystem::path& path);

  /// Product of the numbers of swept values; 1 without a sweep.
  std::size_t points() const;
  /// Headings of the swept keys, slowest first.
  std::vector<std::string> sweep_keys() const;
  /// Value of each swept key at a point, as written ("2 mm").
  std::vector<std::string> parameters(std::size_t point) const;
  /// The swept keys, slowest first; sweep_values() is the number of values of each.
  std::vector<KeyPath> sweep_paths() const;
  std::size_t sweep_values(std::size_t sweep) const;
  /// The scene at a point, 0 <= point < points().
  SceneSpec spec(std::size_t point) const;
  /// The same with further keys set after those of the sweeps, which may be the same keys.
  SceneSpec spec(std::size_t point, const std::vector<KeySetting>& settings) const;
  const std::string& text() const { return text_; }
  /// The extensions with which it was read; valid as long as this file or a copy.
  const Extensions& extensions() const { return *extensions_; }
  /// Its own definitions that are not used in it.
  std::vector<DefinitionRef> unused_definitions() const;

 private:
  const config::TomlNode& value_at(std::size_t point, std::size_t sweep) const;
  SceneSpec read_point(std::size_t point, const std::vector<KeySetting>& settings,
                       core::Problems& problems) const;

  config::TomlNodePtr document_;
  std::vector<SweepSpec> sweeps_;
  std::shared_ptr<const Extensions> extensions_;
  std::string text_;
};

}  // namespace scintray::scene_file
