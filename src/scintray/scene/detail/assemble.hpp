#pragma once
/// From placed parts with known surfaces to regions, interfaces and accelerators.

#include <functional>
#include <string>
#include <vector>

#include "scintray/contact/contacts.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// A face of a part before contacts are known.
struct AssemblyFace {
  std::string name;  ///< "part:face"
  std::uint32_t part = 0;
  std::string surface;          ///< name; empty: none given, smooth
  std::int32_t sensor = kNone;  ///< light that leaves the part here is detected
};

struct AssemblyPart {
  contact::PlacedPart geometry;                            ///< `face` refers to Assembly::faces
  std::uint32_t medium = 0;                                ///< index into Assembly::media
  std::string surface;                                     ///< its own, where another part lies in it
  std::int32_t sensor = kNone;                             ///< light that enters the part is detected
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< its placement: lets identical parts share
};

/// Everything that decides what a scene is, looked up but not yet put together.
struct Assembly {
  std::vector<SceneMedium> media;
  std::vector<detector::Sensor> sensors;
  std::vector<AssemblyFace> faces;
  std::vector<AssemblyPart> parts;
  std::uint32_t ambient = 0;  ///< medium around everything
  scene_file::ContactKind contacts_default = scene_file::ContactKind::bonded;
  std::vector<scene_file::ContactSpec> contacts;
  double contact_tolerance_mm = 1e-4;
  scene_file::AcceleratorKind accelerator = scene_file::AcceleratorKind::automatic;
  double low_nm = 0.0, high_nm = 0.0;
  /// Makes the surface of that name for the media on its two sides (indices into `media`); where it
  /// is used twice the same surface may be returned. The empty name is the smooth surface.
  std::function<optics::Surface(const std::string& name, std::uint32_t inside_medium,
                                std::uint32_t outside_medium)>
      make_surface;
};

/// Builds the scene. Throws InputError, with every problem, for parts that overlap, contacts between
/// parts that do not touch, and shared faces whose two surfaces disagree.
Scene assemble(const Assembly& assembly);

/// Fills scene.regions from interface triangles; `interface_of[i]` is the interface of triangles[i].
/// Regions whose boundaries are equal in their parts' own frames, and lead to the same pattern of
/// interfaces, share one accelerator.
void build_regions(const Assembly& assembly, const std::vector<contact::InterfaceTriangle>& triangles,
                   const std::vector<std::uint32_t>& interface_of, Scene& scene);

}  // namespace scintray::scene
