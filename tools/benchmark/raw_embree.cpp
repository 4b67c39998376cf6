#include "raw_embree.hpp"

#include <limits>

#include "clock.hpp"
#include "embree_scene.hpp"

namespace scintray::bench {

namespace {

/// Distance (mm) from the origin at which rays start, as most rays do that start on a boundary.
constexpr float kStartMm = 1e-5f;

}  // namespace

/// Embree's scenes, one for each accelerator that has rays.
struct RawEmbree::Boundaries {
  Boundaries() : device(rtcNewDevice(nullptr)) {}
  ~Boundaries() {
    for (const RTCScene scene : scenes)
      if (scene) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Boundaries(const Boundaries&) = delete;
  Boundaries& operator=(const Boundaries&) = delete;

  RTCDevice device;
  core::IdVector<core::AcceleratorId, RTCScene> scenes;
};

RawEmbree::RawEmbree(const scene::Scene& scene, std::vector<RecordedRay> rays)
    : rays_(std::move(rays)), boundaries_(std::make_unique<Boundaries>()) {
  boundaries_->scenes.resize(scene.accelerators.size());
  for (const RecordedRay& ray : rays_) {
    RTCScene& mine = boundaries_->scenes[ray.accelerator];
    if (!mine) mine = make_embree_scene(boundaries_->device, scene.accelerators[ray.accelerator]->boundary());
  }
}

RawEmbree::~RawEmbree() = default;

void RawEmbree::trace_once() {
  EmbreeQuery query;
  double sum_mm = 0.0;
  std::uint64_t hits = 0;
  for (const RecordedRay& ray : rays_) {
    RTCRayHit hit;
    hit.ray.org_x = ray.origin[0];
    hit.ray.org_y = ray.origin[1];
    hit.ray.org_z = ray.origin[2];
    hit.ray.dir_x = ray.direction[0];
    hit.ray.dir_y = ray.direction[1];
    hit.ray.dir_z = ray.direction[2];
    hit.ray.tnear = kStartMm;
    hit.ray.tfar = std::numeric_limits<float>::infinity();
    hit.ray.time = 0.0f;
    hit.ray.mask = 0xffffffffu;
    hit.ray.flags = 0;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query(boundaries_->scenes[ray.accelerator], hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    ++hits;
    sum_mm += static_cast<double>(hit.ray.tfar);
  }
  hits_ = hits;
  sum_mm_ = sum_mm;
}

double RawEmbree::rays_per_second(double seconds) {
  if (rays_.empty()) return 0.0;
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  double elapsed = 0.0;
  std::size_t passes = 0;
  do {
    trace_once();
    ++passes;
    elapsed = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
  } while (elapsed < seconds);
  return static_cast<double>(passes * rays_.size()) / elapsed;
}

const char* embree_version() { return RTC_VERSION_STRING; }

}  // namespace scintray::bench
