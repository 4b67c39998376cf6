#include "raw_embree.hpp"
#include "scintray/transport/step.hpp"

namespace scintray::bench {

namespace {

/// Collects the ray that each segment of a photon starts with.
class Recorder {
 public:
  Recorder(const simulation::SimulationPoint& point, std::size_t most) : point_(point), most_(most) {}

  /// True when no more rays are wanted.
  bool full() const { return rays_.size() >= most_; }
  std::vector<RecordedRay> take() { return std::move(rays_); }

  void follow(const source::EventLight& light, std::uint64_t event, std::uint64_t number) {
    const scene::Scene& scene = point_.scene();
    core::Rng rng = simulation::photon_stream(point_.settings(), event, number);
    source::Photon photon = point_.source().emit(scene, light, number, rng);
    const auto pass = [this](const source::Photon& reflected, const transport::Step&) { add(reflected); };
    transport::PropagationLimits limits = simulation::limits_of(point_.settings());
    limits.passed = pass;
    for (;;) {
      add(photon);
      const transport::Step taken = transport::step(scene, photon, rng, limits);
      if (core::is_final(taken.event) || limits.reached(photon) || full()) return;
    }
  }

 private:
  void add(const source::Photon& photon) {
    const scene::Region& region = point_.scene().regions[photon.region];
    const core::Vec3 o = region.point_to_local(photon.position);
    const core::Vec3 d = region.direction_to_local(photon.ray.direction);
    const auto single = [](double value) { return static_cast<float>(value); };
    rays_.push_back({{single(o.x()), single(o.y()), single(o.z())},
                     {single(d.x()), single(d.y()), single(d.z())},
                     region.accelerator});
  }

  const simulation::SimulationPoint& point_;
  std::size_t most_;
  std::vector<RecordedRay> rays_;
};

}  // namespace

std::vector<RecordedRay> record_rays(const simulation::SimulationPoint& point, std::size_t most) {
  Recorder recorder(point, most);
  source::EventLight light;
  for (std::uint64_t event = 0; event < point.source().events() && !recorder.full(); ++event) {
    core::Rng rng = simulation::event_stream(point.settings(), event);
    point.source().begin(point.scene(), event, rng, light);
    for (std::uint64_t i = 0; i < light.photons && !recorder.full(); ++i) recorder.follow(light, event, i);
  }
  return recorder.take();
}

}  // namespace scintray::bench
