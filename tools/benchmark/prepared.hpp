#pragma once
/// Scenes made ready to be traced, and what is measured on them.

#include <string>
#include <vector>

#include "raw_embree.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/scene/build_scene.hpp"
#include "scintray/scene/read_scene.hpp"

namespace scintray::bench {

struct Prepared {
  BuiltScene built;
  SceneSpec spec;
};

struct Speed {
  double segments = 0.0, photons = 0.0;  ///< per second
};

Prepared prepare(const std::string& scene_text, SceneBuilder& builder);

Speed measure(const Prepared& prepared, int threads);

/// The rays that photons make in the part where they start, in its own frame.
std::vector<RawRay> record_rays(const Prepared& prepared, std::size_t count);

std::vector<BoundaryTriangle> triangles_of(const TriMesh& mesh);

}  // namespace scintray::bench
