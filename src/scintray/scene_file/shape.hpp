#pragma once
/// Shapes of parts in a scene file. Lengths mm, angles rad.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scintray/config/toml_reader.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/vec.hpp"
#include "scintray/mesh/import/mesh_format.hpp"
#include "scintray/mesh/shapes/shapes.hpp"
#include "scintray/mesh/tessellation.hpp"

namespace scintray::scene_file {

/// An axis-aligned box, mm.
struct BoxSpec {
  core::Vec3 low = core::Vec3::Zero();
  core::Vec3 high = core::Vec3::Zero();
  double chamfer_mm = 0.0;  ///< of all edges, for the shape of a part
  core::FileLocation where;
  double rounding_mm = 0.0;  ///< radius of all edges, for the shape of a part
  bool operator==(const BoxSpec&) const = default;
};

/// Round faces of a mesh file of triangles.
enum class RoundFacesOfFile {
  facets,     ///< the triangles
  recognize,  ///< the surface on which all corners lie within the contact tolerance, where there is one
};
inline constexpr core::Word<RoundFacesOfFile> kRoundFacesOfFile[] = {
    {"facets", RoundFacesOfFile::facets}, {"recognize", RoundFacesOfFile::recognize}};

/// A mesh file, CAD or triangles.
struct MeshFileSpec {
  std::filesystem::path path;     ///< absolute, or relative to the working folder; it exists
  std::optional<double> unit_mm;  ///< length of the file's unit; nothing: defined in the file
  double scale = 1.0;
  std::string body;                 ///< name or number of the one body of the file; empty: all together
  mesh::Tessellation tessellation;  ///< of a CAD file's curved faces
  RoundFacesOfFile curved = RoundFacesOfFile::facets;
  core::FileLocation where;
  bool operator==(const MeshFileSpec&) const = default;
};

/// A closed prism about the z axis, from z = 0 up.
struct CylinderSpec {
  double radius_mm = 0.0;  ///< of the circle through the vertices
  double height_mm = 0.0;
  int segments = 64;  ///< flat sides
  core::FileLocation where;
  bool operator==(const CylinderSpec&) const = default;
};

/// Frustum of a cone about the z axis, from z = 0 up; a radius of 0 makes a tip.
struct ConeSpec {
  double bottom_radius_mm = 0.0;
  double top_radius_mm = 0.0;
  double height_mm = 0.0;
  int segments = 64;  ///< flat sides
  core::FileLocation where;
  bool operator==(const ConeSpec&) const = default;
};

/// Regular prism about the z axis, from z = 0 up, first corner on +x.
struct PrismSpec {
  int sides = 6;
  double circumradius_mm = 0.0;
  double height_mm = 0.0;
  double chamfer_mm = 0.0;
  core::FileLocation where;
  bool operator==(const PrismSpec&) const = default;
};

/// Frustum between two rectangles, from z = 0 up.
struct TaperedSpec {
  mesh::Rectangle bottom, top;
  double height_mm = 0.0;
  core::FileLocation where;
  bool operator==(const TaperedSpec&) const = default;
};

/// Compound parabolic concentrator, exit on z = 0.
struct WinstonSpec {
  mesh::WinstonShape shape;
  core::FileLocation where;
  bool operator==(const WinstonSpec&) const = default;
};

/// Geodesic sphere about the origin.
struct SphereSpec {
  double radius_mm = 0.0;  ///< of the sphere through the vertices
  int subdivisions = 16;   ///< 20 subdivisions^2 triangles
  core::FileLocation where;
  bool operator==(const SphereSpec&) const = default;
};

/// Lens about the z axis, its lower vertex at the origin.
struct LensSpec {
  mesh::LensShape shape;
  core::FileLocation where;
  bool operator==(const LensSpec&) const = default;
};

/// Body of revolution about the z axis.
struct RevolvedSpec {
  std::vector<std::array<double, 2>> profile;      ///< corners (r, z), mm
  std::vector<std::array<std::size_t, 2>> smooth;  ///< first and last corners of smooth ranges
  int segments = 64;                               ///< flat sides
  core::FileLocation where;
  bool operator==(const RevolvedSpec&) const = default;
};

/// A cylinder with a bore, from z = 0 up.
struct TubeSpec {
  mesh::TubeShape shape;
  core::FileLocation where;
  bool operator==(const TubeSpec&) const = default;
};

/// A torus about the z axis and the origin.
struct TorusSpec {
  mesh::TorusShape shape;
  core::FileLocation where;
  bool operator==(const TorusSpec&) const = default;
};

/// An ellipsoid of revolution about the z axis and the origin.
struct SpheroidSpec {
  double radius_mm = 0.0;       ///< perpendicular to the axis
  double half_height_mm = 0.0;  ///< along it
  int subdivisions = 16;        ///< 20 subdivisions^2 triangles
  core::FileLocation where;
  bool operator==(const SpheroidSpec&) const = default;
};

/// A round or square rod along a path.
struct FibreSpec {
  mesh::FibreShape shape;
  core::FileLocation where;
  bool operator==(const FibreSpec&) const = default;
};

using ShapeSpec =
    std::variant<MeshFileSpec, BoxSpec, CylinderSpec, PrismSpec, TaperedSpec, WinstonSpec, SphereSpec,
                 ConeSpec, LensSpec, RevolvedSpec, TubeSpec, TorusSpec, SpheroidSpec, FibreSpec>;

/// Place of a shape in the file.
core::FileLocation shape_location(const ShapeSpec& shape);

/// A shape as triangles, with notes on elements that were ignored or reversed on import.
struct ShapeMesh {
  mesh::TriMesh mesh;
  std::vector<std::string> notes;
};

/// Mesh of a shape, made or loaded. Throws InputError, without a place for errors in the shape's own numbers.
/// @param formats  formats of mesh files
ShapeMesh shape_mesh(const ShapeSpec& shape,
                     const mesh::MeshFormats& formats = mesh::MeshFormats::built_in());

/// The shape of a [[part]] or an element, with its chamfer or rounding; a unit box on an error.
ShapeSpec read_shape(const config::TomlTable& part);

/// { low = [...], high = [...] } under `key`; nothing when absent or on an error.
std::optional<BoxSpec> read_low_high(const config::TomlTable& table, const std::string& key);

}  // namespace scintray::scene_file
