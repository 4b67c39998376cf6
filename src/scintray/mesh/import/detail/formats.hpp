#pragma once
/// The readers of the mesh formats that are built in. Each throws InputError for content that is malformed.

#include "scintray/mesh/import/mesh_format.hpp"

namespace scintray::mesh {

/// Mesh of an STL, OBJ or OFF file, by assimp. The sizes that the file states must have been checked.
RawMesh import_through_assimp(const MeshFile& file);

/// Mesh of a PLY file (G. Turk 1994, "The PLY Polygon File Format", version 1.0), ASCII or binary of either
/// byte order. Coordinates keep double precision. One group, "default". Elements other than "vertex" and
/// "face" are left out with a note. Time and memory are bounded by the length of the content.
///
/// Other readers are not used: assimp up to 5.3 skips data bytes of binary files that look like white space
/// after the header, and CGAL 5.5 crashes on headers whose lines stand in an unexpected order.
RawMesh import_ply(const MeshFile& file);

/// Mesh of a 3MF archive (3MF Core Specification 1.3): the model that the relationships name, its meshes and
/// components as its build items place them, in the unit of the model. Coordinates keep double precision.
/// Bodies are build items, called after their object; groups are object and base material. Colours, textures
/// and the extensions for slices and lattices are ignored. Throws InputError also when objects contain
/// themselves, and when components multiply to more than 20 million triangles.
///
/// Assimp is not used: up to 5.3 it aborts the process for archives that do not fit their checksums or whose
/// relationships lead nowhere, and frees their pictures twice.
RawMesh import_3mf(const MeshFile& file);

/// Mesh of a COLLADA file (1.4.1, 1.5: Khronos Group, "COLLADA - Digital Asset Schema"): the meshes that the
/// visual scene places, with the transforms of its nodes, in the file's own axes and unit (<asset><unit
/// meter="..."/>; one metre when it is left out). Triangles, polylists, polygons, strips and fans; skins
/// unposed, with a note. Bodies are placed geometries, called after their node; groups are geometry and
/// material. Throws InputError also for references without a target, nodes inside themselves, holes in
/// polygons, and instances that multiply to more than 20 million triangles.
///
/// Assimp is not used: up to 5.3 it reads beyond its arrays when a file's counts do not fit each other.
RawMesh import_collada(const MeshFile& file);

/// Mesh of a glTF 2.0 file, by tinygltf: text, with buffers embedded or in files beside it. Coordinates in
/// metres, in glTF's axes (y up). Reads the default scene, else the first, else every root node; groups are
/// material names, tags the scalar extras of nodes, mesh, material and primitive, the later ones taking
/// precedence; bodies are nodes with a mesh. Throws InputError also for extensions that hide the geometry.
RawMesh import_gltf(const MeshFile& file);

/// The same for a binary file (.glb).
RawMesh import_glb(const MeshFile& file);

/// Mesh of a STEP file (ISO 10303-21; AP203, AP214, AP242), by Open CASCADE, with its faces tessellated.
/// Coordinates are in mm; RawMesh::unit is the file's own unit.
///
/// Bodies are solids, each instance of an assembly one of its own, called after its product; a product
/// without solids is one body of its shells. Every CAD face is a group, called after its name, else its
/// colour ("#rrggbb", sRGB), else its number in the file ("face12"); its tags are "face", the number, and
/// "color", its own colour or that of its solid or product.
///
/// Throws InputError also for content that has no faces, or that Open CASCADE cannot read or tessellate; for
/// a deviation below a millionth of the size of the shape; and when ScintRay was built without Open CASCADE.
RawMesh import_step(const MeshFile& file);

}  // namespace scintray::mesh
