#pragma once
/// [[part]]: a body of the scene. Lengths mm, angles rad.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "scintray/config/name_ref.hpp"
#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/scene_file/face.hpp"
#include "scintray/scene_file/placement.hpp"
#include "scintray/scene_file/shape.hpp"

namespace scintray::scene_file {

/// The medium that absorbs whatever enters it.
inline constexpr const char* kOpaqueMedium = "opaque";

/// Bound of part priorities, both ways.
inline constexpr int kHighestPriority = 1000;

/// What the name of a part and this make is the name of the part that fills the gap under it.
inline constexpr const char* kFillSuffix = "_fill";

struct PartSpec {
  config::NameRef name;
  ShapeSpec shape;
  PlacementSpec placement;
  config::NameRef medium;   ///< kOpaqueMedium allowed; empty only for a part that is a sensor
  config::NameRef surface;  ///< of every face that no rule matches; empty: rules must cover every face
  config::NameRef sensor;   ///< the whole part is a sensor
  int priority = 0;         ///< of two parts that overlap the one with the higher priority keeps the space
  std::vector<FaceRuleSpec> faces;
  bool liquid = false;  ///< glue or filler of a builder: its faces need no surface, they are smooth
  core::FileLocation where;
  bool operator==(const PartSpec&) const = default;
};

/// What a builder ([[array]], [[light_guide]]) made: parts that are placed as one body. The placement of
/// each of them, and what its face rules select, count in the builder's own frame.
struct GroupSpec {
  config::NameRef name;
  std::size_t first = 0;  ///< index of its first part in SceneSpec::parts; the others follow
  std::size_t count = 0;
  PlacementSpec placement;
  bool operator==(const GroupSpec&) const = default;
};

/// A definition written in the scene file, in the form of a file of the database, which parses it.
using InlineTables = std::map<std::string, config::TomlNodePtr>;

/// The keys of a [[part]] or of an element, but for its name and place: shape, medium, sensor,
/// surface and faces.
void read_body(const config::TomlTable& table, PartSpec& part);

/// One [[part]]; `earlier` are the names that it may touch.
PartSpec read_part(const config::TomlTable& table, const std::vector<std::string>& earlier);

}  // namespace scintray::scene_file
