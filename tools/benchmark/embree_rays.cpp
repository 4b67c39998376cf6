#include "embree_rays.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "embree_scene.hpp"
#include "scintray/core/error.hpp"
#include "scintray/core/lanes.hpp"

namespace scintray::bench {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

std::uint32_t triangle_of(unsigned geometry, unsigned triangle) {
  return geometry == RTC_INVALID_GEOMETRY_ID ? scene::kNoTriangle : triangle;
}

}  // namespace

struct EmbreeRays::Handles {
  explicit Handles(const std::string& max_isa)
      : device(rtcNewDevice(("set_affinity=0,max_isa=" + max_isa).c_str())) {
    if (!device) throw core::SystemError("Embree cannot be started on this machine");
  }
  ~Handles() {
    if (scene) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;

  RTCDevice device;
  RTCScene scene = nullptr;
};

EmbreeRays::EmbreeRays(const scene::Accelerator& region, const std::string& max_isa)
    : handles_(std::make_unique<Handles>(max_isa)), start_mm_(static_cast<float>(region.start_mm())) {
  handles_->scene = make_embree_scene(handles_->device, region.boundary());
}

EmbreeRays::~EmbreeRays() = default;

bool EmbreeRays::has_packets(int size) const {
  const RTCDeviceProperty property = size == 4   ? RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED
                                     : size == 8 ? RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED
                                                 : RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED;
  return rtcGetDeviceProperty(handles_->device, property) != 0;
}

void EmbreeRays::trace_single(const RaySet& rays, RayHits& hits) const {
  EmbreeQuery query;
  const std::size_t count = rays.size();
  for (std::size_t i = 0; i < count; ++i) {
    // Written by fours, as the tracer does (make_ray in scene/accelerator.cpp).
    const core::FourFloats origin = core::Lanes(rays.origin(i), static_cast<double>(start_mm_)).floats();
    const core::FourFloats direction = core::Lanes(rays.direction(i), 0.0).floats();
    RTCRayHit
        hit;  // NOLINT(cppcoreguidelines-pro-type-member-init): what Embree does not read stays as it is
    std::memcpy(&hit.ray.org_x, &origin, sizeof origin);
    std::memcpy(&hit.ray.dir_x, &direction, sizeof direction);
    hit.ray.tfar = kFar;
    hit.ray.mask = 0xffffffffu;
    hit.ray.flags = 0;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query(handles_->scene, hit);
    hits.triangle[i] = triangle_of(hit.hit.geomID, hit.hit.primID);
    hits.distance_mm[i] = hit.ray.tfar;
  }
}

template <typename Packet>
void EmbreeRays::trace_packets_of(const RaySet& rays, RayHits& hits) const {
  constexpr std::size_t kSize = sizeof(Packet::ray.org_x) / sizeof(float);
  EmbreeQuery query;
  alignas(64) int valid[kSize];
  std::fill(valid, valid + kSize, -1);
  Packet packet;
  for (std::size_t first = 0; first + kSize <= rays.size(); first += kSize) {
    float* const numbers[6] = {packet.ray.org_x, packet.ray.org_y, packet.ray.org_z,
                               packet.ray.dir_x, packet.ray.dir_y, packet.ray.dir_z};
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t i = 0; i < kSize; ++i) numbers[k][i] = static_cast<float>(rays.doubles[k][first + i]);
    for (std::size_t i = 0; i < kSize; ++i) {
      packet.ray.tnear[i] = start_mm_;
      packet.ray.time[i] = 0.0f;
      packet.ray.tfar[i] = kFar;
      packet.ray.mask[i] = 0xffffffffu;
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    query(handles_->scene, valid, packet);
    for (std::size_t i = 0; i < kSize; ++i) {
      hits.triangle[first + i] = triangle_of(packet.hit.geomID[i], packet.hit.primID[i]);
      hits.distance_mm[first + i] = packet.ray.tfar[i];
    }
  }
}

void EmbreeRays::trace_packets(int size, const RaySet& rays, RayHits& hits) const {
  if (size == 4) return trace_packets_of<RTCRayHit4>(rays, hits);
  if (size == 8) return trace_packets_of<RTCRayHit8>(rays, hits);
  trace_packets_of<RTCRayHit16>(rays, hits);
}

}  // namespace scintray::bench
