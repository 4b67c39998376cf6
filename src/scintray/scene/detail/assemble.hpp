#pragma once
/// Construction of regions, interfaces and accelerators from placed parts and their surfaces.

#include <functional>
#include <string>
#include <vector>

#include "scintray/contact/contacts.hpp"
#include "scintray/core/error.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene/scene.hpp"
#include "scintray/scene_file/spec.hpp"

namespace scintray::scene {

/// A face of a part before contacts are known.
struct AssemblyFace {
  std::string name;  ///< "part:face"
  core::PartId part;
  std::string surface;      ///< name; empty: smooth
  core::SensorId sensor;    ///< light that leaves the part here is detected
  bool is_cathode = false;  ///< the surface is a photocathode, which is bonded to whatever it touches
};

/// Name of a surface for messages and results; the empty name is the smooth surface.
inline std::string name_or_smooth(const std::string& surface) { return surface.empty() ? "smooth" : surface; }

struct AssemblyPart {
  contact::PlacedPart geometry;
  core::MediumId medium;
  std::string surface;                                     ///< at its boundaries with parts nested in it
  core::SensorId sensor;                                   ///< light that enters the part is detected
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< of its placement; identical parts share
};

/// All definitions of a scene, looked up but not yet assembled.
struct Assembly {
  core::IdVector<core::MediumId, SceneMedium> media;
  core::IdVector<core::SensorId, detector::Sensor> sensors;
  core::IdVector<core::FaceId, AssemblyFace> faces;
  core::IdVector<core::PartId, AssemblyPart> parts;
  core::MediumId ambient;  ///< around everything
  scene_file::ContactKind contacts_default = scene_file::ContactKind::bonded;
  std::vector<scene_file::ContactSpec> contacts;
  double contact_tolerance_mm = 1e-4;
  scene_file::AcceleratorKind accelerator = scene_file::AcceleratorKind::automatic;
  scene_file::CurvedFaces curved = scene_file::CurvedFaces::exact;
  bool keeps_phases = false;  ///< photons are polarised elliptically
  double low_nm = 0.0, high_nm = 0.0;
  /// The surface of a name between two media; for equal arguments the same surface may be returned. The empty
  /// name is the smooth surface.
  std::function<optics::Surface(const std::string& name, core::MediumId inside, core::MediumId outside)>
      make_surface;
};

/// The scene of an assembly. Throws InputError, with every problem, for parts that overlap, contacts between
/// parts that do not touch, and shared faces whose two surfaces disagree.
Scene assemble(const Assembly& assembly);

/// Sets Scene::sensor_frames, where a sensor's efficiency depends on the place on its face. Requires the
/// scene's faces. Adds to `problems` the faces that have no direction.
void place_sensor_faces(const Assembly& assembly, Scene& scene, core::Problems& problems);

/// Id of a part's region, or of the ambient region for no part. The ambient region is the first, followed by
/// those of the parts in their order.
inline core::RegionId region_of(core::PartId part) {
  return part.has_value() ? core::RegionId(part.index() + 1) : kAmbientRegion;
}

}  // namespace scintray::scene
