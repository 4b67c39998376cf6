#pragma once
/// The material database: media, surfaces, sensors and reflectors, and a scene's own definitions beside it.

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/detector/sensor.hpp"
#include "scintray/materials/sensor_models.hpp"
#include "scintray/materials/surface_models.hpp"
#include "scintray/materials/surface_spec.hpp"
#include "scintray/optics/medium.hpp"

namespace scintray::materials {

/// The models that definitions may name. Further models are added in code:
///
///     DefinitionModels models;
///     models.surfaces.add({.word = "mine", .table = "mine", .read = read_mine});
///     const MaterialDatabase database = MaterialDatabase::shipped(models);
struct DefinitionModels {
  SurfaceModels surfaces;
  SensorModels sensors;
};

enum class DefinitionKind { medium, surface, sensor, reflector };

/// Outline of a surface's definition, before it is read as a surface.
struct SurfaceOutline {
  std::string model;                 ///< a word of SurfaceModels, or "mixture"; empty without one
  std::vector<std::string> bases;    ///< definitions on which it is based, nearest first
  std::vector<std::string> needs;    ///< dotted keys that the user must supply
  std::vector<std::string> sources;  ///< published sources, each once, its own first, then its bases'
};

/// The material database: finds definitions by name, first among a scene's own, then in each folder in turn,
/// where the file is FOLDER/media/NAME.toml, FOLDER/surfaces/NAME.toml, FOLDER/sensors/NAME.toml or
/// FOLDER/reflectors/NAME.toml. Files are read on first use, once, and must cite their sources.
///
/// Each definition is read once and kept. Copies share the definitions read from files, so that scenes with
/// definitions of their own do not read them again; surfaces and sensors, which may be based on a scene's
/// own, are read once for each set of own definitions. Copies may be used by several threads at a time.
///
/// The getters throw InputError: at `where` for an unknown name, with the nearest name and the places
/// searched; at the places of errors in a definition. Returned references are valid until add(), or as long
/// as a copy without it.
class MaterialDatabase {
 public:
  /// Throws InputError when a folder does not exist.
  explicit MaterialDatabase(const std::vector<std::filesystem::path>& folders, DefinitionModels models = {});
  /// The material database shipped with ScintRay: data_folder()/materials.
  static MaterialDatabase shipped(DefinitionModels models = {});

  /// Adds definitions of a scene ([media.NAME], ...), which need no sources and take precedence over files.
  void add(DefinitionKind kind, const std::map<std::string, config::TomlNodePtr>& definitions);

  const optics::Medium& medium(const std::string& name, const core::FileLocation& where = {}) const;
  const SurfaceSpec& surface(const std::string& name, const core::FileLocation& where = {}) const;
  /// Outline of a surface that may be incomplete without keys supplied by the user.
  SurfaceOutline outline(const std::string& surface, const core::FileLocation& where = {}) const;
  const detector::Sensor& sensor(const std::string& name, const core::FileLocation& where = {}) const;
  const optics::Reflector& reflector(const std::string& name, const core::FileLocation& where = {}) const;

  /// True when there is a definition of this name, sound or not.
  bool has(DefinitionKind kind, const std::string& name) const;
  /// The error of a name without a definition: the nearest name, and the places searched.
  core::Problem unknown(DefinitionKind kind, const std::string& name, const core::FileLocation& where) const;

  /// Every name of a kind, sorted.
  std::vector<std::string> names(DefinitionKind kind) const;

  /// Numbers of readings by this database and those that share its files.
  struct Readings {
    std::size_t files = 0;        ///< of the folders
    std::size_t definitions = 0;  ///< media, surfaces, sensors and reflectors, of files and scenes
  };
  Readings readings() const;

 private:
  struct Known;
  /// The cache of definitions of a kind that depend on files alone, or on own definitions too.
  Known& known_for(DefinitionKind kind, const std::string& name) const;
  optics::Medium read_medium_of(const std::string& name, const core::FileLocation& where) const;
  detector::Sensor read_sensor_of(const std::string& name, const core::FileLocation& where) const;
  optics::Reflector read_reflector_of(const std::string& name, const core::FileLocation& where) const;
  /// @param within names of the mixtures that this surface is a share of
  const SurfaceSpec& surface(const std::string& name, const core::FileLocation& where,
                             const std::vector<std::string>& within) const;
  SurfaceSpec read_surface_of(const std::string& name, const core::FileLocation& where,
                              const std::vector<std::string>& within) const;
  struct Definition {
    config::TomlNodePtr node;
    bool from_file = false;
  };
  Definition find(DefinitionKind kind, const std::string& name, const core::FileLocation& where) const;
  /// A definition and those on which it is based, by their `base`, itself first. Throws InputError when a
  /// base is missing, is not a name, or occurs twice.
  struct Ancestor {
    std::string name;
    Definition definition;
  };
  std::vector<Ancestor> lineage(DefinitionKind kind, const std::string& name,
                                const core::FileLocation& where) const;
  /// A sensor's definition, with missing keys taken from those on which it is based, apart from keys of
  /// another sensor model.
  config::TomlNode merged_sensor(const std::vector<Ancestor>& ancestors) const;
  /// A surface's definition merged over those on which it is based.
  struct Chain {
    config::TomlNode merged;
    std::vector<std::string> names;  ///< the requested one first
    std::vector<std::string> sources;
  };
  Chain chain(const std::string& surface, const core::FileLocation& where, core::Problems& problems) const;

  std::shared_ptr<const DefinitionModels> models_;
  std::vector<std::filesystem::path> folders_;
  std::array<std::map<std::string, std::filesystem::path>, 4> files_;
  std::array<std::map<std::string, config::TomlNodePtr>, 4> own_;
  struct Files;
  std::shared_ptr<Files> read_;      ///< of the folders, shared by all copies
  std::shared_ptr<Known> with_own_;  ///< of these own definitions, shared by copies that have the same
};

}  // namespace scintray::materials
