#pragma once
/// Scenes made ready to be traced, and what is measured on them.

#include <memory>
#include <string>
#include <vector>

#include "raw_embree.hpp"
#include "scintray/mesh/trimesh.hpp"
#include "scintray/simulation/simulation_point.hpp"

namespace scintray::bench {

using Prepared = std::shared_ptr<const simulation::SimulationPoint>;

struct Speed {
  double segments = 0.0, photons = 0.0;  ///< per second
};

Prepared prepare(const std::string& scene_text, scene::SceneBuilder& builder);

Speed measure(const Prepared& prepared, int threads);

/// The rays that photons make in the part where they start, in its own frame.
std::vector<RawRay> record_rays(const Prepared& prepared, std::size_t count);

std::vector<scene::BoundaryTriangle> triangles_of(const mesh::TriMesh& mesh);

}  // namespace scintray::bench
