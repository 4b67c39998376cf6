#pragma once
/// The library of media, surfaces, sensors and reflectors, and a scene's own definitions beside it.

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scintray/detector/sensor.hpp"
#include "scintray/medium/medium.hpp"
#include "scintray/scene/surface_spec.hpp"
#include "scintray/scene/toml_reader.hpp"
#include "scintray/surface/surface.hpp"

namespace scintray {

enum class LibraryKind { medium, surface, sensor, reflector };

/// What a surface's definition says before it is made into a surface.
struct SurfaceOutline {
  std::string model;  ///< "smooth", "unified", "recipe", ..., "mixture"; empty when none is given
  std::vector<std::string> bases;    ///< what it is based on, nearest first
  std::vector<std::string> needs;    ///< what it leaves to the user, as "unified.sigma_alpha"
  std::vector<std::string> sources;  ///< published sources, each once, its own first, then its bases'
};

/// Finds definitions by name: first among a scene's own, then in each folder in turn, where the file is
/// FOLDER/media/NAME.toml, FOLDER/surfaces/NAME.toml, FOLDER/sensors/NAME.toml or
/// FOLDER/reflectors/NAME.toml. Files are read when asked for, and must name their sources.
///
/// The getters throw InputError: at `where` when there is nothing of that name, with the nearest
/// name and the places searched; at the places in the definition when that is wrong.
class Library {
 public:
  /// Throws InputError when a folder does not exist.
  explicit Library(const std::vector<std::filesystem::path>& folders);
  /// The library that comes with ScintRay: data_folder()/materials.
  static Library shipped();

  /// Adds definitions of a scene ([media.NAME], ...), which need not name sources and win over files.
  void add(LibraryKind kind, const std::map<std::string, TomlNodePtr>& definitions);

  Medium medium(const std::string& name, const FileLocation& where = {}) const;
  SurfaceSpec surface(const std::string& name, const FileLocation& where = {}) const;
  /// The same of a surface that may leave something to the user, and so be none yet.
  SurfaceOutline outline(const std::string& surface, const FileLocation& where = {}) const;
  Sensor sensor(const std::string& name, const FileLocation& where = {}) const;
  Reflector reflector(const std::string& name, const FileLocation& where = {}) const;

  /// Every name of a kind, sorted.
  std::vector<std::string> names(LibraryKind kind) const;

 private:
  /// @param within names of the mixtures that this surface is a share of
  SurfaceSpec surface(const std::string& name, const FileLocation& where,
                      const std::vector<std::string>& within) const;
  struct Definition {
    TomlNodePtr node;
    bool from_file = false;
  };
  Definition find(LibraryKind kind, const std::string& name, const FileLocation& where) const;
  /// A definition and what it is based on, by their `base`: itself first. Throws InputError when a base is
  /// missing, is no name, or comes twice.
  struct Ancestor {
    std::string name;
    Definition definition;
  };
  std::vector<Ancestor> lineage(LibraryKind kind, const std::string& name, const FileLocation& where) const;
  /// A surface's definition laid over those that it is based on.
  struct Chain {
    TomlNode merged;
    std::vector<std::string> names;  ///< the asked one first
    std::vector<std::string> sources;
  };
  Chain chain(const std::string& surface, const FileLocation& where, Problems& problems) const;

  std::vector<std::filesystem::path> folders_;
  std::array<std::map<std::string, std::filesystem::path>, 4> files_;
  std::array<std::map<std::string, TomlNodePtr>, 4> own_;
};

}  // namespace scintray
