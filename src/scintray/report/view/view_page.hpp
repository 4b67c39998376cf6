#pragma once
/// A scene in three dimensions, as a self-contained page: parts, faces with their surfaces, paths of photons.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/core/step_event.hpp"
#include "scintray/mesh/trimesh.hpp"

namespace scintray::report {

struct ViewFace {
  std::string name;     ///< within the part
  std::string surface;  ///< empty: smooth
  std::string sensor;   ///< empty: none
};

struct ViewPart {
  std::string name, medium;
  const mesh::TriMesh* mesh = nullptr;  ///< world, mm
  std::vector<ViewFace> faces;
  std::vector<std::uint32_t> face_of;  ///< per triangle, index into `faces`
};

struct ViewVertex {
  core::Vec3 position;  ///< world, mm
  double time_ns = 0.0, wavelength_nm = 0.0;
  std::string event;  ///< what happened there
};

struct ViewPath {
  std::string name;
  core::Fate fate = {};
  std::vector<ViewVertex> vertices;
};

/// A finding of `scintray check`, with its places.
struct ViewMark {
  std::string text;
  std::vector<core::Vec3> places;  ///< mm
};

struct SceneView {
  std::string title;
  std::vector<ViewPart> parts;
  std::vector<ViewPath> paths;
  std::vector<ViewMark> marks;
};

/// True when this build has three.js, which draws the page.
bool can_view();

/// The page. Parts of equal shape are stored once. @throws SystemError without three.js
std::string view_page(const SceneView& view);

}  // namespace scintray::report
