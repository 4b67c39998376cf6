#include "scintray/simulation/photon_paths.hpp"

#include <algorithm>

#include "scintray/core/error.hpp"

namespace scintray::simulation {

namespace {

constexpr std::uint64_t kMostEvents = 10;

struct Address {
  std::uint64_t event = 0, photon = 0;
};

/// Number of photons of an event.
std::uint64_t photons_of(const SimulationPoint& point, std::uint64_t event) {
  core::Rng rng = event_stream(point.settings(), event);
  source::EventLight light;
  point.source().begin(point.scene(), event, rng, light);
  return light.photons;
}

std::vector<Address> first_photons(const SimulationPoint& point, std::uint64_t count) {
  std::vector<Address> photons;
  const source::LightSource& source = point.source();
  for (std::uint64_t block = 0; block < source.blocks() && photons.size() < count; ++block)
    for (const source::PhotonSpan& span : source.block(block)) {
      const std::uint64_t there = std::min(span.count, photons_of(point, span.event) - span.first);
      for (std::uint64_t i = 0; i < there && photons.size() < count; ++i)
        photons.push_back({span.event, span.first + i});
    }
  return photons;
}

std::vector<Address> photons_of_events(const SimulationPoint& point, std::uint64_t count) {
  constexpr std::uint64_t kMostTried = 100 * kMostEvents;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> events;  // number, photons
  const std::uint64_t last = std::min(point.source().events(), kMostTried);
  for (std::uint64_t event = 0; event < last && events.size() < kMostEvents; ++event)
    if (const std::uint64_t photons = photons_of(point, event); photons > 0)
      events.emplace_back(event, photons);
  std::vector<Address> chosen;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto [event, photons] = events[i];
    const std::uint64_t wanted =
        std::min((count * (i + 1)) / events.size() - (count * i) / events.size(), photons);
    for (std::uint64_t k = 0; k < wanted; ++k) chosen.push_back({event, k * photons / wanted});
  }
  return chosen;
}

core::Fate fate_of(const transport::Step& last, const source::Photon& photon, const RunSettings& settings) {
  if (core::is_final(last.event)) return last.event;
  const bool late = settings.max_time_ns && photon.time_ns > *settings.max_time_ns;
  return late ? core::Fate::cut_time : core::Fate::cut_interactions;
}

/// Length of the scene's diagonal, mm.
double diagonal_mm(const scene::Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const scene::PartInfo& part : scene.parts) box.extend(part.bounds);
  return box.isEmpty() ? 1.0 : box.diagonal().norm();
}

}  // namespace

std::string step_text(const scene::Scene& scene, const transport::Step& step) {
  switch (step.event) {
    case core::StepEvent::scattered:
      return "scattered in the bulk";
    case core::StepEvent::re_emitted:
      return "shifted to another wavelength";
    case core::StepEvent::reflected:
      return "reflected at " + scene.region_names[scene.interfaces[step.interface].back] + " | " +
             scene.region_names[scene.interfaces[step.interface].front];
    case core::StepEvent::transmitted: {
      const scene::Interface& interface = scene.interfaces[step.interface];
      return "into " + scene.region_names[step.from_back ? interface.front : interface.back];
    }
    case core::StepEvent::detected:
      return "detected by " + scene.parts[step.sensor_part].name;
    case core::StepEvent::not_detected:
      return "not detected by " + scene.parts[step.sensor_part].name;
    case core::StepEvent::absorbed_in_medium:
      return "absorbed in " + scene.media[step.medium].medium().name;
    case core::StepEvent::absorbed_at_surface:
      return "absorbed at " + scene.surfaces[step.surface].name;
    case core::StepEvent::escaped:
      return "escaped";
    case core::StepEvent::emitted:
    case core::StepEvent::cut_interactions:
    case core::StepEvent::cut_time:
      break;  // no steps
  }
  throw core::InternalError("unknown step");
}

std::vector<tally::PhotonPath> photon_paths(const SimulationPoint& point, std::uint64_t count,
                                            const std::atomic<bool>* stop) {
  const scene::Scene& scene = point.scene();
  const double beyond_mm = 0.1 * diagonal_mm(scene);
  std::vector<tally::PhotonPath> paths;
  for (const Address& address :
       point.source().has_energy() ? photons_of_events(point, count) : first_photons(point, count)) {
    if (stop && stop->load()) break;
    tally::PhotonPath path{address.event, address.photon, {}, {}};
    const source::Photon start = point.start(address.event, address.photon);
    path.steps.push_back({start.position, start.time_ns, start.wavelength_nm,
                          "emitted in " + scene.region_names[start.region]});
    transport::Step last;
    const source::Photon end = point.replay(
        address.event, address.photon, [&](const source::Photon& photon, const transport::Step& step) {
          last = step;
          core::Vec3 place = photon.position;
          if (step.event == core::StepEvent::escaped) place += beyond_mm * photon.ray.direction.vec();
          if (path.steps.size() == tally::kMostPathSteps) path.steps.pop_back();
          path.steps.push_back({place, photon.time_ns, photon.wavelength_nm, step_text(scene, step)});
        });
    path.fate = fate_of(last, end, point.settings());
    paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace scintray::simulation
