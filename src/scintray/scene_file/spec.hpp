#pragma once
/// A scene as its file says it: names and numbers, nothing looked up or built yet. Lengths mm,
/// wavelengths nm, times ns, angles rad.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/detector/readout_spec.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene_file/accelerator_kind.hpp"
#include "scintray/scene_file/analysis_spec.hpp"
#include "scintray/scene_file/criterion_spec.hpp"
#include "scintray/scene_file/fit_spec.hpp"
#include "scintray/scene_file/gamma_spec.hpp"
#include "scintray/scene_file/goniometer_spec.hpp"
#include "scintray/scene_file/placement.hpp"
#include "scintray/scene_file/shape_spec.hpp"
#include "scintray/scene_file/source_spec.hpp"
#include "scintray/scene_file/tally_spec.hpp"

namespace scintray::scene_file {

/// The medium that absorbs whatever enters it.
inline constexpr const char* kOpaqueMedium = "opaque";

/// Name of the face made of a part's triangles that no rule matches; no rule may have it.
inline constexpr const char* kOtherFaces = "other";

/// Bound of part priorities, both ways.
inline constexpr int kHighestPriority = 1000;

/// What the name of a part and this make is the name of the part that fills the gap under it.
inline constexpr const char* kFillSuffix = "_fill";

/// Picks triangles of a part in world coordinates, after placement. Every criterion given must hold; they
/// mean what they mean in FaceSelector (mesh/face_selection.hpp).
struct FaceSelectorSpec {
  std::optional<core::Vec3> normal;  ///< unit; within `tolerance_rad` of the outward normal
  double tolerance_rad = core::kDegree;
  std::optional<BoxSpec> box;             ///< the whole triangle lies in it
  std::optional<core::Vec3> flat_region;  ///< point, mm: the connected flat patch nearest to it
  std::optional<core::Vec3> nearest;      ///< point, mm: the one triangle nearest to it
  config::NameRef group;                  ///< glTF material or OBJ group of the mesh file; side
                                          ///< "-z" of a box, "side" of a cylinder
  mesh::FaceTags tags;                    ///< glTF extras, "color" of a CAD face
  core::FileLocation where;
};

/// What is special about some of a part's faces.
struct FaceRuleSpec {
  std::string name;  ///< unique within its part; when not given, the group, or the side
                     ///< ("-z") of a normal along an axis, or "face1", "face2"...
  FaceSelectorSpec select;
  config::NameRef surface;  ///< empty: the part's
  config::NameRef sensor;   ///< light that crosses outwards here is detected by it
  core::FileLocation where;
};

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
};

/// What a builder ([[array]], [[light_guide]]) made: parts that are placed as one body. The placement of
/// each of them, and what its face rules select, count in the builder's own frame.
struct GroupSpec {
  config::NameRef name;
  std::size_t first = 0;  ///< index of its first part in SceneSpec::parts; the others follow
  std::size_t count = 0;
  PlacementSpec placement;
};

/// How the touching faces of two parts meet.
enum class ContactKind {
  bonded,  ///< optical contact: one interface between both media
  dry,     ///< an air gap of no thickness: each side keeps its surface to the ambient medium
};

struct ContactSpec {
  std::array<config::NameRef, 2> between;  ///< names, or patterns with "*" (core/pattern.hpp)
  std::array<std::string, 2> faces;        ///< of the two parts; empty: every face
  ContactKind kind = ContactKind::bonded;
  config::NameRef surface;  ///< of the shared interface; empty: the surfaces of the two faces decide
  bool joint = false;       ///< bonded within one body: smooth, whatever the faces' surfaces are
  bool by_builder = false;  ///< made with a builder's parts: yields to what the file says, may find no pair
  /// Faces this near to each other, curved ones too, are made one (conform_parts.hpp); nothing: only
  /// those within the scene's contact tolerance.
  std::optional<double> tolerance_mm;
  core::FileLocation where;
};

struct RunSpec {
  std::uint64_t seed = 1;
  std::uint64_t max_interactions = 100000;  ///< boundary interactions per photon
  std::optional<double> max_time_ns;
  std::optional<int> threads;  ///< nothing: all cores
  double contact_tolerance_mm = 1e-4;
  AcceleratorKind accelerator = AcceleratorKind::automatic;
  bool photon_list = false;      ///< stream every detected photon to the results
  bool photon_history = false;   ///< stream what each went through, for reweighting
  std::filesystem::path output;  ///< results file; empty: the command decides
  core::FileLocation where;
};

/// A definition written in the scene file, in the form of a library file: the library parses it.
using InlineTables = std::map<std::string, config::TomlNodePtr>;

struct SceneSpec {
  std::string title;
  config::NameRef ambient;  ///< medium around everything
  ContactKind contacts_default = ContactKind::bonded;
  bool contacts_default_given = false;
  std::vector<PartSpec> parts;
  std::vector<GroupSpec> groups;
  std::vector<ContactSpec> contacts;
  SourceSpec source;                       ///< [source] of photons
  std::optional<GammaSpec> energy_source;  ///< [source] of energy; then there is no `source`
  RunSpec run;
  std::optional<detector::ReadoutSpec> readout;  ///< electronics behind every sensor; nothing: none
  AnalysisSpec analysis;
  std::vector<ClaimSpec> claims;
  std::vector<BenchSpec> benches;
  std::optional<FitSpec> fit;  ///< [fit]
  std::vector<ExitAngleTallySpec> exit_angles;
  std::vector<TallySpec> tallies;
  InlineTables media;            ///< [media.NAME], as materials/media/NAME.toml
  InlineTables surfaces;         ///< [surfaces.NAME]
  InlineTables sensors;          ///< [sensors.NAME]
  InlineTables reflectors;       ///< [reflectors.NAME]
  std::filesystem::path file;    ///< the scene file as it was named
  std::filesystem::path folder;  ///< relative paths in the scene count from here
  std::string text;              ///< the whole file
};

}  // namespace scintray::scene_file
