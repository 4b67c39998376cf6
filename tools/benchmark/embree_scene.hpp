#pragma once
/// Embree's scene of a boundary, and its calls, which have a context in version 3 and none in version 4.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "scintray/scene/boundary.hpp"

namespace scintray::bench {

/// A scene of the boundary's triangles, with the settings of scene/accelerator.cpp. The caller releases it.
RTCScene make_embree_scene(RTCDevice device, const scene::Boundary& boundary);

/// First hits of rays in scenes, one at a time or in packets. @param valid  -1 for each ray of a packet
class EmbreeQuery {
 public:
#if defined(RTC_VERSION_MAJOR) && RTC_VERSION_MAJOR >= 4
  void operator()(RTCScene scene, RTCRayHit& hit) { rtcIntersect1(scene, &hit); }
  void operator()(RTCScene scene, const int* valid, RTCRayHit4& hit) { rtcIntersect4(valid, scene, &hit); }
  void operator()(RTCScene scene, const int* valid, RTCRayHit8& hit) { rtcIntersect8(valid, scene, &hit); }
  void operator()(RTCScene scene, const int* valid, RTCRayHit16& hit) { rtcIntersect16(valid, scene, &hit); }
#else
  EmbreeQuery() { rtcInitIntersectContext(&context_); }
  void operator()(RTCScene scene, RTCRayHit& hit) { rtcIntersect1(scene, &context_, &hit); }
  void operator()(RTCScene scene, const int* valid, RTCRayHit4& hit) {
    rtcIntersect4(valid, scene, &context_, &hit);
  }
  void operator()(RTCScene scene, const int* valid, RTCRayHit8& hit) {
    rtcIntersect8(valid, scene, &context_, &hit);
  }
  void operator()(RTCScene scene, const int* valid, RTCRayHit16& hit) {
    rtcIntersect16(valid, scene, &context_, &hit);
  }

 private:
  RTCIntersectContext context_;
#endif
};

}  // namespace scintray::bench
