// How many Embree devices a process has: counted by functions in place of Embree's own, which they call.
// Embree is a shared library, and a program's functions precede those of its libraries.
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "scenes.hpp"
#include "scintray/scene/accelerator.hpp"
#include "scintray/simulation/simulation.hpp"

using namespace scintray;
using namespace scintray::test;

struct RTCDeviceTy;
struct RTCSceneTy;
extern "C" RTCDeviceTy* rtcNewDevice(const char* settings);
extern "C" RTCSceneTy* rtcNewScene(RTCDeviceTy* device);

namespace {

struct EmbreeCalls {
  std::mutex mutex;
  std::size_t devices = 0, scenes = 0;
  std::set<const RTCDeviceTy*> used;  ///< devices of scenes
};

EmbreeCalls& embree_calls() {
  static EmbreeCalls calls;
  return calls;
}

template <typename Function>
Function* of_embree(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void make_accelerator() {
  const core::Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(0, 0, 1);
  const scene::Accelerator accelerator({{a, c, b}, {a, b, d}, {a, d, c}, {b, c, d}}, {0, 0, 0, 0}, true,
                                       scene_file::AcceleratorKind::embree);
  CHECK(accelerator.uses_embree());
}

}  // namespace

RTCDeviceTy* rtcNewDevice(const char* settings) {
  const std::lock_guard lock(embree_calls().mutex);
  ++embree_calls().devices;
  return of_embree<decltype(rtcNewDevice)>("rtcNewDevice")(settings);
}

RTCSceneTy* rtcNewScene(RTCDeviceTy* device) {
  {
    const std::lock_guard lock(embree_calls().mutex);
    ++embree_calls().scenes;
    embree_calls().used.insert(device);
  }
  return of_embree<decltype(rtcNewScene)>("rtcNewScene")(device);
}

TEST_CASE(
    "All accelerators of a process share one Embree device, whichever thread or simulation makes them") {
  constexpr std::size_t kThreads = 4, kSimulations = 2;
  const std::size_t before = embree_calls().scenes;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < kThreads; ++i) threads.emplace_back(make_accelerator);
  for (std::thread& thread : threads) thread.join();
  CHECK(embree_calls().scenes == before + kThreads);
  const std::string by_embree = kPhotons + "[run]\naccelerator = \"embree\"\n";
  for (std::size_t i = 0; i < kSimulations; ++i) {
    simulation::Simulation simulation(scene_of(kCrystal + by_embree + kSurfaceSweep));
    simulation.build();
    CHECK(simulation.counts().scenes_built == 3);
  }
  CHECK(embree_calls().scenes >= before + kThreads + 3 * kSimulations);
  CHECK(embree_calls().devices == 1);
  CHECK(embree_calls().used.size() == 1);
}
