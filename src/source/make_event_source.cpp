#include "scintray/source/make_event_source.hpp"

#include "scintray/source/gamma/gamma_source.hpp"
#include "scintray/source/hits_source.hpp"
#include "scintray/source/spectrum_source.hpp"

namespace scintray {

std::unique_ptr<EventSource> make_event_source(const GammaSpec& spec, const Scene& scene,
                                               std::vector<std::string>* notes) {
  if (const auto* spectrum = std::get_if<SpectrumSpec>(&spec.kind))
    return std::make_unique<SpectrumEventSource>(*spectrum, spec.events, scene);
  if (const auto* emitter = std::get_if<EmitterSpec>(&spec.kind))
    return std::make_unique<GammaEventSource>(*emitter, spec.events, scene);
  auto hits = std::make_unique<HitsEventSource>(std::get<HitsSpec>(spec.kind), spec.events, scene);
  if (notes) {
    const std::vector<std::string> said = hits->notes();
    notes->insert(notes->end(), said.begin(), said.end());
  }
  return hits;
}

}  // namespace scintray
