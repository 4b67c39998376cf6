#pragma once
/// From [source] to what makes events.

#include <memory>
#include <string>
#include <vector>

#include "scintray/scene_file/gamma_source.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// Binds a specification to a built scene. Throws InputError with what does not fit: a region of no
/// volume, media of unknown composition, nothing that scintillates where the energy is put, hits that
/// are not hits.
/// @param notes  takes what a user should know, none of which stops a run: hits out of order or outside
///               every part
std::unique_ptr<EventSource> make_event_source(const scene_file::GammaSpec& spec, const scene::Scene& scene,
                                               std::vector<std::string>* notes = nullptr);

}  // namespace scintray::source
