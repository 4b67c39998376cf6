#include "raw_embree.hpp"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <limits>

#include "clock.hpp"

namespace scintray::bench {

namespace {

/// Distance (mm) from the origin at which rays start, as most rays do that start on a boundary.
constexpr float kStartMm = 1e-5f;

RTCScene make_scene(RTCDevice device, const scene::Boundary& boundary) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), boundary.vertices.size()));
  auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), boundary.size()));
  for (const core::PlainVec3& vertex : boundary.vertices)
    for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(vertex.vec()[axis]);
  for (const std::uint32_t corner : boundary.corners) *corners++ = corner;
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

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
    if (!mine) mine = make_scene(boundaries_->device, scene.accelerators[ray.accelerator]->boundary());
  }
}

RawEmbree::~RawEmbree() = default;

void RawEmbree::trace_once() {
#if !defined(RTC_VERSION_MAJOR) || RTC_VERSION_MAJOR < 4
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
#endif
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
#if defined(RTC_VERSION_MAJOR) && RTC_VERSION_MAJOR >= 4
    rtcIntersect1(boundaries_->scenes[ray.accelerator], &hit);
#else
    rtcIntersect1(boundaries_->scenes[ray.accelerator], &context, &hit);
#endif
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
