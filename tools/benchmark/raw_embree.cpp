#include "raw_embree.hpp"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <chrono>
#include <limits>

namespace scintray::bench {

struct RawEmbree::State {
  RTCDevice device;
  RTCScene scene;
};

RawEmbree::RawEmbree(const std::vector<scene::BoundaryTriangle>& triangles) : state_(new State) {
  state_->device = rtcNewDevice(nullptr);
  state_->scene = rtcNewScene(state_->device);
  rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * triangles.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.size()));
  unsigned next = 0;
  for (const scene::BoundaryTriangle& triangle : triangles)
    for (const core::Vec3& vertex : triangle) {
      for (int axis = 0; axis < 3; ++axis) *vertices++ = static_cast<float>(vertex[axis]);
      *indices++ = next++;
    }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(state_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(state_->scene);
}

RawEmbree::~RawEmbree() {
  rtcReleaseScene(state_->scene);
  rtcReleaseDevice(state_->device);
  delete state_;
}

double RawEmbree::rays_per_second(const std::vector<RawRay>& rays) {
  const auto start = std::chrono::steady_clock::now();
  double sum = 0.0;
#if !defined(RTC_VERSION_MAJOR) || RTC_VERSION_MAJOR < 4
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
#endif
  for (const RawRay& ray : rays) {
    RTCRayHit hit;
    hit.ray.org_x = ray.origin[0];
    hit.ray.org_y = ray.origin[1];
    hit.ray.org_z = ray.origin[2];
    hit.ray.dir_x = ray.direction[0];
    hit.ray.dir_y = ray.direction[1];
    hit.ray.dir_z = ray.direction[2];
    hit.ray.tnear = 1e-5f;
    hit.ray.tfar = std::numeric_limits<float>::infinity();
    hit.ray.time = 0.0f;
    hit.ray.mask = 0xffffffffu;
    hit.ray.flags = 0;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if defined(RTC_VERSION_MAJOR) && RTC_VERSION_MAJOR >= 4
    rtcIntersect1(state_->scene, &hit);
#else
    rtcIntersect1(state_->scene, &context, &hit);
#endif
    if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID) sum += static_cast<double>(hit.ray.tfar);
  }
  checksum_ = sum;
  return static_cast<double>(rays.size()) /
         std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace scintray::bench
