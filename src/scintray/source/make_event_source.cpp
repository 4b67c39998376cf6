#include "scintray/source/detail/event_sources.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

std::unique_ptr<EventSource> make_event_source(const scene_file::GammaSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes) {
  if (const auto* spectrum = std::get_if<scene_file::SpectrumSpec>(&spec.kind))
    return std::make_unique<SpectrumEventSource>(*spectrum, spec.events, spec.cherenkov, scene);
  if (const auto* emitter = std::get_if<scene_file::EmitterSpec>(&spec.kind))
    return std::make_unique<GammaEventSource>(*emitter, spec.events, scene);
  const auto* list = std::get_if<scene_file::HitsSpec>(&spec.kind);
  if (!list) throw core::InternalError("a list of photons has no energy deposits");
  auto hits = std::make_unique<HitsEventSource>(*list, spec.events, scene, spec.cherenkov);
  if (notes) {
    const std::vector<std::string> said = hits->notes();
    notes->insert(notes->end(), said.begin(), said.end());
  }
  return hits;
}

}  // namespace scintray::source
